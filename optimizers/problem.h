// A bounded minimisation, and what came of it. Knows nothing of switches.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace softland {

struct Variable {
  std::string name;
  double lower = 0;
  double upper = 1;
};

/// minimise objective(x) subject to lower <= x <= upper. Optimizers work on x scaled to [0, 1].
struct Problem {
  std::vector<Variable> variables;
  /// Called from several threads at once when jobs > 1, each thread with its own x. May return a non-finite value or throw: such a point counts as
  /// infeasible; the first exception is kept in the result.
  std::function<double(std::span<const double>)> objective;
  /// Starting points worth trying first; may be empty. Points outside the bounds are moved to them.
  std::vector<std::vector<double>> starts;
};

struct Evaluation {
  long index = 0;  ///< counted in an order that does not depend on the number of jobs
  double value = 0;  ///< the objective; may be non-finite
  std::vector<double> x;
};

struct OptimizerOptions {
  std::string optimizer = "auto";
  long max_evaluations = 2000;
  double max_seconds = std::numeric_limits<double>::infinity();  ///< [s]
  std::uint64_t seed = 1;
  int jobs = 1;
  double target = -std::numeric_limits<double>::infinity();  ///< good enough: stop once a value is at or below it
  const std::atomic<bool>* stop = nullptr;                    ///< set from outside (Ctrl-C): ends the search with what there is
  /// Called (under a lock) after every evaluation, as they happen; with jobs > 1 the order of calls may vary between runs.
  std::function<void(const Evaluation&)> on_evaluation;
  /// Called (under the same lock) whenever an evaluation is the best so far.
  std::function<void(const Evaluation&)> on_improvement;
};

enum class Termination { not_run, converged, target_reached, evaluation_budget, time_budget, interrupted, no_feasible_point, failure };
[[nodiscard]] std::string_view to_string(Termination termination);

struct OptimizerResult {
  Termination termination = Termination::not_run;
  std::string message;                                       ///< of the library where it has one
  std::vector<double> x;                                     ///< the best point; empty if no point was feasible
  double value = std::numeric_limits<double>::quiet_NaN();   ///< objective there
  long evaluations = 0;
  std::vector<Evaluation> improvements;                      ///< best-so-far history in the job-independent order
  std::string first_exception;                               ///< what() of the first exception the objective threw, if any
};

/// Names accepted in OptimizerOptions::optimizer, `auto` first.
[[nodiscard]] std::span<const std::string_view> optimizer_names();

/// Throws InvalidInput for an unknown optimizer, no variables, lower > upper, a non-positive budget. Otherwise always returns.
/// The result depends on problem, optimizer, max_evaluations, seed and target only: not on jobs, and on time only through max_seconds and stop.
[[nodiscard]] OptimizerResult minimize(const Problem& problem, const OptimizerOptions& options);

}  // namespace softland
