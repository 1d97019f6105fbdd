// Interface to the optimizer libraries NLopt and Ipopt and to the own CMA-ES: one run of one method from one start. The methods
// evaluate a BudgetedObjective.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "optimizers/evaluation_record.h"

namespace softland::internal {

enum class Backend { search_auto, cma_es, nlopt, ipopt };

/// A local method converges to a minimum nearby and may start again from another point; a global method runs once.
enum class Reach { local, global };

struct Method {
  std::string_view name;
  Backend backend;
  Reach reach;
  int nlopt_algorithm;  ///< method of NLopt, a value of nlopt::algorithm
  bool uses_gradient;
  std::string_view description;
};

/// Returns the method of this name. Throws InvalidInput for a name that is unknown or not supported; the message gives the
/// reason and the accepted names.
[[nodiscard]] const Method& find_method(std::string_view name);

struct RunOptions {
  Point start;
  double step = 0.25;      ///< first step of the search as a fraction of the box of the variables
  double population = 1;   ///< points of a generation of cma-es, as a multiple of the usual number
  std::uint64_t seed = 0;  ///< seed of the random numbers of the optimizer
};

struct RunReport {
  bool converged = false;  ///< true when the method ended the run by its own convergence criterion
  std::string message;     ///< message of the optimizer about the end of the run
};

/// Runs a method of NLopt. It always returns, whatever the objective does, like run_ipopt(). A repeated run with the same
/// arguments evaluates the same points in the same order. So a search that ran out of budget continues by repeating its run:
/// the objective at points of the earlier run is read from memory.
[[nodiscard]] RunReport run_nlopt(const Method& method, const RunOptions& run, BudgetedObjective& budgeted);
[[nodiscard]] RunReport run_cma_es(const RunOptions& run, BudgetedObjective& budgeted);
[[nodiscard]] RunReport run_ipopt(const RunOptions& run, BudgetedObjective& budgeted);
[[nodiscard]] RunReport run_method(const Method& method, const RunOptions& run, BudgetedObjective& budgeted);

}  // namespace softland::internal
