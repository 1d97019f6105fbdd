#include "studies/search/evaluation_log.h"

#include <cmath>
#include <utility>

namespace softland {

std::vector<Evaluation> improvements_of(const std::map<long, Evaluation>& evaluations) {
  std::vector<Evaluation> improvements;
  for (const auto& [index, e] : evaluations) {
    if (std::isfinite(e.value) && (improvements.empty() || e.value < improvements.back().value)) improvements.push_back(e);
  }
  return improvements;
}

EvaluationLog::EvaluationLog(const OptimizeOptions& options, const SearchBudget& budget, double step_cost, SceneOf scene)
    : options_(options),
      budget_(budget),
      scene_(std::move(scene)),
      progress_{.baseline_cost = step_cost, .planned = options.counts_work ? options.max_evaluations : 0} {}

// Returns true if `cost` is the least cost in the search so far, and stores it.
bool EvaluationLog::improves(double cost) {
  const bool is_least = std::isfinite(cost) && !(progress_.best_cost <= cost);
  if (is_least) progress_.best_cost = cost;
  return is_least;
}

void EvaluationLog::note(const Evaluation& e) {
  const std::scoped_lock lock(mutex_);
  const bool is_least = improves(e.value);
  progress_.evaluations = budget_.taken();
  if (options_.on_evaluation) options_.on_evaluation(e, progress_);
  if (is_least && options_.on_improvement) {
    if (const std::optional<SceneFile> scene = scene_(e)) options_.on_improvement(e, *scene);
  }
  evaluations_.emplace(e.index, e);
}

void EvaluationLog::begin_with(const Evaluation& given, const std::optional<SceneFile>& scene) {
  const std::scoped_lock lock(mutex_);
  if (improves(given.value) && options_.on_improvement && scene) options_.on_improvement(given, *scene);
}

void EvaluationLog::tell() {
  if (!options_.on_progress) return;
  const std::scoped_lock lock(mutex_);
  progress_.evaluations = budget_.taken();
  options_.on_progress(progress_);
}

std::map<long, Evaluation> EvaluationLog::evaluations(std::size_t problem) const {
  std::map<long, Evaluation> own;
  for (const auto& [index, e] : evaluations_) {
    if (e.problem == problem) own.emplace(index, e);
  }
  return own;
}

}  // namespace softland
