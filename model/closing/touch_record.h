// The touches of one contact of a closing: begin, end and peak force of each touch.
#pragma once

#include <cstddef>
#include <vector>

#include "model/closing/contact_phase.h"
#include "model/closing/events.h"
#include "model/closing/observer.h"
#include "model/closing/step_motion.h"

namespace softland {

class TouchRecord {
 public:
  /// Keeps references to its arguments. Every touch is passed to the observer when the touch is over.
  TouchRecord(const Switch& model, std::size_t contact, const ContactPhase& phase, ClosingObserver& observer);

  [[nodiscard]] long count() const { return count_; }
  [[nodiscard]] double first_begin() const { return first_begin_; }      ///< begin of the first touch [s]; NaN without a touch
  [[nodiscard]] double deepest_penetration() const { return deepest_; }  ///< largest penetration of the contact so far [m]
  /// Returns the current touch of the contact, or the last one.
  [[nodiscard]] Touch& last() { return touch_; }

  /// Begins a touch at t = 0 with the switch at rest on its contact.
  void begin_closed() { begin(0, 0); }
  /// Adds a change of the contact law that the contact point has reached, before the new branch of the law acts; returns true
  /// when a touch begins.
  bool note(const Event& event, const TrajectoryPoint& at);
  void end(double time) { touch_.end = time; }
  /// Updates the peaks of the current touch by a piece of an integration step; does nothing outside of contact.
  void take(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to);
  /// Updates the peaks of the current touch by a whole step of a damped contact, whose largest force comes before the deepest
  /// point, or of a contact along a pad, whose largest force comes before or after the deepest point. Does nothing for other
  /// contacts.
  void take(const Knot& begin, const Knot& end, StepMotion& step);
  /// Passes a touch that has not ended by the end of the run to the observer.
  void finish();

 private:
  void begin(double time, double velocity);

  const Switch& model_;
  std::size_t contact_;
  const ContactPhase& phase_;
  ClosingObserver& observer_;
  // Position of the contact plane [m]; factor of the summits' pressure, see summit_pressure_scale().
  double plane_, pressure_scale_;
  Touch touch_;
  long count_ = 0;
  double first_begin_, deepest_ = 0;
};

}  // namespace softland
