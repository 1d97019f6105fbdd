// The touches (intervals in contact) of one contact in a closing: begin, end and peak force of each touch.
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
  /// Keeps references to its arguments. Every touch (interval in contact) is passed to the observer when the next one begins,
  /// or at the end of the run.
  TouchRecord(const Switch& model, std::size_t contact, const ContactPhase& phase, ClosingObserver& observer);

  [[nodiscard]] long count() const { return count_; }
  [[nodiscard]] double first_begin() const { return first_begin_; }      ///< time of first contact [s]; NaN without contact
  [[nodiscard]] double deepest_penetration() const { return deepest_; }  ///< largest penetration of the contact so far [m]
  /// Returns the current touch (interval in contact), or the last one when the contact is open.
  [[nodiscard]] Touch& last() { return touch_; }

  /// Begins a touch (interval in contact) at t = 0 with the switch at rest on its contact.
  void begin_closed() { begin(0, 0); }
  /// Begins or ends a touch at a change of the contact law, where `at` is the contact point; call it before the new branch of
  /// the law acts. Returns true when a touch begins.
  bool note(const Event& event, const TrajectoryPoint& at);
  void end(double time) { touch_.end = time; }
  /// Updates the peaks (force, energy, pressure) of the current touch by a piece of an integration step; does nothing out of
  /// contact.
  void take(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to);
  /// Updates the peaks of the current touch by a whole step of a contact whose largest force is not at its deepest point: a
  /// damped contact, or a contact that acts along a pad. Does nothing for other contacts.
  void take(const Knot& begin, const Knot& end, StepMotion& step);
  /// Passes the last touch to the observer at the end of the run, whether or not it has ended.
  void finish();

 private:
  void begin(double time, double velocity);

  const Switch& model_;
  std::size_t contact_;
  const ContactPhase& phase_;
  ClosingObserver& observer_;
  // Position of the contact plane [m]; factor between the root of the interference d and the pressure of the highest summit
  // over the hardness, p / H = factor sqrt(d) [1/m^0.5] (summit_pressure_scale()).
  double plane_, pressure_scale_;
  Touch touch_;
  long count_ = 0;
  double first_begin_, deepest_ = 0;
};

}  // namespace softland
