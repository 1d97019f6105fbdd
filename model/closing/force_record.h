// The contact force of a closing after first contact: the time from which the force stays above a threshold, and its least
// value after its first maximum.
//
// Between knots (points of the simulated motion) the force is that of the contact law along the motion of the contact point.
// For a contact that acts along a pad, and for a plate at rest on a rigid contact, the force is taken as linear in time. Out of
// contact the force is 0, except for a law that acts before contact. Extremes of the force are found at knots and where the
// contact point turns back, which suffices for laws whose force grows with depth. For adhesive or damped laws, extremes between
// these times are searched as well.
#pragma once

#include <limits>
#include <span>

#include "model/closing/step_motion.h"
#include "model/contact/contact_law.h"
#include "model/trajectory.h"

namespace softland {

class ForceRecord {
 public:
  /// Records the force of one contact. Keeps a reference to `model`. The contact counts as settled while its force is at least
  /// `threshold` [N]; with NaN no settling time is computed.
  ForceRecord(const Switch& model, double threshold, std::size_t contact = 0);

  /// Adds a piece of an integration step after first contact, in which the contact stays on one branch of its law.
  void take(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to, const ContactState& law);
  /// Adds an interval after first contact over which the contact force is taken as linear in time, as along a pad.
  void take_line(const TrajectoryPoint& from, const TrajectoryPoint& to);

  /// Records that the contact force has passed its first maximum, so that the least force includes later forces: the contact
  /// has opened, or an impact on a rigid contact is over.
  void pass_maximum() { has_fallen_ = true; }

  /// Returns the outcome up to now, after a touch.
  [[nodiscard]] ForceOutcome outcome() const;

 private:
  /// Adds an interval between two turning points of the contact point to the record. `from` and `to` are the forces at its ends
  /// [N].
  template <class Force>
  void follow_path(const Force& force, double begin, double from, double end, double to);
  template <class Force>
  void follow(const Force& force, double begin, double from, double end, double to);

  const Switch& model_;
  std::size_t contact_;
  double threshold_;  // contact force from which the contact counts as settled [N]
  bool rises_with_depth_;
  bool has_risen_ = false, has_fallen_ = false;
  ForceOutcome outcome_{.least_force_after_touch = std::numeric_limits<double>::infinity()};
  double last_ = 0;
  double largest_ = 0;  // largest contact force so far [N]
};

/// Computes the outcome of the connection from those of the contacts, given in the order of Device::contacts.
[[nodiscard]] ForceOutcome force_of_connection(const Device& device, std::span<const ForceOutcome> contacts);

}  // namespace softland
