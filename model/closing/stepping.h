// Integration of a closing step by step; each step ends at the next change of a contact law at the latest.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "integrators/stepper.h"
#include "model/closing.h"
#include "model/closing/connection.h"
#include "model/closing/electrical_record.h"
#include "model/closing/energy_audit.h"
#include "model/closing/equations.h"
#include "model/closing/events.h"
#include "model/closing/force_record.h"
#include "model/closing/pending_knots.h"
#include "model/closing/resting_plate.h"
#include "model/closing/step_motion.h"
#include "model/closing/tolerances.h"
#include "model/closing/touch_record.h"

namespace softland {

[[nodiscard]] inline bool begins_closed(const ClosingOptions& options) {
  return !options.begins_closed.empty() || options.start == StartState::closed;
}
/// Returns the equilibrium in which a run starts, under the drives' voltages before t = 0: an open equilibrium unless the
/// options request a closed one. Returns none when this equilibrium does not exist.
[[nodiscard]] std::optional<Eigen::VectorXd> start_of(const Switch& model, std::span<const Signal> signals,
                                                      const ClosingOptions& options);

/// One contact of a closing: its number and phase, and the records of its touches, force and motion. A switch without contact
/// has one FollowedContact, for its contact point.
struct FollowedContact {
  FollowedContact(const Switch& model, std::size_t contact, ContactPhase& contact_phase, const ClosingOptions& options,
                  ClosingObserver& observer)
      : number(contact),
        plane(model.contact_gap(contact)),
        phase(contact_phase),
        touches(model, contact, contact_phase, observer),
        force(model, options.steady_force, contact),
        pending_knots(model.device(), contact, observer),
        motion(model, options.tolerance, contact) {}

  std::size_t number;
  double plane;  ///< position of the contact plane [m]
  ContactPhase& phase;
  TouchRecord touches;
  ForceRecord force;
  PendingKnots pending_knots;
  StepMotion motion;    ///< motion of the contact point in the current step
  TrajectoryPoint end;  ///< contact point at the end of the current step
};

/// The objects that simulate a closing together; they keep references to each other.
struct ClosingParts {
  const Switch& model;
  const ClosingOptions& options;
  std::optional<Eigen::VectorXd> rest;  ///< equilibrium in which the run starts; none when it does not exist
  DriveCourse drives;
  ContactPhases phases;
  ClosingEquations equations;
  RestingPlate plate;
  std::optional<ConnectionCourse> connection;  ///< electrical connection that several contacts make
  std::vector<FollowedContact> contacts;       ///< records of the contacts; without contacts, one record of the contact point
  /// Record of electrical closing, if the device or the observer requires this record.
  std::optional<ElectricalRecord> electrical;
  ClosingObserver& observer;
  bool closing_is_over = false;  ///< true after the command to open, ClosingOptions::opens_at

  ClosingParts(const Switch& switch_model, std::span<const Signal> signals, const ClosingOptions& closing_options,
               ClosingObserver& closing_observer)
      : model(switch_model),
        options(closing_options),
        rest(start_of(switch_model, signals, closing_options)),
        drives(signals),
        phases(model),
        equations(model, drives, phases, options.restart_at_contact),
        plate(model, drives, equations),
        observer(closing_observer) {
    if (model.contacts() > 1) connection.emplace(model, observer);
    if (model.has_contact() && (model.device().electrical.is_asked() || observer.follows_state()))
      electrical.emplace(model, observer);
    contacts.reserve(phases.size());
    for (std::size_t c = 0; c < phases.size(); ++c)
      contacts.emplace_back(model, c, phases[c], options, connection ? connection->contact(c) : observer);
    if (!rest || !(begins_closed(options) || model.contacts() > 1)) return;
    for (FollowedContact& c : contacts) {
      const double interference = model.contact_deflection(rest->data(), c.number) - c.plane;
      if (!begins_closed(options) && !(interference > 0)) continue;
      c.phase.begin_closed(interference);
      if (c.phase.in_contact()) c.touches.begin_closed();
    }
  }
  ClosingParts(const ClosingParts&) = delete;
  ClosingParts& operator=(const ClosingParts&) = delete;

  [[nodiscard]] FollowedContact& first() { return contacts.front(); }
  /// Returns true when the electrical state (closed or open) of the contacts is computed. After the command to open
  /// (ClosingOptions::opens_at) it is computed only for an observer that needs it.
  [[nodiscard]] bool follows_state() const { return electrical && (!closing_is_over || observer.follows_state()); }
  /// Ends the closing at this time [s]: the remaining part of the run is an opening.
  void end_closing(double time) {
    if (electrical && !closing_is_over) electrical->finish(time);
    closing_is_over = true;
  }
  /// Records the contact force, and updates the peaks of the current touch, over a piece of an integration step.
  void record(FollowedContact& contact, const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to);
  /// Returns position, velocity, acceleration and force of a contact in a state of the switch.
  [[nodiscard]] TrajectoryPoint point(const FollowedContact& contact, const Knot& knot) const;
  /// Adds a point to the motion of every contact, for a state of the switch.
  void push(const Knot& knot) {
    for (FollowedContact& c : contacts) c.pending_knots.push(point(c, knot));
  }
  /// Passes the points of the motion that no event can change any more to the observers.
  void hand_over() {
    for (FollowedContact& c : contacts) c.pending_knots.hand_over();
    if (connection) connection->hand_over();
  }
  /// Returns the time of first contact of any contact on the near side [s]; NaN before first contact.
  [[nodiscard]] double first_touch() const;
  [[nodiscard]] bool has_touched() const { return !std::isnan(first_touch()); }
};

class Stepping {
 public:
  /// Starts with the switch at rest, open or on the contact. Keeps a reference to `parts`.
  explicit Stepping(ClosingParts& parts);

  [[nodiscard]] Knot& here() { return here_; }
  [[nodiscard]] const Work& work() const { return work_; }
  /// Counts an interval in which a plate rests on its contact as an integration step, towards the limit of the number of steps.
  void count_step() { ++work_.steps; }
  /// Returns the reason why the last call of an integration function failed.
  [[nodiscard]] const std::string& message() const { return message_; }

  /// Restarts the integrator from here(), with each contact law in its current branch. Returns false when this failed.
  bool restart();
  /// Checks that the number of steps is within its limit. From time to time the function also checks whether the integration
  /// method suits the equations, and changes to the other method if not. Returns false when the number of steps exceeds its
  /// limit or the change failed.
  bool check_work();

  struct Step {
    FieldFigures field;  ///< figures of the gap field at the end of the step
    std::optional<Event> event;
  };
  /// Integrates from here() to the end of a step: to `stop` or the next change of a contact law that needs a restart, at the
  /// latest. Peaks and energies of the step are recorded; the points of its motion remain in PendingKnots. Returns none when
  /// the step failed.
  std::optional<Step> advance(double stop, EnergyAudit& audit);

 private:
  [[nodiscard]] const std::vector<double>& tolerances() const;
  [[nodiscard]] bool implicit() const { return is_implicit(work_.integrator); }
  bool fail(const std::string& why);
  void take_state();
  void consider_step();
  bool follow(std::optional<Event>& event);
  bool follow(FollowedContact& contact, double until, std::optional<Event>& event);
  [[nodiscard]] double first_event_time();
  bool go_through(FollowedContact& contact, const Event& event, const TipMotion& tip);
  bool step_again(const Event& event);
  bool meet(const Event& event);
  [[nodiscard]] TrajectoryPoint knot(FollowedContact& contact, int k);
  [[nodiscard]] static double force_on_line(const FollowedContact& contact, double time);
  void account(const FieldFigures& field, EnergyAudit& audit);

  ClosingParts& parts_;
  std::size_t n_;   // number of modes
  double fastest_;  // angular frequency of the fastest mode [rad/s]
  Tolerances tolerances_;
  Knot here_, next_;  // states at the start and the end of the current step
  Work work_;
  std::unique_ptr<Stepper> stepper_;
  double last_step_ = 0;  // length of the last step that did not end early at a breakpoint or an event [s]
  long next_look_ = 0;    // number of the step at which check_work() next checks the integration method
  int stiff_looks_ = 0;
  std::string message_;
};

}  // namespace softland
