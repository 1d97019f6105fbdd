// The motion of one contact point during a run. The points (knots) of the current integration step are kept until no event
// (change of a contact law) can change them any more, and are then passed to the observer.
#pragma once

#include <algorithm>
#include <vector>

#include "model/closing/observer.h"
#include "model/device.h"
#include "model/gas/gas_law.h"

namespace softland {

class PendingKnots {
 public:
  /// Keeps references to `device` and `observer`; `contact` is the number of the contact.
  PendingKnots(const Device& device, std::size_t contact, ClosingObserver& observer)
      : device_(device),
        rest_gap_(device.gap.electrode + device.rest_offset(device.contact_position(contact))),
        observer_(observer) {}

  void push(const TrajectoryPoint& point) { waiting_.push_back(point); }
  /// Returns the last point of the contact point's motion, whether or not the observer has received it.
  [[nodiscard]] const TrajectoryPoint& last() const { return waiting_.empty() ? handed_over_ : waiting_.back(); }
  /// Returns the last point of the motion that the observer has not received. The caller may change it: at an event, it puts
  /// the contact point exactly on the position of the event.
  [[nodiscard]] TrajectoryPoint& last_waiting() { return waiting_.back(); }
  /// Removes the points of the motion that the observer has not received, from the time `from` [s] on; points at or before
  /// `step_begin` [s] remain.
  void take_back(double from, double step_begin) {
    while (!waiting_.empty() && waiting_.back().time >= from && waiting_.back().time > step_begin) waiting_.pop_back();
  }
  void hand_over() {
    for (const TrajectoryPoint& p : waiting_) {
      observer_.knot(p);
      largest_squeeze_ = std::max(largest_squeeze_, squeeze_number(device_, rest_gap_, p));
    }
    if (!waiting_.empty()) handed_over_ = waiting_.back();
    waiting_.clear();
  }
  /// Returns the largest squeeze number of the gas film at the contact point so far; 0 when the gas law has no limit of the
  /// squeeze number.
  [[nodiscard]] double largest_squeeze() const { return largest_squeeze_; }

 private:
  const Device& device_;
  double rest_gap_;  // gap to the electrode at the contact point at rest [m]
  ClosingObserver& observer_;
  std::vector<TrajectoryPoint> waiting_;
  TrajectoryPoint handed_over_;
  double largest_squeeze_ = 0;
};

}  // namespace softland
