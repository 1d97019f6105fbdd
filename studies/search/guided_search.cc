#include "studies/search/guided_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "studies/search/evaluation_log.h"
#include "studies/search/search_budget.h"

namespace softland {
namespace {

constexpr std::size_t starts_of_the_second = 8;
// Two starts of the second stage of a search differ in a variable by at least this share of its range.
constexpr double separation = 0.05;

}  // namespace

OptimizerResult GuidedSearch::stage(Problem problem, OptimizerOptions options, bool guide) {
  problem.objective = [this, guide](std::span<const double> x) {
    const std::vector<double> point(x.begin(), x.end());
    {
      const std::scoped_lock lock(mutex_);
      if (const auto found = known_.find(point); found != known_.end()) return guide ? found->second.guide : found->second.target;
    }
    const SearchCosts prices = price_(x);
    const std::scoped_lock lock(mutex_);
    known_.emplace(point, prices);
    return guide ? prices.guide : prices.target;
  };
  const auto& slopes = guide ? slopes_.guide : slopes_.target;
  if (slopes_.conditions > 0) {
    problem.conditions.count = slopes_.conditions;
    problem.conditions.values = [this, guide](std::span<const double> x) { return values_apart(x, guide); };
    problem.conditions.gradients = slopes;
  } else {
    problem.gradient = slopes;
  }
  options.on_evaluation = [this](const Evaluation& e) {
    Evaluation own = e;
    own.index += first_index_;
    {
      const std::scoped_lock lock(mutex_);
      const auto found = known_.find(e.x);
      own.value = found == known_.end() ? std::numeric_limits<double>::quiet_NaN()
                                        : found->second.target;  // NaN if the evaluation threw an exception and has no costs
    }
    on_evaluation_(own);
    log_.emplace(own.index, std::move(own));
  };
  return minimize(problem, options);
}

std::vector<double> GuidedSearch::values_apart(std::span<const double> x, bool guide) {
  std::optional<SearchCosts::Apart> apart;
  {
    const std::scoped_lock lock(mutex_);
    if (const auto found = known_.find({x.begin(), x.end()}); found != known_.end()) apart = found->second.apart;
  }
  if (!apart) apart = slopes_.apart(x);
  std::vector<double> values{guide ? apart->guide : apart->target};
  values.insert(values.end(), apart->excess.begin(), apart->excess.end());
  return values;
}

double GuidedSearch::cost_of(const Evaluation& e, Costs costs) const {
  return costs == Costs::guide && std::isfinite(e.value) ? known_.at(e.x).guide : e.value;
}

std::optional<GuidedSearch::Best> GuidedSearch::best(Costs costs) const {
  const Evaluation* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [index, e] : log_) {
    if (const double cost = cost_of(e, costs); cost < least) best = &e, least = cost;
  }
  return best ? std::optional<Best>({.evaluation = *best, .cost = least}) : std::nullopt;
}

std::vector<std::vector<double>> GuidedSearch::promising_points(const std::vector<Variable>& variables, Costs costs) const {
  std::vector<std::pair<double, const Evaluation*>> by_cost;
  for (const auto& [index, e] : log_) {
    if (std::isfinite(e.value)) by_cost.emplace_back(cost_of(e, costs), &e);
  }
  std::stable_sort(by_cost.begin(), by_cost.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const Evaluation*> ranked;
  for (const auto& [cost, e] : by_cost) ranked.push_back(e);
  const auto apart = [&](const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t k = 0; k < variables.size(); ++k) {
      if (std::abs(a[k] - b[k]) > separation * (variables[k].upper - variables[k].lower)) return true;
    }
    return false;
  };
  std::vector<std::vector<double>> chosen;
  for (const Evaluation* e : ranked) {
    if (chosen.size() == starts_of_the_second) break;
    if (std::all_of(chosen.begin(), chosen.end(), [&](const auto& other) { return apart(e->x, other); })) chosen.push_back(e->x);
  }
  return chosen;
}

std::optional<Evaluation> GuidedSearch::surest_below(double own, const std::vector<std::vector<double>>& others) const {
  const Evaluation* surest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [index, e] : log_) {
    if (!(e.value < own) || std::find(others.begin(), others.end(), e.x) != others.end()) continue;
    const double guide = known_.at(e.x).guide;
    if (guide < least) least = guide, surest = &e;
  }
  return surest ? std::optional(*surest) : std::nullopt;
}

OptimizerResult GuidedSearch::run(Problem problem, OptimizerOptions options, Costs costs, long more, long first_index) {
  const SearchBudget budget({.seconds = options.max_seconds});
  options.on_improvement = {};
  first_index_ = first_index;
  if (!log_.empty()) {
    std::vector<std::vector<double>> starts = promising_points(problem.variables, costs);
    std::ranges::copy_if(problem.starts, std::back_inserter(starts), [&](const auto& start) { return !known_.contains(start); });
    problem.starts = std::move(starts);
  }
  OptimizerOptions first = options;
  first.smooth = costs == Costs::target;
  if (costs == Costs::both) {
    first.max_evaluations -= options.max_evaluations / target_share;
    first.max_seconds *= 1 - 1.0 / target_share;
  }
  OptimizerResult result = stage(problem, first, costs == Costs::both || costs == Costs::guide);
  const bool goes_on = result.termination != Termination::interrupted && result.termination != Termination::failure;
  OptimizerOptions second = options;
  second.seed = ~options.seed;  // random numbers other than in the first stage
  second.goes_on = options.goes_on || costs == Costs::both;
  second.smooth = costs == Costs::both;
  second.max_evaluations -= result.evaluations;
  const bool lands = std::any_of(known_.begin(), known_.end(), [](const auto& one) { return one.second.bounce_free; });
  if (costs == Costs::guide || costs == Costs::target) second.max_evaluations = 0;
  if (costs == Costs::same) second.max_evaluations = lands || result.termination != Termination::evaluation_budget ? 0 : more;
  second.max_seconds = budget.seconds_left();
  if (goes_on && second.max_evaluations > 0 && second.max_seconds > 0) {
    if (!log_.empty()) first_index_ = log_.rbegin()->first + 1;
    problem.starts = promising_points(problem.variables, Costs::target);
    OptimizerResult own = stage(problem, second, false);
    own.evaluations += result.evaluations;
    own.message = costs == Costs::both
                      ? fmt::format("first by the cost of bounce: {}; then by the target's own: {}", result.message, own.message)
                      : fmt::format("without a landing: {}; then from the best points: {}", result.message, own.message);
    if (own.first_exception.empty()) own.first_exception = result.first_exception;
    result = std::move(own);
  }
  result.improvements = improvements_of(log_);
  if (!result.improvements.empty()) {
    result.x = result.improvements.back().x;
    result.value = result.improvements.back().value;
    if (result.termination == Termination::no_feasible_point) result.termination = Termination::evaluation_budget;
  }
  return result;
}

}  // namespace softland
