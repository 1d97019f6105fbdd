// The times at which the connection of a switch is electrically closed: while its contact force is above a bound, or its
// resistance below a bound, or both (Device::electrical); while in contact when neither bound is given.
//
// The force of the connection is the least force of its contacts, or with Connection::any the largest. Its resistance is that
// of the contacts in series, or in parallel (model/contact/resistance.h). The margin is the distance of force and resistance
// from their bounds, positive while the connection is electrically closed, and continuous within a step. Its changes of sign
// are found by bracketing. The margin is evaluated at the ends of the quintic pieces of which an integration step consists, and
// where a contact point turns back. Between two of these times it is also evaluated at an extremum, if its slopes at both
// indicate one. The force of a contact that acts along a pad is taken as linear between these times.
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

/// One contact in an integration step. `motion` is its motion in the whole step; `from` and `to` are its points at the start of
/// the step's last quintic piece and at the end of the step. `is_in_contact` is true when the contact point is at or below the
/// contact plane.
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

  /// Adds an integration step between two times [s]. In the step every contact stays on one branch of its law, except where the
  /// integrator does not restart at contact.
  void take(double begin, double end, std::span<const ContactInStep> contacts);
  /// Adds an interval of time [s] in which the rigid plate rests on its rigid contact, under a force [N] that is a function of
  /// time.
  void take_rest(double begin, double end, const std::function<double(double)>& force);
  /// Ends the recording of the closing at this time [s]. Later electrical closings and openings do not change connection() and
  /// contact(), but the observer still receives them.
  void finish(double time);

  [[nodiscard]] const ElectricalOutcome& connection() const { return followed_.front().outcome; }
  /// Returns the electrical times of contact c: first closing, final closing, number of openings. For a single contact they are
  /// those of the connection.
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
