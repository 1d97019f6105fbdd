// Interface to the libraries of optimizers: one run of one method from one start. The objective is a BudgetedObjective.
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
  int nlopt_algorithm;  ///< a value of nlopt::algorithm
  bool uses_gradient;
  std::string_view description;
};

/// Throws InvalidInput for the name of a method that is unknown or not supported; the message gives the reason and the known
/// names.
[[nodiscard]] const Method& find_method(std::string_view name);

struct RunOptions {
  Point start;
  double step = 0.25;      ///< first step as a fraction of the box
  double population = 1;   ///< points of a generation, as a multiple of the usual number
  std::uint64_t seed = 0;  ///< seed of the library's random numbers
};

struct RunReport {
  bool converged = false;  ///< true when the run ended by its own criterion, and not by an error
  std::string message;     ///< message of the library
};

/// run_nlopt() and run_ipopt() always return, whatever the objective does. A repeated run with the same arguments evaluates the
/// same points in the same order. So a search that ran out of budget continues by repeating its run: the objective at points of
/// the earlier run is read from memory.
[[nodiscard]] RunReport run_nlopt(const Method& method, const RunOptions& run, BudgetedObjective& budgeted);
[[nodiscard]] RunReport run_cma_es(const RunOptions& run, BudgetedObjective& budgeted);
[[nodiscard]] RunReport run_ipopt(const RunOptions& run, BudgetedObjective& budgeted);
[[nodiscard]] RunReport run_method(const Method& method, const RunOptions& run, BudgetedObjective& budgeted);

}  // namespace softland::internal
