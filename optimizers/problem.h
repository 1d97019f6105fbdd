// A bounded minimisation, its options and its result. The code is independent of switches.
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

/// Conditions g(x) <= 0 of a minimisation. Methods with a gradient treat the conditions as constraints. Other methods, and
/// every comparison of points, use the objective alone: so the objective must contain a penalty that rises with the violation.
struct Conditions {
  std::size_t count = 0;
  /// Returns {objective, g_1, ... g_count} at a point at which the objective is finite; called from several threads at once,
  /// like the objective.
  std::function<std::vector<double>(std::span<const double>)> values = {};
  /// Returns the derivatives of the objective, of g_1 and so on, by the variables x. A NaN entry is replaced by a finite
  /// difference, and so is every entry when this function is null.
  std::function<std::vector<double>(std::span<const double>)> gradients = {};
};

/// Minimise objective(x) subject to lower <= x <= upper. Optimizers work on x scaled to [0, 1]; a variable with lower == upper
/// is constant.
struct Problem {
  std::vector<Variable> variables = {};
  /// Returns the objective at x. Called from several threads at once when jobs > 1, each call with its own x, which is within
  /// the bounds exactly. Equal x must give equal values: the value of a repeated point is read from memory. A non-finite value
  /// or an exception makes the point infeasible; the result has the message of the first exception.
  std::function<double(std::span<const double>)> objective = {};
  /// Returns the derivatives of the objective by x; may be null. A NaN is replaced by a finite difference. Several threads may
  /// call this function at once, like the objective.
  std::function<std::vector<double>(std::span<const double>)> gradient = {};
  /// Conditions g(x) <= 0 of the minimisation. If there are some, `conditions.gradients` replaces `gradient`.
  Conditions conditions;
  /// Starting points that are evaluated first; may be empty. Points outside the bounds are moved to the bounds. Every optimizer
  /// evaluates all starts, as given to the last digit; local methods search from each in turn, `auto` and the methods with a
  /// gradient from the most promising ones.
  std::vector<std::vector<double>> starts = {};
};

struct Evaluation {
  /// Number of the evaluation: unique, and increasing in an order that does not depend on the number of jobs. A part of a
  /// search that ends before its budget leaves its other numbers unused, so a number may exceed the count of evaluations.
  long index = 0;
  double value = 0;  ///< value of the objective; non-finite at an infeasible point (NaN after an exception)
  std::vector<double> x;
  std::size_t problem = 0;  ///< number of the minimisation problem, when several problems share a log
};

struct OptimizerOptions {
  std::string optimizer = "auto";
  long max_evaluations = 2000;
  double max_seconds = std::numeric_limits<double>::infinity();  ///< time budget of the search [s]
  std::uint64_t seed = 1;
  double step = 0.25;     ///< first step of a local method, as a share of the box; `auto` has its own steps
  double population = 1;  ///< number of points in a generation of cma-es, as a multiple of its default
  int jobs = 1;           ///< number of threads, including the calling one; `auto` uses all of them
  /// True when the starts are the best points of an earlier search. If the problem has a gradient and many variables, `auto`
  /// then spends most of its budget on local searches from points near the best start.
  bool goes_on = false;
  /// True when the objective is smooth near the starts: `auto` then runs a gradient method from the starts first.
  bool smooth = false;
  double target = -std::numeric_limits<double>::infinity();  ///< the search stops once the objective is at or below the target
  const std::atomic<bool>* stop = nullptr;  ///< set by another thread (Ctrl-C); ends the search with its result so far
  /// Called under a lock after every evaluation, in the order in which evaluations end. With jobs > 1 this order may vary
  /// between runs, and the calls may include evaluations that the result leaves out, as they follow the one that reached the
  /// target in the job-independent order. An exception ends the search with Termination::failure.
  std::function<void(const Evaluation&)> on_evaluation = {};
  /// Called under the lock of on_evaluation whenever an evaluation is the best so far.
  std::function<void(const Evaluation&)> on_improvement = {};
};

/// The reason why a search ended. A search that ended by interrupted, time_budget or evaluation_budget has the best point so
/// far; x is empty when no point was feasible. no_feasible_point: the search ended by itself or by its evaluation budget, and
/// every evaluation was non-finite or threw an exception.
enum class Termination {
  not_run,
  converged,
  target_reached,
  evaluation_budget,
  time_budget,
  interrupted,
  no_feasible_point,
  failure
};
[[nodiscard]] std::string_view to_string(Termination termination);

struct OptimizerResult {
  Termination termination = Termination::not_run;
  std::string message = {};  ///< reason why the search ended, with the message of the library when there is one
  std::vector<double> x;     ///< the best point found; empty if no point was feasible
  double value = std::numeric_limits<double>::quiet_NaN();  ///< objective at the best point
  long evaluations = 0;
  std::vector<Evaluation> improvements;  ///< each evaluation that was the best so far, in the job-independent order
  std::string first_exception;           ///< message of the first exception of the objective; empty without an exception
};

/// Returns the names accepted in OptimizerOptions::optimizer, `auto` first.
[[nodiscard]] std::span<const std::string_view> optimizer_names();

/// Returns a description of an optimizer for --help, one line. Throws InvalidInput for a name outside optimizer_names().
[[nodiscard]] std::string_view optimizer_description(std::string_view name);

/// Minimises the objective of the problem. Throws InvalidInput for an unknown or refused optimizer, no variables or no
/// objective, a bound that is not finite, lower > upper, a start of the wrong length or not finite, jobs < 1, a budget that is
/// not positive, a target that is NaN. Otherwise it always returns.
///
/// The result depends on problem, optimizer, max_evaluations, seed and target only: not on jobs, and on time only through
/// max_seconds and stop. The time budget, the stop flag and the target are checked before every evaluation; a running
/// evaluation is never interrupted.
///
/// `auto` searches near the best of the starts, samples the box and runs local searches from well separated good points. The
/// promising searches continue, and a last search improves the best point, with the problem's gradient when there is one;
/// `auto` uses several jobs. A method with a gradient samples and searches by cma-es for about half of every epoch, and
/// continues from the best points found. Another local method runs from the starts in turn and then from random points, each
/// time until it converges, as long as the budget lasts; infeasible points are skipped. A global method runs once.
///
/// If the problem has no gradient, central differences are used, which count as evaluations; a gradient of the problem counts
/// as three, with those of its conditions. Ipopt solves one problem at a time in a process, and other calls wait, so an
/// objective must not itself minimize with ipopt while ipopt calls it.
[[nodiscard]] OptimizerResult minimize(const Problem& problem, const OptimizerOptions& options);

}  // namespace softland
