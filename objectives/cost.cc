#include "objectives/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/require.h"

namespace softland {
namespace {

void require_not_negative(const OwnObjective& objective, double value) {
  require(!(value < 0), [&] { return fmt::format("the own objective '{}' gives {}; it must be >= 0", objective.name(), value); });
}

}  // namespace

Aim::Aim(std::vector<Part> parts) : parts_(std::move(parts)) {
  require(!parts_.empty(), "a search needs a target or an own objective");
  for (auto part = parts_.begin(); part != parts_.end(); ++part) {
    require(part->weight > 0 && std::isfinite(part->weight),
            fmt::format("the weight of {} is {}; it must be finite and > 0", part->name(), part->weight));
    const auto is_same = [&](const Part& other) { return other.own == part->own && (other.own || other.target == part->target); };
    require(std::none_of(parts_.begin(), part, is_same),
            fmt::format("{} appears twice in a sum of targets; name each target once", part->name()));
  }
}

std::shared_ptr<const OwnObjective> Aim::refuse_null(std::shared_ptr<const OwnObjective> objective) {
  require(objective != nullptr, "an own objective must not be null");
  return objective;
}

void Aim::own_values(const OwnObjective& objective, std::span<const Metrics> closings, const Metrics& step,
                     std::span<double> values) {
  if (closings.empty()) return;
  objective.values(closings, step, values);
  for (const double one : values) require_not_negative(objective, one);
}

double Aim::own_value(const OwnObjective& objective, const Metrics& closing, const Metrics& step) {
  const double value = objective.value(closing, step);
  require_not_negative(objective, value);
  return value;
}

Aim Aim::in_units_of(const Metrics& step) const {
  constexpr double small = 0.01, large = 100;
  Aim all = *this;
  for (Part& part : all.parts_) {
    if (!part.own) continue;
    const double value = own_value(*part.own, step, step);
    require(std::isfinite(value), [&] {
      return fmt::format("the own objective '{}' gives {} for the plain step; it must be finite", part.own->name(), value);
    });
    if (value > 0 && (value < small || value > large)) part.unit = value;
  }
  return all;
}

bool Aim::has_own_cost() const {
  if (is_sum()) return true;
  return parts_[0].own ? parts_[0].own->lands_first() : softland::has_own_cost(parts_[0].target);
}

bool Aim::has_own_objective() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.own != nullptr; });
}

bool Aim::measures_drive_energy() const { return is_about(Target::drive) || has_own_objective(); }

const OwnObjective* Aim::from_the_start() const { return has_own_cost() ? nullptr : parts_[0].own.get(); }

bool Aim::is_about(Target target) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) { return !part.own && part.target == target; });
}

std::string Aim::text() const {
  if (!is_sum()) return std::string(parts_[0].name());
  std::string text;
  for (const Part& part : parts_) text += fmt::format("{}{} {}", text.empty() ? "" : " + ", part.weight, part.name());
  return text;
}

double excess_over_step(const Metrics& closing, const Metrics& step) {
  double excess = 0;
  for (double Metrics::*figure : hard_figures) {
    const double ratio = Shares::ratio(closing.*figure, step.*figure);
    if (ratio > 1 + excess) excess = ratio - 1;
  }
  return excess;
}

double cost(const Aim& aim, const Metrics& m, const CostScale& scale, const MetricsOptions& options) {
  if (!m.is_complete()) return std::numeric_limits<double>::infinity();
  if (!m.touched()) return 10 + m.closest / scale.contact_gap;
  Shares shares{.own = m, .step = scale.step, .window = scale.score_window};
  const double h = shares.of(&Metrics::major_bounce_height);
  const double p = m.major_bounce_height / (m.major_bounce_height + 10 * options.significant_rebound);
  const double v = shares.of(&Metrics::largest_impact_velocity);
  // The energy above the closed equilibrium (landing_excess) is unknown when a drive does not come to rest within the run. The
  // cost then consists of the other figures of the closing.
  const double k = std::isnan(m.landing_excess) ? 0 : shares.of(&Metrics::landing_excess);
  const double s = m.separated / scale.score_window;
  const double t = shares.of(&Metrics::initial_contact_time);
  const double late = t + 10 * std::max(0.0, t - scale.free_touch);
  shares.lead = 0.2 * h + 0.15 * v * v + 0.45 * k + 0.1 * s * s + 0.05 * p + 0.02 * late;
  const double excess = scale.judges_hardness && !aim.has_own_objective() ? excess_over_step(m, scale.step) : 0;
  shares.lead += excess;
  // A contact that is open again at the end of the run costs more than every contact that stays closed, and less than a run
  // without contact.
  const double reopening = m.reopened ? 5 : 0;
  if (!aim.has_own_cost() && aim.from_the_start() == nullptr) return reopening + shares.lead;
  const double own = aim.mean(m, scale.step, [&](const TargetRow& row) { return row.in(row.nominal, shares); });
  double judged = 1 + (shares.lead + own) / 2;
  if (aim.from_the_start() != nullptr) {
    judged = own / (1 + own);
  } else if (!(m.major_bounce_height > options.significant_rebound / 2)) {
    const double ordered = own + excess + shares.lead / 1000;
    judged = ordered / (1 + ordered);
  }
  const double cost = reopening + judged;
  return std::isnan(cost) ? std::numeric_limits<double>::infinity() : cost;
}

}  // namespace softland
