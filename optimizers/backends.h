// Interface to the optimizer libraries NLopt and Ipopt and to the CMA-ES of this folder: one run of one method from one start.
// The methods evaluate a BudgetedObjective.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "optimizers/evaluation_record.h"

namespace softland::internal {

enum class Backend { search_auto, cma_es, nlopt, ipopt };

/// A local method converges to a nearby minimum, and is started again from another point; a global method searches the whole
/// box and runs once.
enum class Reach { local, global };

struct Method {
  std::string_view name;
  Backend backend;
  Reach reach;
  int nlopt_algorithm;  ///< algorithm of NLopt as a number, a value of nlopt::algorithm
  bool uses_gradient;
  std::string_view description;
};

/// Returns the method of this name. Throws InvalidInput for a name that is unknown or not supported; the message gives the
/// reason and the accepted names.
[[nodiscard]] const Method& find_method(std::string_view name);

struct RunOptions {
  Point start;
  double step = 0.25;      ///< first step of the method as a fraction of the box of the variables
  double population = 1;   ///< number of points in a generation of cma-es, as a multiple of its default
  std::uint64_t seed = 0;  ///< seed of the random numbers of the optimizer
};

struct RunReport {
  bool converged = false;  ///< true when the method ended the run by its own convergence criterion
  std::string message;     ///< message of the optimizer about the end of the run
};

/// Runs a method of NLopt. It always returns, even if the objective throws or is never finite, as run_ipopt() does. A repeated
/// run with the same arguments evaluates the same points in the same order. So a search that ran out of budget continues by
/// repeating its run: the record of evaluations then returns the stored values at points of the earlier run.
[[nodiscard]] RunReport run_nlopt(const Method& method, const RunOptions& run, BudgetedObjective& budgeted);
[[nodiscard]] RunReport run_cma_es(const RunOptions& run, BudgetedObjective& budgeted);
[[nodiscard]] RunReport run_ipopt(const RunOptions& run, BudgetedObjective& budgeted);
[[nodiscard]] RunReport run_method(const Method& method, const RunOptions& run, BudgetedObjective& budgeted);

}  // namespace softland::internal
