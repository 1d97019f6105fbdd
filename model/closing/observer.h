// The interface through which a closing passes on its motion: its knots and touches, and more at an observer's request.
#pragma once

#include <cstddef>
#include <optional>

#include "model/closing/knot.h"
#include "model/contact/contact_law.h"
#include "model/trajectory.h"

namespace softland {

/// Event of the contact point between two steps.
struct PhaseChange {
  enum class Kind {
    edge,    ///< the contact point crosses `level`
    turn,    ///< the contact point turns back while loading a contact with memory
    impact,  ///< the contact point strikes a rigid contact and rebounds
    rests,   ///< the contact point stays on a rigid contact after an impact
    leaves   ///< the contact point leaves the rigid contact on which it has rested
  };
  Kind kind = Kind::edge;
  double level = 0;  ///< level of the edge [m]
  ContactState before, after;
};

class ClosingObserver {
 public:
  virtual ~ClosingObserver() = default;
  /// Receives the next knot, in order of time. A knot is final: no event can change it afterwards.
  virtual void knot(const TrajectoryPoint&) {}
  /// Receives a touch that is over, or, at the end of the run, a touch that has not ended, whose end is NaN.
  virtual void touch(const Touch&) {}
  /// Returns the observer that receives knots and touches of one contact of several; null for none. This observer itself
  /// receives those of the connection that the contacts make. Not called for a switch with one contact.
  [[nodiscard]] virtual ClosingObserver* contact(std::size_t /*number*/) { return nullptr; }
  /// Returns true when the observer needs to know when the switch is electrically closed (model/closing/electrical_record.h).
  [[nodiscard]] virtual bool follows_state() const { return false; }
  /// Receives a change of the electrical state to closed or open at this time [s]: of the contact of this number, or of the
  /// connection when none is given. Every state is open before its first call. Calls for one state are in order of time and
  /// continue after ClosingOptions::opens_at.
  virtual void state(std::optional<std::size_t> /*contact*/, bool /*is_closed*/, double /*time*/) {}
  /// Returns true when the observer needs the motion of all modes. The observer then receives every step and the events between
  /// steps, in order of time. step() then has the state of the first contact only, which does not describe all forces of
  /// several contacts.
  [[nodiscard]] virtual bool follows_motion() const { return false; }
  /// Receives a step of the integrator, with the state of the contact law during the step.
  virtual void step(const Knot& /*begin*/, const Knot& /*end*/, const ContactState& /*contact*/) {}
  /// Returns true when the observer needs the energies at each breakpoint of the drives.
  [[nodiscard]] virtual bool takes_energies() const { return false; }
  /// Receives the time of a breakpoint of the drives [s], and the energy balance of the run just before this breakpoint.
  virtual void energies(double /*time*/, const EnergyBalance& /*balance*/) {}
  /// Receives an event of the contact point, and the knot from which the next step starts.
  virtual void on_phase(const Knot& /*here*/, const PhaseChange& /*change*/) {}

 protected:
  ClosingObserver() = default;
  ClosingObserver(const ClosingObserver&) = default;
  ClosingObserver& operator=(const ClosingObserver&) = default;
};

}  // namespace softland
