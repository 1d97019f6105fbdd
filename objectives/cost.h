// What a search minimises, normalised by the plain step to the same hold level, so that the step costs about 1.
//
// Bounce count and settling time jump at grazing rebounds and, past the first macro-bounce, are properties of a cloud of runs
// rather than of one: no search is led by them. Every search first follows the smooth cost of `bounce`, which leads to closings
// without a significant rebound. There the other figures are well-conditioned, and a search for one of them goes on by that
// figure itself. Every cost is scored over a fixed time after first contact, so that landing late hides no bounce.
//
//   H  highest rebound, over that of the step           V  largest touch speed, over that of the step
//   K  energy above the closed equilibrium once the switch has touched and the drives stand at their hold levels, over that of
//      the step: a squared velocity that also sees the vibration of the beam behind the contact point
//   S  time in separation after first touch, over the score window
//   P  h / (h + 10 h_s), h the highest rebound, h_s the significant height: the last nanometres, which H no longer sees
//   T  first touch, over that of the step               L  T + 10 max(0, T - T_free): lateness
//
//   bounce, rebound, count     B = 0.2 H + 0.15 V^2 + 0.45 K + 0.1 S^2 + 0.05 P + 0.02 L
//   settling, impact, energy,  f / (1 + f) with f = F + B / 1000 where h <= h_s / 2, and 1 + (B + F) / 2 where the closing
//   force, drive, steady       rebounds higher; F is the target's own figure over that of the step. settling: end of the last
//                              significant rebound, first touch if none, over first touch of the step; impact: V; energy: root
//                              of impact energy over that of the step (of a soft touch that ratio itself can be some 1e-4, and
//                              B / 1000 would lead); force: largest contact force; drive: energy that the drives give
//                              within the score; steady: from when on the contact force is steady over first touch of the
//                              step, the end of the score where it is not
//
// A weighted sum of targets has the weighted mean of their F, those of bounce, rebound and count being B.
//
// K leads B: it is smooth where the rebounds are a chaotic sequence, and where it is small there are none. Squares make the sum
// flat and well-conditioned near a soft landing. Lateness costs little up to T_free and much beyond: the softest landing is a
// late one. The bound of half a significant height leaves room for what a run at full accuracy adds. A closing that never touches
// costs 10 plus the part of the gap it left, so that the search is led towards contact; one that fails (touches the electrode,
// leaves the laws' validity, cannot be integrated) is infeasible: infinity.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "base/choice.h"
#include "model/closing/observer.h"
#include "model/trajectory.h"
#include "objectives/metrics.h"

namespace softland {

enum class Target { bounce, settling, rebound, count, impact, energy, force, drive, steady };
struct TargetRow {
  Target value;
  std::string_view name;
  /// Whether a search for the target goes on by a figure of its own once it has followed the cost of `bounce`. Without a
  /// significant rebound those of the others have no more to give.
  bool has_own_cost;
};
inline constexpr auto targets = std::to_array<TargetRow>({{Target::bounce, "bounce", false},
                                                          {Target::settling, "settling", true},
                                                          {Target::rebound, "rebound", false},
                                                          {Target::count, "count", false},
                                                          {Target::impact, "impact", true},
                                                          {Target::energy, "energy", true},
                                                          {Target::force, "force", true},
                                                          {Target::drive, "drive", true},
                                                          {Target::steady, "steady", true}});
static_assert(is_complete<targets>());
[[nodiscard]] constexpr std::string_view to_string(Target target) { return name_of(targets, target); }
[[nodiscard]] constexpr bool has_own_cost(Target target) { return row_of(targets, target).has_own_cost; }

/// What a search minimises: one target, or a sum of several with weights.
class Aim {
 public:
  struct Part {
    Target target;
    double weight = 1;
  };
  Aim(Target target) : parts_{{.target = target}} {}  // NOLINT(google-explicit-constructor): a target is an aim
  /// Throws InvalidInput unless there is a part, weights are finite and > 0, and no target stands twice.
  explicit Aim(std::vector<Part> parts);

  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  [[nodiscard]] bool is_sum() const { return parts_.size() > 1; }
  /// Of one target its own; a sum always has one.
  [[nodiscard]] bool has_own_cost() const { return is_sum() || softland::has_own_cost(parts_[0].target); }
  [[nodiscard]] bool is_about(Target target) const;
  /// "bounce", "0.7 bounce + 0.3 energy"
  [[nodiscard]] std::string text() const;
  /// The sum of value(target) with these weights, over the sum of the weights.
  template <class Value>
  [[nodiscard]] double mean(const Value& value) const {
    if (!is_sum()) return value(parts_[0].target);
    double sum = 0, weights = 0;
    for (const Part& part : parts_) sum += part.weight * value(part.target), weights += part.weight;
    return sum / weights;
  }

 private:
  std::vector<Part> parts_;
};

/// The raw figures behind the costs, over a run that ends a fixed time after first contact.
struct CostFigures {
  bool touched = false;
  bool reopened = false;         ///< at the end of the run, by more than half of the contact gap
  double closest = 0;            ///< smallest separation while nothing touched [m]
  double first_touch = 0;        ///< [s]
  double touch_speed = 0;        ///< largest over all touches [m/s]
  double rebound_height = 0;     ///< [m]
  double separated = 0;          ///< time above the first-touch plane after first touch [s]
  double last_rebound_end = 0;   ///< of those above the significant height; first_touch if none [s]
  double impact_energy = 0;      ///< [J]
  double landing_excess = 0;     ///< [J]; 0 when it was not measured
  double peak_force = 0;         ///< [N]; NaN on a rigid contact
  double drive_energy = 0;       ///< [J]; NaN when it was not measured
  double steady_force_time = 0;  ///< Trajectory::steady_force_time, the end of the run where that is not known [s]
};
[[nodiscard]] CostFigures cost_figures(const Trajectory& trajectory, const MetricsOptions& options);

/// Gathers the figures while a closing runs, and keeps nothing of its course.
class CostObserver final : public ClosingObserver {
 public:
  /// `contact_gap` [m]
  CostObserver(double contact_gap, const MetricsOptions& options)
      : contact_gap_(contact_gap), significant_rebound_(options.significant_rebound), rebounds_(contact_gap) {
    figures_.closest = contact_gap;
  }
  void knot(const TrajectoryPoint& point) override;
  void touch(const Touch& touch) override;
  /// Of the run, once it has ended.
  [[nodiscard]] CostFigures figures(const Trajectory& end);

 private:
  void take(const Rebound& rebound, double until);

  double contact_gap_, significant_rebound_;  // [m]
  ReboundFinder rebounds_;
  CostFigures figures_;  // but for those of the rebounds
  double separated_ = 0, rebound_height_ = 0, last_rebound_end_ = std::numeric_limits<double>::quiet_NaN();
};

struct CostScale {
  CostFigures step;         ///< figures of the plain step
  double score_window = 0;  ///< [s]
  double contact_gap = 0;   ///< [m]
  double free_touch = 0;    ///< T_free, over first touch of the step
};
/// Infinite for a run that is not done.
[[nodiscard]] double cost(const Aim& aim, Status status, const CostFigures& figures, const CostScale& scale,
                          const MetricsOptions& options);
[[nodiscard]] inline double cost(const Aim& aim, const Trajectory& trajectory, const CostScale& scale,
                                 const MetricsOptions& options) {
  return cost(aim, trajectory.status, cost_figures(trajectory, options), scale, options);
}

}  // namespace softland
