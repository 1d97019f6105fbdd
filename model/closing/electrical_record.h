// The times at which the connection of a switch is electrically closed: while its contact force is above a bound, or its
// resistance below a bound, or both (Device::electrical); while in contact when neither bound is given.
//
// The force of the connection is the least force of its contacts, or with Connection::any the largest. Its resistance is that
// of the contacts in series, or in parallel (model/contact/resistance.h). The margin to the bounds, positive while the
// connection is closed, is a continuous function of the motion within a step. The changes of sign of the margin are located
// like contact events. The margin is evaluated after every piece of the step, where a contact turns back, and at an extremum in
// between that the slopes at both ends reveal. Along a pad the force is taken as linear between these times.
//
// An opening counts when it is longer than ElectricalClosing::after; a shorter opening is ignored.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "model/closing/observer.h"
#include "model/closing/step_motion.h"
#include "model/contact/contact_state.h"
#include "model/contact/resistance.h"
#include "model/switch.h"
#include "model/trajectory.h"

namespace softland {

/// A contact in an integration step: its motion, its position at the start of the step's last piece and at the end, the state
/// of its contact law, and whether the contact point is at or below the plane of first touch.
struct ContactInStep {
  StepMotion& motion;
  const TrajectoryPoint& from;
  const TrajectoryPoint& to;
  ContactState law;
  bool is_in_contact = false;
};

class ElectricalRecord {
 public:
  /// Keeps references to switch and observer. An observer whose follows_state() is true receives every electrical closing and
  /// opening.
  ElectricalRecord(const Switch& model, ClosingObserver& observer);

  /// Adds a step between two times [s] in which the state of every contact law stays the same.
  void take(double begin, double end, std::span<const ContactInStep> contacts);
  /// Adds an interval of time [s] in which the rigid plate rests on its rigid contact, under a force [N] that is a function of
  /// time.
  void take_rest(double begin, double end, const std::function<double(double)>& force);
  /// Ends the closing at this time [s]: electrical closings and openings after this time affect no outcome.
  void finish(double time);

  [[nodiscard]] const ElectricalOutcome& connection() const { return followed_.front().outcome; }
  /// Returns the times of electrical closing of contact c; for a single contact those of the connection.
  [[nodiscard]] const ElectricalOutcome& contact(std::size_t c) const {
    return followed_[followed_.size() > 1 ? c + 1 : 0].outcome;
  }

 private:
  struct Followed {
    bool is_closed = false;
    double opened_at = std::numeric_limits<double>::quiet_NaN();  // time of the last electrical opening [s]
    ElectricalOutcome outcome = {};
  };
  // Interference, force and conductance of a contact at one time.
  struct Instant {
    double interference = 0, force = 0;  // interference [m] and force [N] of the contact
    double conductance = 0;              // conductance of the contact [S]
  };

  [[nodiscard]] Instant instant(std::size_t c, const ContactInStep& contact, double time) const;
  [[nodiscard]] Instant connected(std::span<const Instant> contacts) const;
  [[nodiscard]] double margin(const Instant& instant) const;
  [[nodiscard]] bool is_of_touch() const { return !(closing_.force >= 0 || closing_.resistance > 0); }
  template <class Margin>
  void follow(Followed& followed, const Margin& at, double begin, double end) const;
  template <class Margin>
  void follow_path(Followed& followed, const Margin& at, double begin, double from, double end, double to) const;
  void set(Followed& followed, bool is_closed, double time) const;
  void tell(const Followed& followed, double time) const;
  [[nodiscard]] bool counts(const Followed& followed, double until) const;

  const Switch& model_;
  ClosingObserver& observer_;
  ElectricalClosing closing_;
  std::vector<ContactResistance> resistances_;
  std::vector<Followed> followed_;  // electrical states: the connection, then each contact if there are several
  bool is_finished_ = false;
};

}  // namespace softland
