// The cost that a search minimises. It relates figures of a closing to those of the plain step, a jump to the same hold levels,
// so that the plain step ("the step" below) costs about 1.
//
// Bounce count and settling time jump when a rebound just reaches the contact plane, and they are chaotic after the first large
// rebound: no search minimises them directly. Every search first minimises the smooth cost of `bounce`, which leads to closings
// without a significant rebound. There the other figures are smooth, and a search for another figure continues with that
// figure.
// Every cost is computed over a fixed time after first contact, the score window, so that a late first contact hides no bounce.
//
//   H  highest rebound, over that of the step           V  largest impact velocity, over that of the step
//   K  energy above the closed equilibrium once the switch has touched and the drives are at their hold levels, over that of
//      the step: a squared velocity that also contains the vibration of the beam behind the contact point
//   S  time in separation after first touch, over the score window
//   P  h / (h + 10 h_s), h the highest rebound, h_s the least height of a significant rebound: it resolves rebounds of
//      nanometres, as H does not
//   T  first touch, over that of the step               L  T + 10 max(0, T - T_free): lateness; T_free: see CostScale
//
//   bounce, rebound, count     B = 0.2 H + 0.15 V^2 + 0.45 K + 0.1 S^2 + 0.05 P + 0.02 L
//   settling, impact, energy,  f / (1 + f) with f = F + B / 1000 where h <= h_s / 2, and 1 + (B + F) / 2 for a closing with a
//   force, drive, steady       higher rebound; F is the target's own figure over that of the step.
//                              settling: end of the last significant rebound, first touch if none, over first touch of the
//                              step; impact: V; energy: root of impact energy over that of the step (for a soft touch the
//                              ratio itself can be some 1e-4, less than B / 1000); force: largest contact force;
//                              drive: energy that the drives give until the end of the score window; steady: time from which
//                              the contact force is steady (end of the window if it is not) over first touch of the step
//
// A closing without a rebound can still hit harder than the plain step. So E is added to B, and to F in f: the largest relative
// excess of impact velocity, peak contact force and impact energy over those of the step. E is 0 when the plain step breaks a
// condition that the user sets on a figure, and for an own objective.
//
// A weighted sum of targets has the weighted mean of their F; the F of bounce, rebound and count is B. The F of a user's own
// objective is its value (own_objective.h); the cost is F / (1 + F) for an own objective whose lands_first() is false.
//
// K has the largest weight in B: it is smooth even where the rebounds are chaotic, and where it is small there are no rebounds.
// Squares make the sum flat and well-conditioned near a soft closing. Lateness costs little up to T_free and much beyond: the
// softest closing would be a very late one. The bound h_s / 2 leaves a margin for the difference of a run at full accuracy. A
// closing that never reaches contact costs 10 plus the part of the gap that remains, which leads the search towards contact. A
// closing that fails (touches the electrode, leaves the laws' validity, cannot be integrated) is infeasible: its cost is
// infinity.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "objectives/figures.h"
#include "objectives/metrics.h"
#include "objectives/own_objective.h"

namespace softland {

/// The figures of a closing, and those of the plain voltage step that divide them in the cost of a target.
struct Shares {
  const Metrics &own, &step;
  double lead = 0;    ///< cost of the target `bounce` for this closing: B + E in the formulas above
  double window = 0;  ///< time after the first touch over which the closing was simulated [s]

  /// Returns `value` over `of_step`, a figure of the plain voltage step. If `of_step` is 0, returns 1 for a positive value and
  /// 0 for 0. Returns NaN when `value` is NaN.
  [[nodiscard]] static double ratio(double value, double of_step) {
    if (std::isnan(value)) return value;
    return of_step > 0 ? value / of_step : value > 0 ? 1 : 0;
  }
  /// Returns a figure of the closing over the same figure, or the figure `unit`, of the plain voltage step.
  [[nodiscard]] double of(double Metrics::*figure) const { return ratio(own.*figure, step.*figure); }
  [[nodiscard]] double of(double Metrics::*figure, double Metrics::*unit) const { return ratio(own.*figure, step.*unit); }
  /// Returns a time of the closing, over the first contact time of the plain voltage step. A time that is never reached (NaN)
  /// counts as twice the end of the run, a penalty.
  [[nodiscard]] double of_time(double time) const {
    const double known = std::isfinite(time) ? time : 2 * (own.initial_contact_time + window);
    return ratio(known, step.initial_contact_time);
  }
};

enum class Target { bounce, settling, rebound, count, impact, energy, force, drive, steady, electrical };
/// Properties of a target of a search. A new target needs an enumerator and an entry in `targets`.
struct TargetRow {
  using Form = double (*)(const Shares&);

  Target value;
  std::string_view name;
  /// Figure by which results are compared. It also is the target's cost, over the figure of the plain voltage step, when the
  /// cost function is null.
  Figure::Member figure;
  Figure::Member unit = figure;  ///< figure of the plain voltage step that divides `figure` in a sum of targets
  /// True when a search for the target continues with `figure` after the cost of `bounce`; false for figures that cannot
  /// improve further once no rebound is significant.
  bool has_own_cost = true;
  Form nominal = nullptr;             ///< cost function of a search on the nominal device; null: cost from `figure`
  Form robust = nullptr;              ///< cost function of a search under process variation; null: cost from `figure`
  std::string_view no_gradient = {};  ///< reason why the cost of the target has no gradient; empty when the cost has one

  [[nodiscard]] double in(Form form, const Shares& shares) const {
    if (form != nullptr) return form(shares);
    const Figure& own = figure_of(figure);
    return Shares::ratio(own.value(shares.own), own.value(shares.step));
  }
};
namespace internal {
inline double lead(const Shares& s) { return s.lead; }
/// Returns a time of the closing over the first contact time of the plain voltage step; a time that is never reached counts as
/// the end of the run.
inline double time_or_end(const Shares& s, double Metrics::*time) {
  return s.of(std::isfinite(s.own.*time) ? time : &Metrics::end, &Metrics::initial_contact_time);
}
inline double largest_speed(const Shares& s) { return s.of(&Metrics::largest_impact_velocity); }
}  // namespace internal
inline constexpr auto targets = std::to_array<TargetRow>({
    {.value = Target::bounce,
     .name = "bounce",
     .figure = &Metrics::major_bounce_height,
     .has_own_cost = false,
     .nominal = internal::lead,
     .robust = [](const Shares& s) { return (internal::largest_speed(s) + s.of(&Metrics::major_bounce_height)) / 2; }},
    {.value = Target::settling,
     .name = "settling",
     .figure = &Metrics::permanent_contact_time,
     .unit = &Metrics::initial_contact_time,  // the plain step may never settle: divide by its first contact time
     .nominal = [](const Shares& s) { return s.of(&Metrics::last_rebound_end, &Metrics::initial_contact_time); },
     .robust = [](const Shares& s) { return s.of_time(s.own.permanent_contact_time); }},
    {.value = Target::rebound,
     .name = "rebound",
     .figure = &Metrics::major_bounce_height,
     .has_own_cost = false,
     .nominal = internal::lead},
    {.value = Target::count, .name = "count", .figure = &Metrics::bounce_count, .has_own_cost = false, .nominal = internal::lead},
    {.value = Target::impact,
     .name = "impact",
     .figure = &Metrics::impact_velocity,
     .nominal = internal::largest_speed,
     .robust = internal::largest_speed},
    {.value = Target::energy,
     .name = "energy",
     .figure = &Metrics::impact_energy,
     .nominal = [](const Shares& s) { return std::sqrt(s.of(&Metrics::impact_energy)); }},
    {.value = Target::force, .name = "force", .figure = &Metrics::peak_contact_force},
    {.value = Target::drive,
     .name = "drive",
     .figure = &Metrics::drive_energy,
     .no_gradient = "the energy of the drives has no gradient"},
    {.value = Target::steady,
     .name = "steady",
     .figure = &Metrics::steady_force_time,
     .nominal = [](const Shares& s) { return internal::time_or_end(s, &Metrics::steady_force_time); },
     .robust = [](const Shares& s) { return s.of_time(s.own.steady_force_time); },
     .no_gradient = "the time from which the contact force is steady has no gradient"},
    {.value = Target::electrical,
     .name = "electrical",
     .figure = &Metrics::electrical_settling,
     // The plain step may never close electrically: divide by its first contact time.
     .unit = &Metrics::initial_contact_time,
     .nominal = [](const Shares& s) { return internal::time_or_end(s, &Metrics::electrical_settling); },
     .robust = [](const Shares& s) { return s.of_time(s.own.electrical_settling); },
     .no_gradient = "the time from which the switch is electrically closed has no gradient"},
});
static_assert(is_complete<targets>());
[[nodiscard]] constexpr std::string_view to_string(Target target) { return name_of(targets, target); }
[[nodiscard]] constexpr bool has_own_cost(Target target) { return row_of(targets, target).has_own_cost; }
/// Returns the figure that a search for the target minimises.
[[nodiscard]] constexpr const Figure& figure_of(Target target) { return figure_of(row_of(targets, target).figure); }

/// The aim of a search: a single target, a user's own objective, or a weighted sum of several of them.
class Aim {
 public:
  struct Part {
    Target target = Target::bounce;
    double weight = 1;
    std::shared_ptr<const OwnObjective> own = nullptr;  ///< a user's own objective, which replaces the target
    double unit = 1;                                    ///< divisor of the own objective's values, see in_units_of()

    [[nodiscard]] std::string_view name() const { return own ? own->name() : to_string(target); }
  };
  Aim(Target target) : parts_{{.target = target}} {}  // NOLINT(google-explicit-constructor): a single target is an aim
  /// Takes a user's own objective. Throws InvalidInput when the objective is a null pointer.
  explicit Aim(std::shared_ptr<const OwnObjective> objective)
      : Aim(std::vector<Part>{{.own = refuse_null(std::move(objective))}}) {}
  /// Takes a weighted sum of targets and own objectives. Throws InvalidInput unless there is a part, weights are finite and >
  /// 0, and no target or own objective occurs twice.
  explicit Aim(std::vector<Part> parts);

  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  [[nodiscard]] bool is_sum() const { return parts_.size() > 1; }
  /// Returns true when a search for this aim first minimises the cost of `bounce` and then another cost. The result is
  /// TargetRow::has_own_cost for a single target, lands_first() for a single own objective, and true for a sum.
  [[nodiscard]] bool has_own_cost() const;
  [[nodiscard]] bool is_about(Target target) const;
  /// Returns true when a part of the aim is a user's own objective.
  [[nodiscard]] bool has_own_objective() const;
  /// Returns true when the cost of the aim needs the drive energy: for the target `drive`, and for every user's own objective,
  /// whose value may depend on this energy.
  [[nodiscard]] bool measures_drive_energy() const;
  /// Returns the user's own objective that a search minimises from its first evaluation on; null when the search first
  /// minimises the cost of `bounce`.
  [[nodiscard]] const OwnObjective* from_the_start() const;
  /// Returns this aim with other units for its own objectives: if an own objective's value for the plain voltage step is below
  /// 0.01 or above 100, its values are divided by this value. Throws InvalidInput when the value for the plain step is not
  /// finite.
  [[nodiscard]] Aim in_units_of(const Metrics& step) const;
  /// Returns the aim as text, for example "bounce" or "0.7 bounce + 0.3 energy".
  [[nodiscard]] std::string text() const;
  /// Returns the weighted mean over the parts of the aim. A target contributes value(row), row being its TargetRow; a user's
  /// own objective contributes its value for this closing, given the plain step. Throws InvalidInput when the own objective's
  /// value is below 0.
  template <class Value>
  [[nodiscard]] double mean(const Metrics& closing, const Metrics& step, const Value& value) const {
    const auto of = [&](const Part& part) {
      return part.own ? own_value(*part.own, closing, step) / part.unit : value(row_of(targets, part.target));
    };
    if (!is_sum()) return of(parts_[0]);
    double sum = 0, weights = 0;
    for (const Part& part : parts_) sum += part.weight * of(part), weights += part.weight;
    return sum / weights;
  }

  /// Returns mean(), the weighted mean over the parts of the aim, for each of many closings; calls a user's own objective once
  /// for all closings. A target contributes value(row, closing).
  template <class Value>
  [[nodiscard]] std::vector<double> means(std::span<const Metrics> closings, const Metrics& step, const Value& value) const {
    std::vector<double> sums(closings.size(), 0), of_part(closings.size());
    double weights = 0;
    for (const Part& part : parts_) {
      if (part.own) own_values(*part.own, closings, step, of_part);
      const double weight = is_sum() ? part.weight : 1;
      for (std::size_t k = 0; k < closings.size(); ++k)
        sums[k] += weight * (part.own ? of_part[k] / part.unit : value(row_of(targets, part.target), closings[k]));
      weights += weight;
    }
    if (is_sum()) {
      for (double& sum : sums) sum /= weights;
    }
    return sums;
  }

 private:
  static void own_values(const OwnObjective& objective, std::span<const Metrics> closings, const Metrics& step,
                         std::span<double> values);
  [[nodiscard]] static std::shared_ptr<const OwnObjective> refuse_null(std::shared_ptr<const OwnObjective> objective);
  [[nodiscard]] static double own_value(const OwnObjective& objective, const Metrics& closing, const Metrics& step);

  std::vector<Part> parts_;
};

/// Figures that measure how hard a closing hits the contact, for the comparison with the plain voltage step.
inline constexpr auto hard_figures =
    std::to_array({&Metrics::largest_impact_velocity, &Metrics::peak_contact_force, &Metrics::impact_energy});
/// Returns the largest relative excess of the closing's hard_figures over those of the plain voltage step; 0 when no figure
/// exceeds that of the step.
[[nodiscard]] double excess_over_step(const Metrics& closing, const Metrics& step);

/// Reference values by which the cost divides the figures of a closing. The closings and the plain step are simulated until a
/// fixed time after first contact, score_window.
struct CostScale {
  Metrics step;                 ///< figures of the closing by the plain voltage step
  double score_window = 0;      ///< time after first contact over which the cost is computed [s]
  double contact_gap = 0;       ///< distance from the rest position to the contact plane [m]
  double free_touch = 0;        ///< first contact time up to which lateness costs little, over that of the plain voltage step
  bool judges_hardness = true;  ///< false: a closing that hits harder than the plain voltage step has no penalty
};
/// Returns the cost of a closing; infinite for a run that could not be simulated to its end.
[[nodiscard]] double cost(const Aim& aim, const Metrics& figures, const CostScale& scale, const MetricsOptions& options);

}  // namespace softland
