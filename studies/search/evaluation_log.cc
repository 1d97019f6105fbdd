#include "studies/search/evaluation_log.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "studies/search/search_setting.h"

namespace softland {
namespace {

constexpr std::size_t most_candidates = 8;  // largest number of candidate waveforms that are verified
// Numbers of evaluations that EvaluationLog::sampled_by_rank() returns: the best ones, others that are evenly spaced by rank of
// their cost, and the best ones of every waveform family.
constexpr std::size_t kept_best = 100, kept_of_ladder = 150, kept_of_problem = 15;

}  // namespace

std::vector<Evaluation> improvements_of(const std::map<long, Evaluation>& evaluations) {
  std::vector<Evaluation> improvements;
  for (const auto& [index, e] : evaluations) {
    if (std::isfinite(e.value) && (improvements.empty() || e.value < improvements.back().value)) improvements.push_back(e);
  }
  return improvements;
}

std::vector<Evaluation> candidates(const std::vector<Evaluation>& improvements) {
  std::vector<Evaluation> chosen;
  for (auto e = improvements.rbegin(); e != improvements.rend() && chosen.size() < most_candidates; ++e) {
    if (!(e->value < never_touched)) break;
    if (chosen.empty() || e->value > distinct * chosen.back().value) chosen.push_back(*e);
  }
  return chosen;
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

std::vector<Evaluation> EvaluationLog::sampled_by_rank(std::size_t problems) const {
  std::vector<Evaluation> all;
  for (std::size_t k = 0; k < problems; ++k) {
    for (const auto& [index, e] : evaluations(k)) {
      if (e.value < never_touched) all.push_back(e);
    }
  }
  std::ranges::stable_sort(all, {}, &Evaluation::value);
  std::vector<Evaluation> kept;
  std::vector<std::size_t> of_problem(problems, 0);
  const std::size_t rung = std::max<std::size_t>(1, all.size() / kept_of_ladder);
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::size_t& count = of_problem[all[i].problem];
    if (i >= kept_best && i % rung != 0 && count >= kept_of_problem) continue;
    ++count;
    kept.push_back(all[i]);
  }
  return kept;
}

}  // namespace softland
