#include "studies/search/family_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace softland {
bool ParameterBlock::holds(std::span<const double> point) const { return !std::isnan(point[begin_]); }

std::vector<double> ParameterBlock::point(std::span<const double> own) const {
  std::vector<double> all(all_, std::numeric_limits<double>::quiet_NaN());
  std::copy(own.begin(), own.end(), all.begin() + static_cast<std::ptrdiff_t>(begin_));
  return all;
}

FamilySearch::FamilySearch(const SearchSetting& setting, const ParameterBlock& block, const OptimizeOptions& options,
                           std::function<void(const Evaluation&)> on_evaluation)
    : setting_(setting),
      block_(block),
      options_(options),
      problem_{.variables = setting.space.variables(), .starts = setting.space.starts()},
      stages_([this](std::span<const double> x) { return price(x); },
              [this, told = std::move(on_evaluation)](const Evaluation& e) { told(among_all(e)); }, slopes()) {}

SearchCosts FamilySearch::price(std::span<const double> own) const {
  LastClosing& last = last_of_thread();
  if (options_.memory == nullptr) return setting_.price_at(own, nullptr, &last);
  MemoryOfFamily memory(*options_.memory, block_);
  return setting_.price_at(own, &memory, &last);
}

LastClosing& FamilySearch::last_of_thread() const {
  const std::lock_guard lock(last_mutex_);
  return last_[std::this_thread::get_id()];
}

PriceSlopes FamilySearch::slopes() const {
  using Slope = std::function<std::vector<double>(std::span<const double>)>;
  if (setting_.target.from_the_start() != nullptr) return {};
  std::vector<ParameterGroup> groups;
  const auto of = [&](const Aim& aim) -> Slope {
    if (!setting_.gradient_refusal(aim).empty()) return {};
    if (groups.empty()) groups = setting_.parameter_groups();
    return [this, aim, groups](std::span<const double> x) { return setting_.gradient_at(x, aim, groups, &last_of_thread()); };
  };
  PriceSlopes all{.leading = of(Target::bounce),
                  .own = of(setting_.target.has_own_cost() ? setting_.target : Aim(Target::bounce))};
  if (!all.leading || !all.own) return all;
  all.conditions = setting_.followed_conditions().size();
  all.apart = [this](std::span<const double> x) { return setting_.price_at(x).apart.value_or(SearchCosts::Apart()); };
  return all;
}

void FamilySearch::begin_at(const DriveWaveforms& waveforms) {
  const SearchSpace& space = setting_.space;
  const auto ahead = problem_.starts.end() - static_cast<std::ptrdiff_t>(space.starts().size());
  if (const auto point = space.parameters(waveforms)) {
    problem_.starts.insert(ahead, *point);
  } else if (space.misfit(waveforms).empty()) {
    problem_.starts.insert(ahead, space.nearest(waveforms));
  }
}

void FamilySearch::begin_at_point(const std::vector<double>& own) {
  problem_.starts.insert(problem_.starts.end() - static_cast<std::ptrdiff_t>(setting_.space.starts().size()), own);
}

std::vector<double> FamilySearch::own(const Evaluation& e) const {
  const std::span<const double> x = block_.own(e.x);
  return {x.begin(), x.end()};
}

std::vector<double> FamilySearch::point(const DriveWaveforms& waveforms) const {
  const auto own = setting_.space.parameters(waveforms);
  return own ? block_.point(*own) : std::vector<double>();
}

OptimizerResult FamilySearch::run(const OptimizerOptions& share, Costs costs, long more, long first_index) {
  return stages_.run(problem_, share, costs, more, first_index);
}

std::optional<GuidedSearch::Best> FamilySearch::best(Costs costs) const {
  std::optional<GuidedSearch::Best> found = stages_.best(costs);
  if (found) found->evaluation = among_all(std::move(found->evaluation));
  return found;
}

Evaluation FamilySearch::among_all(Evaluation e) const {
  e.x = block_.point(e.x);
  return e;
}

DriveWaveforms FamilySearch::waveforms(const Evaluation& e) const { return setting_.space.waveforms(block_.own(e.x)); }

std::optional<SceneFile> FamilySearch::scene(const Evaluation& e) const {
  const DriveWaveforms all = waveforms(e);
  return can_be_written(all) ? std::optional(setting_.scene(all)) : std::nullopt;
}

std::map<std::string, double> FamilySearch::named(const Evaluation& e) const {
  std::map<std::string, double> parameters;
  const std::span<const double> x = block_.own(e.x);
  for (std::size_t k = 0; k < x.size(); ++k) parameters[problem_.variables[k].name] = x[k];
  return parameters;
}

std::vector<Evaluation> FamilySearch::log() const {
  std::vector<Evaluation> all;
  for (const auto& [index, e] : stages_.log()) all.push_back(among_all(e));
  return all;
}

std::optional<Evaluation> FamilySearch::surest_below(double own, const std::vector<std::vector<double>>& others) const {
  std::vector<std::vector<double>> own_others;
  for (const std::vector<double>& other : others) {
    const std::span<const double> x = block_.own(other);
    if (block_.holds(other)) own_others.emplace_back(x.begin(), x.end());
  }
  const std::optional<Evaluation> found = stages_.surest_below(own, own_others);
  return found ? std::optional(among_all(*found)) : std::nullopt;
}

}  // namespace softland
