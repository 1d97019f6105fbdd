// Finds the rebounds of a closing during the run, without storing past points of the motion.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "integrators/quintic.h"
#include "integrators/roots.h"
#include "model/trajectory.h"

namespace softland {

/// A time interval after first contact in which the contact point is above the first-touch plane.
struct Rebound {
  double begin = 0;  ///< start of the rebound: the contact opens [s]
  double end = 0;    ///< end of the rebound: the contact closes [s]; NaN when the rebound has not ended at the end of the run
  /// Largest distance to the contact plane in the rebound [m]; a lower bound when the rebound has not ended.
  double height = 0;
  double time_of_height = 0;  ///< time at which the height of the rebound occurs [s]
};

/// Finds rebounds in the separation of the contact point from the first-touch plane. Turning points and crossings of the plane
/// between two knots (points of the simulated motion) are those of the quintic through the knots. A separation below 1e-12 of
/// the contact gap does not count: the integrator stops at the plane only to within rounding.
class ReboundFinder {
 public:
  /// Takes the distance `contact_gap` from rest to the contact plane [m].
  explicit ReboundFinder(double contact_gap) : gap_(contact_gap), usable_(std::isfinite(contact_gap)) {}

  /// Adds the next point of the motion and calls found(rebound) for every rebound that ends before this point. Ignores a point
  /// that is not finite or goes back in time, and all later points, and returns false for them.
  template <class Found>
  bool knot(const TrajectoryPoint& next, Found&& found) {
    usable_ = usable_ && std::isfinite(next.time) && std::isfinite(next.position) && std::isfinite(next.velocity) &&
              std::isfinite(next.acceleration) && !(began_ && next.time < last_.time);
    if (!usable_) return false;
    if (began_ && next.time > last_.time) {
      follow(last_, next, found);
    } else {
      reach(node(next), found);
    }
    began_ = true;
    last_ = next;
    return true;
  }

  /// Returns true when every point of the motion so far was finite and in order of time.
  [[nodiscard]] bool usable() const { return usable_; }
  [[nodiscard]] const FirstTouch& first_touch() const { return first_touch_; }
  [[nodiscard]] double last_time() const { return last_.time; }  ///< time of the last motion point that was not ignored [s]
  /// Returns the rebound that has not ended yet, if any.
  [[nodiscard]] const std::optional<Rebound>& under_way() const { return under_way_; }

 private:
  /// A point of the contact point's motion; until the next Node the separation from the contact plane is monotone and does not
  /// change its sign.
  struct Node {
    double time = 0;        ///< time of this point of the motion [s]
    double separation = 0;  ///< separation of the contact point from the first-touch plane [m]
    double velocity = 0;    ///< velocity of the contact point [m/s]
  };

  [[nodiscard]] double snapped(double separation) const {
    constexpr double on_the_plane = 1e-12;  // separation that counts as contact, as a share of the contact gap
    return std::abs(separation) <= on_the_plane * std::abs(gap_) ? 0.0 : separation;
  }
  [[nodiscard]] Node node(const TrajectoryPoint& p) const { return {p.time, snapped(gap_ - p.position), p.velocity}; }

  template <class Found>
  void follow(const TrajectoryPoint& a, const TrajectoryPoint& b, Found&& found) {
    const Quintic curve(a.time, a.position, a.velocity, a.acceleration, b.time, b.position, b.velocity, b.acceleration);
    const auto separation = [&](double t) { return gap_ - curve.position(t); };
    const auto advance = [&](const Node& next) {
      const Node& before = node_;
      if ((before.separation < 0 && next.separation > 0) || (before.separation > 0 && next.separation < 0)) {
        const double crossing = bracketed_zero(separation, before.time, next.time);
        reach({crossing, 0, curve.velocity(crossing)}, found);
      }
      reach(next, found);
    };
    if (!surely_monotone(a, b)) {
      for (const double t : curve.turns()) advance({t, snapped(separation(t)), curve.velocity(t)});
    }
    advance(node(b));
  }

  template <class Found>
  void reach(const Node& next, Found&& found) {
    const bool touched = first_touch_.happened();
    if (!touched && next.separation <= 0) {
      first_touch_ = {.time = next.time, .velocity = std::abs(next.velocity)};
    } else if (touched && next.separation > 0) {
      if (!under_way_) under_way_ = Rebound{.begin = node_.time, .end = std::numeric_limits<double>::quiet_NaN()};
      if (next.separation > under_way_->height) {
        under_way_->height = next.separation;
        under_way_->time_of_height = next.time;
      }
    } else if (under_way_) {
      under_way_->end = next.time;
      found(*under_way_);
      under_way_.reset();
    }
    node_ = next;
  }

  /// Returns true when the control points of the quintic's Bernstein form are in order. This is a cheap sufficient condition
  /// for a velocity that does not change its sign between two points of the motion.
  [[nodiscard]] static bool surely_monotone(const TrajectoryPoint& a, const TrajectoryPoint& b) {
    const double h = b.time - a.time;
    const double from_a = a.velocity * h / 5;
    const double from_b = b.velocity * h / 5;
    const double bend_a = a.acceleration * h * h / 20;
    const double bend_b = b.acceleration * h * h / 20;
    const std::array<double, 5> differences{
        from_a, from_a + bend_a, (b.position - a.position) - 2 * (from_a + from_b) + bend_b - bend_a, from_b - bend_b, from_b};
    return std::all_of(differences.begin(), differences.end(), [](double d) { return d >= 0; }) ||
           std::all_of(differences.begin(), differences.end(), [](double d) { return d <= 0; });
  }

  double gap_;  // distance from rest to the contact plane [m]
  bool usable_, began_ = false;
  TrajectoryPoint last_;
  Node node_;
  FirstTouch first_touch_;
  std::optional<Rebound> under_way_;
};

}  // namespace softland
