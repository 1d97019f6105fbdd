#include "studies/search/tournament.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>

#include "optimizers/sobol.h"
#include "sampling/statistics.h"

namespace softland {
namespace {

// Number of latest candidate waveforms whose median cost is the limit for the next candidate.
constexpr std::size_t remembered = 14;
constexpr std::size_t fewest_remembered = 5;

}  // namespace

StagedCost::Tried StagedCost::tried(const std::vector<double>& x, std::size_t most, double hopeless, int jobs) const {
  const std::size_t devices = std::min(most, cost_.devices());
  const DriveWaveforms searched = setting_.space.waveforms(x);
  if (!setting_.is_allowed(searched)) return {};
  const EvaluationKey key{.family = setting_.family, .x = x, .devices = devices, .seed = seed_, .hopeless = hopeless};
  if (memory_ != nullptr) {
    if (const auto known = memory_->recall(key)) return {.cost = known->cost, .closings = known->closings};
  }
  const std::vector<Waveform> drives = setting_.drives(searched);
  std::vector<DeviceOutcome> outcomes;
  EvaluationValues found{.closings = 0};
  for (const std::size_t stage : {stages[0], stages[1], devices}) {
    if (stage > devices || stage <= outcomes.size()) continue;
    const std::vector<DeviceOutcome> more = cost_.close(drives, outcomes.size(), stage, jobs);
    found.closings += static_cast<long>(more.size());
    outcomes.insert(outcomes.end(), more.begin(), more.end());
    found.cost = cost_.value(outcomes, aim_);
    if (found.cost > hopeless) break;
  }
  if (memory_ != nullptr) memory_->note(key, found);
  return {.cost = found.cost, .closings = found.closings};
}

ChainEnd search_chain(const StagedCost& cost, const Chain& chain, SearchBudget& budget,
                      const std::function<void(const std::vector<double>& x, double cost)>& on_candidate) {
  ChainEnd best;
  std::deque<double> recent;
  std::atomic<bool> enough = false;
  const auto median = [&] {
    return recent.size() < fewest_remembered ? std::numeric_limits<double>::infinity()
                                             : sample_quantile(std::vector<double>(recent.begin(), recent.end()), 0.5);
  };
  const auto objective = [&](std::span<const double> given) {
    const std::vector<double> x(given.begin(), given.end());
    const StagedCost::Tried tried = cost.tried(x, chain.devices, median(), chain.jobs);
    best.closings += tried.closings;
    if (std::isfinite(tried.cost)) recent.push_back(tried.cost);
    if (recent.size() > remembered) recent.pop_front();
    if (tried.cost < best.cost) best.x = x, best.cost = tried.cost;
    budget.took(tried.closings);
    if (budget.over() || best.closings >= chain.closings) enough = true;
    on_candidate(
        x,
        tried.cost);  // call `on_candidate` after the budget has counted the closings, since `on_candidate` may throw Interrupted
    if (budget.interrupted()) enough = true;
    return tried.cost;
  };
  static_cast<void>(minimize({.variables = cost.variables(), .objective = objective, .starts = {chain.start}},
                             {.optimizer = "cma-es",
                              .max_evaluations = chain.closings,
                              .seed = chain.seed,
                              .step = chain.step,
                              .population = chain.population,
                              .stop = &enough}));
  return best;
}

std::vector<std::vector<double>> starting_points(const SearchSetting& setting, const std::vector<DriveWaveforms>& others) {
  std::vector<std::vector<double>> all = setting.space.starts();
  if (const auto given = setting.space.parameters(setting.given.drives.waveforms())) all.push_back(*given);
  for (const DriveWaveforms& waveforms : others) {
    if (setting.space.misfit(waveforms).empty()) all.push_back(setting.space.nearest(waveforms));
  }
  return all;
}

std::vector<std::vector<double>> points_of_box(const std::vector<Variable>& variables, std::uint64_t seed, std::uint64_t count) {
  std::vector<std::vector<double>> all = internal::sobol_points(seed, variables.size(), 0, count);
  for (std::vector<double>& u : all) {
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = variables[i].lower + u[i] * (variables[i].upper - variables[i].lower);
  }
  return all;
}

ImprovingClosings improve(std::vector<double>& x, const StagedCost& cost, Chain chain, SearchBudget& budget,
                          const std::function<void()>& on_candidate) {
  const StagedCost::Tried before = cost.tried(x, chain.devices, std::numeric_limits<double>::infinity(), chain.jobs);
  chain.start = x;
  ChainEnd end = search_chain(cost, chain, budget, [&](const std::vector<double>&, double) { on_candidate(); });
  if (end.cost < before.cost) x = std::move(end.x);
  return {.before = before.closings, .searched = end.closings};
}

}  // namespace softland
