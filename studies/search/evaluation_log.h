// The log of a search: evaluations in an order that does not depend on the number of threads, and the improvements among them.
// During the search the log calls the callbacks of OptimizeOptions.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "studies/search/optimize.h"
#include "studies/search/search_budget.h"

namespace softland {

/// Returns the feasible evaluations whose cost is below that of every earlier evaluation, in the order of their index.
[[nodiscard]] std::vector<Evaluation> improvements_of(const std::map<long, Evaluation>& evaluations);

/// Least ratio between the costs of two candidate waveforms that are both verified.
inline constexpr double distinct = 1.01;
/// Returns the candidate waveforms that a search verifies, at most 8: from `improvements`, the best first, each with a cost that
/// is distinctly above that of the one before, since similar waveforms would fail for the same reason.
[[nodiscard]] std::vector<Evaluation> candidates(const std::vector<Evaluation>& improvements);

/// Collects the evaluations of a search. Several threads may call the log; callbacks are called one at a time.
class EvaluationLog {
 public:
  /// A function that returns the scene with the waveforms of an evaluation that is the best so far; none if this improvement is
  /// not to be reported.
  using SceneOf = std::function<std::optional<SceneFile>(const Evaluation&)>;
  /// Keeps references to `options` and `budget`, whose number of evaluations is reported. `step_cost` is the cost of the plain
  /// step.
  EvaluationLog(const OptimizeOptions& options, const SearchBudget& budget, double step_cost, SceneOf scene);

  /// Adds an evaluation to the log. Call note() after the budget has counted the evaluation.
  void note(const Evaluation& evaluation);
  /// Reports `given`, a waveform from the user, as an improvement if it is the best so far. `given` does not become one of the
  /// evaluations of the search.
  void begin_with(const Evaluation& given, const std::optional<SceneFile>& scene);
  /// Reports the current number of evaluations by OptimizeOptions::on_progress, when no evaluation was added to the log.
  void tell();

  /// Returns the evaluations of the search by their index.
  [[nodiscard]] const std::map<long, Evaluation>& evaluations() const { return evaluations_; }
  /// Returns the evaluations of the waveform family with the number `problem`, by their index.
  [[nodiscard]] std::map<long, Evaluation> evaluations(std::size_t problem) const;
  /// Returns some of the evaluations under which the switch makes contact, the best first: the 100 of the lowest cost, 150
  /// evenly spaced by rank, and the best 15 of each of the first `problems` waveform families.
  [[nodiscard]] std::vector<Evaluation> sampled_by_rank(std::size_t problems) const;
  /// Returns one more than the largest index of the evaluations; 0 without evaluations.
  [[nodiscard]] long next_index() const { return evaluations_.empty() ? 0 : evaluations_.rbegin()->first + 1; }

 private:
  bool improves(double cost);

  const OptimizeOptions& options_;
  const SearchBudget& budget_;
  SceneOf scene_;
  std::mutex mutex_;  // guards the evaluations and the progress, since several threads add evaluations
  std::map<long, Evaluation> evaluations_;
  OptimizeProgress progress_;
};

}  // namespace softland
