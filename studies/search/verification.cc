#include "studies/search/verification.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/require.h"
#include "model/constants.h"
#include "objectives/figures.h"
#include "studies/closing/checking_runs.h"

namespace softland {
namespace {

constexpr double as_hard = 1e-3;  // smaller relative excesses of impact figures over the plain step's are ignored

// Returns the figure of merit of a target for the closing `m`; infinite if the closing has no such figure. For a sum of
// targets, this is the weighted mean of the figures relative to the baseline.
double figure(const Aim& aim, const Metrics& m, const Metrics& baseline) {
  if (aim.has_own_objective() && !m.touched()) return std::numeric_limits<double>::infinity();
  const double value = aim.mean(m, baseline, [&](const TargetRow& row) {
    const double own = figure_of(row.figure).value(m), unit = figure_of(row.unit).value(baseline);
    return aim.is_sum() && unit > 0 ? own / unit : own;
  });
  return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

// Limits the slew of searched drives without max_slew: from one end of its range to the other, a drive then takes at least one
// period of the highest mode. Returns true if a limit changes.
bool make_gentle(SearchSetting& setting) {
  const double shortest_period = 2 * pi / setting.given.model.basis().angular_frequencies().maxCoeff();
  bool changes = false;
  for (const DriveSearch& s : setting.space.drives()) {
    DriverLimits& limits = setting.limits.at(s.drive);
    if (std::isfinite(limits.max_slew)) continue;
    limits.max_slew = (limits.max_voltage - limits.min_voltage) / shortest_period;
    changes = true;
  }
  return changes;
}

}  // namespace

Verification::Verification(const SearchSetting& setting, const OptimizeOptions& options)
    : worst_(by_the_worst_of_modes(setting)),
      given_(setting.given),
      baseline_(setting.baseline.metrics),
      target_(options.target),
      conditions_(setting.conditions),
      judges_hardness_(!options.target.has_own_objective() && !(broken(setting.conditions, setting.baseline.metrics) > 0)),
      progress_{.report = options.on_preparation} {
  if (!judges_hardness_ || !baseline_.is_bounce_free()) return;
  add({.scene = setting.baseline_scene,
       .cost = setting.baseline_cost,
       .family = "step",
       .variables = setting.space.variables(),
       .parameters = {},
       .is_plain_step = true});
}

bool Verification::Verified::better_than(const Verified& other) const {
  return std::tuple(-static_cast<int>(confidence), broken, excess, figure, cost) <
         std::tuple(-static_cast<int>(other.confidence), other.broken, other.excess, other.figure, other.cost);
}

std::optional<Varied> Verification::undone_by(const PreparedScene& scene) const {
  for (const OtherWay& way : other_numerics(scene)) {
    if (!met(simulated(scene, way).metrics)) return way.varied;
  }
  return std::nullopt;
}

void Verification::add(FoundWaveform candidate) {
  const double cost = candidate.cost;
  Closing closing = simulate(candidate.scene, true, progress_);
  const Metrics& m = closing.metrics;
  Verified now{.found = std::move(candidate),
               .closing = closing,
               .cost = cost,
               .figure = figure(target_, m, baseline_),
               .broken = broken(conditions_, m),
               .excess = excess(m),
               .confidence = met(m) && !(excess(m) > 0) ? Confidence::meets_goal
                             : m.is_bounce_free()       ? Confidence::bounce_free
                             : m.settled                ? Confidence::settles
                                                        : Confidence::touches};
  if (!target_.is_sum() && (target_.is_about(Target::bounce) || target_.is_about(Target::rebound)))
    now.figure = std::max(now.figure, given_.scene.metrics.significant_rebound);
  if (now.confidence == Confidence::meets_goal) {
    now.failed = undone_by(now.found.scene);
    if (!now.failed) now.confidence = Confidence::confirmed, now.cost = worst_.price(now.found.scene.signals()).target;
  }
  if (!best_ || now.better_than(*best_)) best_ = std::move(now);
}

double Verification::excess(const Metrics& m) const { return judges_hardness_ ? hardness_beyond_step(m, baseline_) : 0; }

double Verification::best_cost() const { return best_ ? best_->cost : std::numeric_limits<double>::infinity(); }

bool Verification::decided(double cost) const { return confirmed() && best_->cost <= cost; }

void Verification::move_to(OptimizeResult& result) {
  if (!best_) return;
  result.goal_met = best_->confidence >= Confidence::meets_goal;
  result.confirmed = best_->confidence == Confidence::confirmed;
  const Metrics& m = best_->closing.metrics;
  // If the plain step and the best waveform are equal in this figure, for example without a bounce, compare their costs.
  const double own = figure(target_, m, baseline_), of_step = figure(target_, baseline_, baseline_);
  // An unsettled closing can be better only than a plain step that makes contact and does not settle either.
  const bool may_be_better = (target_.from_the_start() != nullptr && m.touched()) || m.settled ||
                             (!baseline_.settled && std::isfinite(baseline_.initial_contact_time));
  result.better_than_baseline =
      may_be_better && (own < of_step || (own == of_step && result.goal_met && best_->found.cost < result.baseline_cost));
  for (const Condition& one : conditions_) {
    if (softland::broken({one}, m) > 0) result.broken_conditions.push_back(one.text);
  }
  result.plain_step_wins = best_->found.is_plain_step;
  result.harder_than_step = best_->excess;
  result.checks = run_checks(best_->found.scene);
  result.best_scene = std::move(best_->found.scene);
  result.best = std::move(best_->closing);
  result.family = std::move(best_->found.family);
  result.variables = std::move(best_->found.variables);
  result.parameters = std::move(best_->found.parameters);
  result.best_cost = best_->found.cost;
}

// True if a closing meets the goal and fulfils the conditions. Conditions on figures that its simulation does not compute are
// left out.
bool Verification::met(const Metrics& m) const { return goal_met(target_, m, baseline_) && !(broken(known(m), m) > 0); }

std::vector<Condition> Verification::known(const Metrics& m) const {
  std::vector<Condition> all;
  for (const Condition& one : conditions_) {
    if (std::isfinite(one.figure.value(m))) all.push_back(one);
  }
  return all;
}

double hardness_beyond_step(const Metrics& closing, const Metrics& step) {
  const double excess = excess_over_step(closing, step);
  return excess > as_hard ? excess : 0;
}

bool goal_met(const Aim& target, const Metrics& best, const Metrics& baseline) {
  if (target.from_the_start() != nullptr)
    return best.touched() && figure(target, best, baseline) < figure(target, baseline, baseline);
  if (!best.settled || best.bounce_count > 0) return false;
  if (!target.has_own_cost()) return true;
  // Compare a settling time with the plain step's first contact: to settle earlier than the plain step, which bounces for many
  // times its closing time, would be too weak a goal.
  const bool is_settling = !target.is_sum() && target.is_about(Target::settling);
  if (is_settling && std::isfinite(baseline.initial_contact_time))
    return best.permanent_contact_time <= settling_goal * baseline.initial_contact_time;
  return figure(target, best, baseline) < figure(target, baseline, baseline);
}

std::vector<SearchSetting> with_gentle_edges(const std::vector<SearchSetting>& settings, Actuator actuator,
                                             const std::string& families, const OwnWaveforms& own) {
  const SearchSetting& first = settings.front();
  if (with_more_modes(first.given.scene.device).empty()) return {};
  const std::vector<std::string> names = families_of(families);
  std::vector<SearchSetting> gentle = settings;
  for (std::size_t k = 0; k < settings.size(); ++k) {
    SearchSetting changed = settings[k];
    if (!make_gentle(changed)) return {};
    try {
      changed.space = SearchSpace(changed.within_limits(), actuator, names[k], first.scale.step.initial_contact_time, own);
    } catch (const InvalidInput&) {
      continue;
    }
    gentle[k] = std::move(changed);
  }
  return gentle;
}

bool begins_gently(const std::vector<SearchSetting>& gentle, const std::vector<StartingWaveforms>& starts) {
  if (gentle.empty()) return false;
  const SearchSetting& setting = gentle.front();
  const auto fits = [&](const DriveWaveforms& waveforms) { return setting.is_allowed(setting.space.searched(waveforms)); };
  return std::ranges::any_of(setting.space.drives(), [](const DriveSearch& s) { return s.drive == piezo_drive; }) &&
         (setting.starts_as_step() || fits(setting.given.drives.waveforms())) &&
         std::ranges::all_of(starts, [&](const StartingWaveforms& start) { return fits(start.waveforms); });
}

SearchSetting by_the_worst_of_modes(SearchSetting setting) {
  const std::vector<double> holds = hold_levels(setting.baseline_scene.signals());
  for (const Device& device : with_more_modes(setting.given.scene.device)) {
    RicherBeam beam{.model = Switch(device, quadrature_of_richer(setting.given.quadrature, device))};
    if (const auto closed = closed_equilibrium(beam.model, holds)) beam.closed_potential = closed->potential;
    setting.richer.push_back(std::move(beam));
  }
  return setting;
}

}  // namespace softland
