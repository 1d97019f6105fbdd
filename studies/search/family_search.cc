#include "studies/search/family_search.h"

#include <utility>

namespace softland {
FamilySearch::FamilySearch(const SearchSetting& setting, const OptimizeOptions& options,
                           std::function<void(const Evaluation&)> on_evaluation)
    : setting_(setting),
      options_(options),
      problem_{.variables = setting.space.variables(), .starts = setting.space.starts()},
      stages_([this](std::span<const double> x) { return setting_.cost_at(x, options_.memory, &last_of_thread()); },
              [this, told = std::move(on_evaluation)](const Evaluation& e) { told(numbered(e)); }, slopes()) {}

LastClosing& FamilySearch::last_of_thread() const {
  const std::lock_guard lock(last_mutex_);
  return last_[std::this_thread::get_id()];
}

CostGradients FamilySearch::slopes() const {
  using Slope = std::function<std::vector<double>(std::span<const double>)>;
  if (setting_.target.from_the_start() != nullptr) return {};
  std::vector<ParameterGroup> groups;
  const auto of = [&](const Aim& aim) -> Slope {
    if (!setting_.gradient_refusal(aim).empty()) return {};
    if (groups.empty()) groups = setting_.parameter_groups();
    return [this, aim, groups](std::span<const double> x) { return setting_.gradient_at(x, aim, groups, &last_of_thread()); };
  };
  CostGradients all{.guide = of(Target::bounce),
                    .target = of(setting_.target.has_own_cost() ? setting_.target : Aim(Target::bounce))};
  if (!all.guide || !all.target) return all;
  all.conditions = setting_.followed_conditions().size();
  all.apart = [this](std::span<const double> x) { return setting_.cost_at(x).apart.value_or(SearchCosts::Apart()); };
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

void FamilySearch::begin_at_point(const std::vector<double>& x) {
  problem_.starts.insert(problem_.starts.end() - static_cast<std::ptrdiff_t>(setting_.space.starts().size()), x);
}

OptimizerResult FamilySearch::run(const OptimizerOptions& share, Costs costs, long more, long first_index) {
  return stages_.run(problem_, share, costs, more, first_index);
}

std::optional<GuidedSearch::Best> FamilySearch::best(Costs costs) const {
  std::optional<GuidedSearch::Best> found = stages_.best(costs);
  if (found) found->evaluation.problem = setting_.family;
  return found;
}

Evaluation FamilySearch::numbered(Evaluation e) const {
  e.problem = setting_.family;
  return e;
}

std::map<std::string, double> FamilySearch::named(const Evaluation& e) const {
  std::map<std::string, double> parameters;
  for (std::size_t k = 0; k < e.x.size(); ++k) parameters[problem_.variables[k].name] = e.x[k];
  return parameters;
}

std::optional<Evaluation> FamilySearch::surest_below(double own, const std::vector<Evaluation>& others) const {
  std::vector<std::vector<double>> of_family;
  for (const Evaluation& other : others) {
    if (other.problem == setting_.family) of_family.push_back(other.x);
  }
  const std::optional<Evaluation> found = stages_.surest_below(own, of_family);
  return found ? std::optional(numbered(*found)) : std::nullopt;
}

}  // namespace softland
