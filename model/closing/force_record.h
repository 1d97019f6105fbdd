// The contact force of a closing after the first touch: the time from which it stays above a threshold, and its least value
// afterwards.
//
// Between knots (points of the simulated motion) the force is that of the contact law along the motion of the contact point.
// Along a pad, and for a plate at rest on a rigid contact, the force is taken as linear in time. Out of contact the force is 0,
// except for a law that acts beyond the plane. Extremes are located at knots and where the contact point turns back, which
// suffices for laws whose force grows with depth. For laws that pull or are damped, extremes are located between these times
// too.
#pragma once

#include <limits>

#include "model/closing/step_motion.h"
#include "model/contact/contact_law.h"
#include "model/trajectory.h"

namespace softland {

class ForceRecord {
 public:
  /// Records the force of one contact. Keeps a reference to `model`. `threshold` is the force that counts as steady [N], or
  /// NaN.
  ForceRecord(const Switch& model, double threshold, std::size_t contact = 0);

  /// Adds a piece of an integration step after the first touch, in which the contact law stays in this state.
  void take(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to, const ContactState& law);
  /// Adds an interval after the first touch over which the contact force changes linearly.
  void take_line(const TrajectoryPoint& from, const TrajectoryPoint& to);

  /// Records that a maximum of the contact force has passed: the contact has opened, or an impact on a rigid contact is over.
  void pass_maximum() { has_fallen_ = true; }

  /// Returns the time from which the contact force is steady, Trajectory::steady_force_time [s].
  [[nodiscard]] double steady_from() const { return steady_from_; }
  /// Returns the least contact force after the first touch, Trajectory::least_force_after_touch [N].
  [[nodiscard]] double least() const;

 private:
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  /// Adds an interval in which the contact point moves in one direction.
  template <class Force>
  void follow_path(const Force& force, double begin, double from, double end, double to);
  template <class Force>
  void follow(const Force& force, double begin, double from, double end, double to);

  const Switch& model_;
  std::size_t contact_;
  double threshold_;  // contact force that counts as steady [N]
  bool rises_with_depth_;
  bool has_risen_ = false, has_fallen_ = false;
  double steady_from_ = none, least_ = std::numeric_limits<double>::infinity(), last_ = 0;
  double largest_ = 0;  // largest contact force so far [N]
};

}  // namespace softland
