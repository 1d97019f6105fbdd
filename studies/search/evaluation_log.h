// The log of a search: its evaluations in an order that does not depend on the number of threads, and the improvements among
// them. While the search runs the log reports them to the callbacks of OptimizeOptions.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "studies/search/optimize.h"
#include "studies/search/search_budget.h"

namespace softland {

/// Returns the evaluations that are feasible and better than all before them, in the order of their index.
[[nodiscard]] std::vector<Evaluation> improvements_of(const std::map<long, Evaluation>& evaluations);

/// Several threads may call it; the callbacks are called one at a time.
class EvaluationLog {
 public:
  /// Returns the scene of an evaluation, or none if its improvement is not to be reported.
  using SceneOf = std::function<std::optional<SceneFile>(const Evaluation&)>;
  /// Keeps references to `options` and `budget`, whose count is reported. `step_cost` is the cost of the plain step.
  EvaluationLog(const OptimizeOptions& options, const SearchBudget& budget, double step_cost, SceneOf scene);

  /// Notes an evaluation. Call it after the budget has counted it.
  void note(const Evaluation& evaluation);
  /// Reports an evaluation from outside the search, which is not noted, if it is the best so far.
  void begin_with(const Evaluation& given, const std::optional<SceneFile>& scene);
  /// Reports the state of a search between evaluations that are noted.
  void tell();

  /// The evaluations by their index.
  [[nodiscard]] const std::map<long, Evaluation>& evaluations() const { return evaluations_; }
  /// The evaluations whose Evaluation::problem is this.
  [[nodiscard]] std::map<long, Evaluation> evaluations(std::size_t problem) const;
  /// The least index that is above those of all evaluations.
  [[nodiscard]] long next_index() const { return evaluations_.empty() ? 0 : evaluations_.rbegin()->first + 1; }

 private:
  bool improves(double cost);

  const OptimizeOptions& options_;
  const SearchBudget& budget_;
  SceneOf scene_;
  std::mutex mutex_;  // guards the members below
  std::map<long, Evaluation> evaluations_;
  OptimizeProgress progress_;
};

}  // namespace softland
