// The record of one minimisation: it makes, counts and stores every evaluation; libraries evaluate only through the record.
//
// Work comes in rounds of tasks. A task is sequential and has a fixed budget; the tasks of a round run in parallel. The order
// of evaluations is (round, task, position within the task), whichever thread makes an evaluation, and when. "First", "best so
// far" and "already seen" refer to this order, so results do not depend on the number of jobs. When a task reaches the target
// value of the objective, later tasks of the round are stopped and ignored, and earlier tasks complete. Tasks that run one
// after the other give the same result.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "optimizers/problem.h"

namespace softland::internal {

/// A point of the search: the variables whose bounds differ, each scaled to [0, 1].
using Point = std::vector<double>;

/// Exception by which a BudgetedObjective ends the run of an optimizer library. Each backend translates Cut as its library
/// requires.
struct Cut {};

/// Value of the objective at a point, as given to an optimizer library. At an infeasible point it is a finite penalty above all
/// values seen before.
struct Answer {
  double value;
  bool feasible;
};

/// The values {cost, g_1, ... g_n} of an evaluation: the minimised cost, then the conditions g_i <= 0.
struct Values {
  std::vector<double> all;
  bool feasible;
};

struct PointHash {
  std::size_t operator()(const Point& point) const noexcept;
};
using Memory = std::unordered_map<Point, Answer, PointHash>;
using Numbers = std::unordered_map<Point, std::vector<double>, PointHash>;
/// Cost of one computation of the problem's gradients, as a number of evaluations of the objective.
inline constexpr long evaluations_of_gradient = 3;

class EvaluationRecord;

/// The evaluations of one task, a sequential part of a search. Optimizer libraries see the problem only through this class.
class BudgetedObjective {
 public:
  /// Returns the objective at a point. A point that was evaluated before is read from memory and costs nothing. Throws Cut when
  /// the budget of the task is used up, the minimisation is over, or a search repeats evaluated points very often in
  /// succession.
  Answer operator()(std::span<const double> point);
  /// Returns the objective and the conditions of the problem at a point; the objective alone if the problem has no conditions.
  /// At an infeasible point no condition counts as violated. Throws Cut as operator() does.
  Values values(std::span<const double> point);
  /// Writes the gradients of the objective and of all conditions, one after the other. Central differences replace a gradient
  /// that the problem does not give. Differences are one-sided at the bounds and next to infeasible points, and 0 where all
  /// neighbours are infeasible. Throws Cut as operator() does.
  void gradients(std::span<const double> point, std::span<double> gradients);
  [[nodiscard]] std::size_t conditions() const;

  /// Returns true when every further evaluation would throw Cut.
  [[nodiscard]] bool over() const;
  /// Sets the count of repeated requests for the same points to 0; call this before every run of an optimizer library.
  void begin_search() { repeats_ = 0; }
  [[nodiscard]] long evaluations() const { return static_cast<long>(records_.size()); }
  /// Returns the lowest feasible objective that this task has found; infinite if it has found none.
  [[nodiscard]] double best_of_task() const { return best_of_task_; }
  [[nodiscard]] const Point& best_point_of_task() const { return best_point_of_task_; }

 private:
  friend class EvaluationRecord;
  struct Record {
    Point point;
    Answer answer;
    double value;  ///< objective as the problem returned it, not compressed and without a penalty
  };
  BudgetedObjective(EvaluationRecord& record, std::size_t task, long budget, long first_index);

  Answer remember(const Point& point, double value);
  [[nodiscard]] bool known_gradients(const Point& point, std::span<double> gradients);
  [[nodiscard]] double penalty() const;

  EvaluationRecord& record_;
  std::size_t task_;
  long budget_;
  long first_index_;
  bool cut_ = false;
  long repeats_ = 0;
  double best_seen_;
  double worst_seen_;
  double best_of_task_ = std::numeric_limits<double>::infinity();
  Point best_point_of_task_;
  Memory memory_;
  std::vector<Record> records_;
  Numbers values_;     ///< objective and conditions of evaluated points, by point
  Numbers gradients_;  ///< gradients of objective and conditions that the problem computed, by point
  std::optional<std::string> first_exception_;
};

class EvaluationRecord {
 public:
  struct Task {
    long budget;
    /// The work of the task, which evaluates points. The exception Cut ends the task normally; any other exception is a
    /// failure.
    std::function<void(BudgetedObjective&)> body;
  };
  struct Known {
    Point point;
    Answer answer;
  };

  /// Keeps references to the problem and the options.
  EvaluationRecord(const Problem& problem, const OptimizerOptions& options);

  [[nodiscard]] std::size_t dimension() const { return free_.size(); }
  [[nodiscard]] bool has_gradient() const { return gradient_of_problem() != nullptr; }
  [[nodiscard]] bool goes_on() const { return options_.goes_on; }
  [[nodiscard]] bool smooth() const { return options_.smooth; }
  [[nodiscard]] std::uint64_t seed() const { return options_.seed; }
  [[nodiscard]] const std::vector<Point>& starts() const { return starts_; }
  /// Runs the tasks of one round. When their budgets exceed the remaining budget, the last tasks are shortened first. Returns
  /// the number of new evaluations.
  long run(const std::vector<Task>& tasks);
  [[nodiscard]] long remaining() const {
    return options_.max_evaluations - evaluations_ - evaluations_of_gradient * static_cast<long>(gradients_.size());
  }
  [[nodiscard]] bool over() const { return remaining() <= 0 || target_reached_ || outside_ != Termination::not_run; }
  /// Returns all evaluations of the completed rounds, in order.
  [[nodiscard]] const std::vector<Known>& known() const { return known_; }
  /// Returns true when a task of the current round has to end early: another thread or the time budget stops the minimisation,
  /// or an earlier task has reached the target. The function is cheap enough for waiting loops.
  [[nodiscard]] bool cut_off(std::size_t task);

  /// Returns the result of the minimisation. `message` is that of the last local search, `converged` is true when this search
  /// ended by its own criterion.
  [[nodiscard]] OptimizerResult result(bool converged, const std::string& message) const;

 private:
  friend class BudgetedObjective;
  double evaluate(BudgetedObjective& budgeted, const Point& point);
  [[nodiscard]] const std::function<std::vector<double>(std::span<const double>)>& gradient_of_problem() const {
    return problem_.conditions.count > 0 ? problem_.conditions.gradients : problem_.gradient;
  }
  [[nodiscard]] std::vector<double> values(BudgetedObjective& budgeted, const Point& point, const Answer& answer) const;
  [[nodiscard]] std::vector<double> gradients(BudgetedObjective& budgeted, const Point& point) const;
  [[nodiscard]] std::vector<double> to_user(const Point& point) const;
  [[nodiscard]] Point to_point(std::span<const double> x) const;
  void report(long index, double value, const std::vector<double>& x);
  void settle(const std::vector<BudgetedObjective>& strands);
  void end_from_outside(Termination reason);

  const Problem& problem_;
  const OptimizerOptions& options_;
  std::chrono::steady_clock::time_point begin_;
  std::vector<std::size_t> free_;  ///< indices of the variables whose bounds differ
  std::vector<Point> starts_;
  /// The user's starts with all their digits, by scaled point: scaling a point back to the user's units would round.
  std::unordered_map<Point, std::vector<double>, PointHash> exact_;

  // The following members change only between rounds, so that the tasks of a round read them without a lock.
  std::vector<Known> known_;
  Memory memory_;
  Numbers values_, gradients_;
  double best_seen_ = std::numeric_limits<double>::infinity();
  double worst_seen_ = -std::numeric_limits<double>::infinity();
  long evaluations_ = 0;
  long next_index_ = 0;
  bool target_reached_ = false;
  OptimizerResult best_;

  // The threads of a round share the following members.
  std::atomic<std::size_t> target_task_;
  std::atomic<Termination> outside_ = Termination::not_run;
  std::mutex report_mutex_;
  double live_best_ = std::numeric_limits<double>::infinity();
  std::string failure_;
};

}  // namespace softland::internal
