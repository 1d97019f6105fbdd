#include "studies/search/tournament.h"

#include "optimizers/sobol.h"

namespace softland {

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
