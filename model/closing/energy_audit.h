// The energy balance of a closing: work of the sources, stored energy and dissipation. An integrator that loses the contact
// between two steps, or a tolerance too loose for a stiff contact, shows as a residual of the balance.
//
//   work of the sources = integral of V dQ = [V Q] - integral of Q dV     dissipated = integral of the dissipated power
//
// Q = C (V - V0) is the charge of an electrode at the voltage V, C its capacitance, V0 the voltage of a fixed charge on its
// dielectric. The field of the electrode stores C (V - V0)^2/2 + V0 Q.
//
// [V Q] is the difference of V Q between the ends of each interval between breakpoints of the drives. The integral of Q dV is
// computed by Simpson's rule over steps in which the voltage changes. A drive that changes the dispersion force of the switch,
// instead of an electrode's voltage, has no charge: its work has no term [V Q]. Dissipation is integrated by Simpson's rule
// over each step. When the residual has exceeded 1e-4 of the energy that bends the beam by the contact gap, Lobatto's rule with
// four points replaces Simpson's rule, with the exact motion of the modes between the points.
#pragma once

#include "model/closing/contact_phase.h"
#include "model/closing/drive_course.h"
#include "model/closing/equations.h"
#include "model/closing/step_motion.h"
#include "model/trajectory.h"

namespace softland {

class EnergyAudit {
 public:
  /// Keeps references to its arguments. At the state `start` the switch is at rest, open under its drives' voltages before t =
  /// 0 or closed on its contact, and the electrodes carry the charge of this state.
  EnergyAudit(const Switch& model, DriveCourse& drives, ContactPhases& phases, ClosingEquations& equations, const Knot& start);

  /// Moves all drives to the signal pieces that are valid after the time of `here`; `first` is true at the start of the run,
  /// where the voltages may jump from those before t = 0. The work of a voltage jump is that of charging an electrode at fixed
  /// deflection, like an infinitely steep ramp.
  void enter_stretch(const Knot& here, bool first);
  /// Adds an integration step between two states to the energy balance. `dissipation_at_end` is the power that gas, film and
  /// modal damping dissipate at `next` [W]; `implicit` is true for a step of an implicit method.
  void step(const Knot& here, const Knot& next, double dissipation_at_end, StepMotion& motion, bool implicit);
  /// Adds to the energy balance an interval up to the time `until` [s], in which the rigid plate rests on its contact: only
  /// changes of the drives do work.
  void rest(const Knot& here, double until);
  /// Adds an impact on a rigid contact: `lost` is the energy lost [J], `dissipation` the dissipated power just after the impact
  /// [W].
  void impact(double lost, double dissipation);

  /// Computes the residual of the energy balance (work of the sources less stored and dissipated energy) at a state of the
  /// switch.
  void settle(const Knot& here);
  [[nodiscard]] const EnergyBalance& balance() const { return balance_; }
  /// Returns the largest residual that settle() has found [J]; NaN if any residual was NaN.
  [[nodiscard]] double error() const { return error_; }
  /// Returns kinetic plus potential energy of the switch at a state, plus the energy that impacts on a rigid contact have
  /// dissipated [J]. The excess of this energy over that of the closed equilibrium is Trajectory::landing_excess.
  [[nodiscard]] double above_rest(const Knot& here);

 private:
  [[nodiscard]] bool holds_charge(std::size_t k) const { return model_.drive_kind(k) != DriveKind::dispersion; }
  [[nodiscard]] double charge(std::size_t k, double value, const double* q) {
    return model_.charge(k, value, q, equations_.workspace());
  }
  [[nodiscard]] double contact_dissipation(const double* state) const;
  /// Returns the energy stored in the contacts on which a contact law acts now [J].
  [[nodiscard]] double stored_in_contacts(const double* q) const;
  /// Returns the energy that residual deformation of the contacts (dents) has dissipated so far [J].
  [[nodiscard]] double lost_in_contacts(const double* q) const;
  void add_charges(const Knot& here, double sign);
  [[nodiscard]] double mean_dissipation(double at_end, StepMotion& motion, bool implicit);

  const Switch& model_;
  DriveCourse& drives_;
  ContactPhases& phases_;
  ClosingEquations& equations_;
  std::size_t modes_;
  double rest_energy_;      // energy of the switch at the start of the run [J]
  double source_work_ = 0;  // work of the sources, less the term V Q for the electrodes' charges now [J]
  double dissipated_ = 0;   // energy that gas, film, modal damping and contacts have dissipated [J]
  double dissipation_ = 0;  // dissipated power at the end of the last step [W]
  double impacts_ = 0;      // energy lost in impacts on a rigid contact [J]
  bool careful_ = false;    // true when Lobatto's rule with four points integrates the dissipation
  double error_ = 0;
  EnergyBalance balance_;
};

}  // namespace softland
