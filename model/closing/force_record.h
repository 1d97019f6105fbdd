// The contact force of a closing after the first touch: from when on it stays above a threshold, and how low it falls again.
//
// Between knots the force is the contact law's along the motion of the contact point; along a pad, and of a plate at rest on a
// rigid contact, it is a straight line. Out of contact it is that of a law that acts beyond the plane, else 0. Its extremes are
// looked for at knots and where the contact point turns back, which is where a law has them that presses harder the deeper it
// is; under others, which pull or are damped, between these too.
#pragma once

#include <limits>

#include "model/closing/step_motion.h"
#include "model/contact/contact_law.h"
#include "model/trajectory.h"

namespace softland {

class ForceRecord {
 public:
  /// Of one of the contacts. Keeps a reference. `threshold` [N]; NaN: there is none.
  ForceRecord(const Switch& model, double threshold, std::size_t contact = 0);

  /// Takes a piece of a step after the first touch, under a contact law in this state.
  void take(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to, const ContactState& law);
  /// Takes a time after the first touch over which the force goes from one value to the other in a straight line.
  void take_line(const TrajectoryPoint& from, const TrajectoryPoint& to);

  /// What comes is after a maximum: the contact has opened, or an impact on a rigid one is over.
  void pass_maximum() { has_fallen_ = true; }

  /// Trajectory::steady_force_time [s]
  [[nodiscard]] double steady_from() const { return steady_from_; }
  /// Trajectory::least_force_after_touch [N]
  [[nodiscard]] double least() const;

 private:
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  /// A time over which the contact point goes one way.
  template <class Force>
  void follow_way(const Force& force, double begin, double from, double end, double to);
  template <class Force>
  void follow(const Force& force, double begin, double from, double end, double to);

  const Switch& model_;
  std::size_t contact_;
  double threshold_;  // [N]
  bool rises_with_depth_;
  bool has_risen_ = false, has_fallen_ = false;
  double steady_from_ = none, least_ = std::numeric_limits<double>::infinity(), last_ = 0;
  double largest_ = 0;  // [N]
};

}  // namespace softland
