// Who receives the course of a closing: all of it, or only what figures are made of.
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
    edge,    ///< it crosses `level`
    turn,    ///< it turns back while it loads a contact with memory
    impact,  ///< it strikes a rigid contact and rebounds
    rests,   ///< an impact after which it stays
    leaves   ///< the rigid contact that it has rested on
  };
  Kind kind = Kind::edge;
  double level = 0;  ///< level of the edge [m]
  ContactState before, after;
};

class ClosingObserver {
 public:
  virtual ~ClosingObserver() = default;
  /// The next knot, in order of time. Knots are handed over step by step, once nothing changes them any more.
  virtual void knot(const TrajectoryPoint&) {}
  /// A touch that is over, or at the end of the run the one that holds, whose end is NaN.
  virtual void touch(const Touch&) {}
  /// Who receives knots and touches of one contact of several, while this observer receives those of the connection that they
  /// make; null: nobody does. A switch with one contact does not ask.
  [[nodiscard]] virtual ClosingObserver* contact(std::size_t /*number*/) { return nullptr; }
  /// Returns whether the observer asks when the switch is electrically closed (model/closing/electrical_record.h).
  [[nodiscard]] virtual bool follows_state() const { return false; }
  /// From this time [s] on the connection, or of several contacts the one of this number, is closed or open. It is open until
  /// the first call. The calls of each are in order of time, and go on after ClosingOptions::opens_at.
  virtual void state(std::optional<std::size_t> /*contact*/, bool /*is_closed*/, double /*time*/) {}
  /// Whether the observer follows the motion of all modes; then it is told every step and what happens between steps, in order
  /// of time. Of several contacts it is told the state of the first, which does not say all that acts.
  [[nodiscard]] virtual bool follows_motion() const { return false; }
  /// A step under a contact law in this state.
  virtual void step(const Knot& /*begin*/, const Knot& /*end*/, const ContactState& /*contact*/) {}
  /// Tells whether the observer wants the energies where a stretch of the drives ends.
  [[nodiscard]] virtual bool takes_energies() const { return false; }
  /// Of the run so far, at a breakpoint of the drives before what they do there [s].
  virtual void energies(double /*time*/, const EnergyBalance& /*balance*/) {}
  /// Takes an event at the knot that the next step starts from.
  virtual void pass(const Knot& /*here*/, const PhaseChange& /*change*/) {}

 protected:
  ClosingObserver() = default;
  ClosingObserver(const ClosingObserver&) = default;
  ClosingObserver& operator=(const ClosingObserver&) = default;
};

}  // namespace softland
