// The interface through which a simulated closing passes its motion on to an observer: knots (points of the motion) and touches
// (intervals in contact). Observers that request them also receive integration steps, electrical states and energies.
#pragma once

#include <cstddef>
#include <optional>

#include "model/closing/knot.h"
#include "model/contact/contact_law.h"
#include "model/trajectory.h"

namespace softland {

/// A change of the contact law's branch (phase) between two integration steps, with the states of the law before and after.
struct PhaseChange {
  enum class Kind {
    edge,    ///< the contact point crosses `level`, where the contact law changes
    turn,    ///< the contact point turns back while loading a contact with memory
    impact,  ///< the contact point strikes a rigid contact and rebounds
    rests,   ///< the contact point stays on a rigid contact after an impact
    leaves   ///< the contact point leaves the rigid contact on which it has rested
  };
  Kind kind = Kind::edge;
  double level = 0;  ///< position of the contact point at which the contact law changes [m]
  ContactState before, after;
};

class ClosingObserver {
 public:
  virtual ~ClosingObserver() = default;
  /// Receives the next point of the motion (knot), in order of time. The point is final: no event can change it afterwards.
  virtual void knot(const TrajectoryPoint&) {}
  /// Receives a touch (interval in contact) of the contact when the contact has opened. At the end of the run, a touch that has
  /// not ended is passed on with the end NaN.
  virtual void touch(const Touch&) {}
  /// Returns the observer for motion and touches of contact `number` of a switch with several contacts; null when they are not
  /// needed. The present observer itself receives motion and touches of the connection (electrical path) through the contacts.
  /// For a switch with one contact this function is not called.
  [[nodiscard]] virtual ClosingObserver* contact(std::size_t /*number*/) { return nullptr; }
  /// Returns true when the observer needs the times at which contacts close and open electrically
  /// (model/closing/electrical_record.h).
  [[nodiscard]] virtual bool follows_state() const { return false; }
  /// Receives the electrical closing or opening, at this time [s], of the contact of this number, or of the connection when no
  /// number is given. Every contact is open before its first call. Calls for one contact are in order of time and continue
  /// after the command to open (ClosingOptions::opens_at).
  virtual void state(std::optional<std::size_t> /*contact*/, bool /*is_closed*/, double /*time*/) {}
  /// Returns true when the observer needs the motion of all modes. The observer then receives every integration step and the
  /// changes of the contact law between steps, in order of time. With several contacts, step() has the state of the first
  /// contact law only, so that the forces of the other contacts cannot be computed from it.
  [[nodiscard]] virtual bool follows_motion() const { return false; }
  /// Receives an integration step from one point of the motion to the next, with the state of the contact law during the step.
  virtual void step(const Knot& /*begin*/, const Knot& /*end*/, const ContactState& /*contact*/) {}
  /// Returns true when the observer needs the energy balance at each breakpoint of the drives.
  [[nodiscard]] virtual bool takes_energies() const { return false; }
  /// Receives the time of a breakpoint of the drives [s], and the energy balance from the start of the run to this breakpoint.
  virtual void energies(double /*time*/, const EnergyBalance& /*balance*/) {}
  /// Receives a change of the contact law's branch (such as the beginning of contact), and the point of the motion from which
  /// the next step starts.
  virtual void on_phase(const Knot& /*here*/, const PhaseChange& /*change*/) {}

 protected:
  ClosingObserver() = default;
  ClosingObserver(const ClosingObserver&) = default;
  ClosingObserver& operator=(const ClosingObserver&) = default;
};

}  // namespace softland
