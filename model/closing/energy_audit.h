// The energy balance of a closing: work of the sources, stored energy and dissipation. An integrator that loses the contact
// between two steps, or a tolerance too loose for a stiff contact, shows as a residual of the balance.
//
//   work of the sources = integral of V dQ = [V Q] - integral of Q dV     dissipated = integral of the power taken out
//
// Q = C (V - V0) is the charge of an electrode, V0 the voltage of a charge on its dielectric; its field stores C (V - V0)^2/2 +
// V0 Q.
//
// [V Q] is taken over each interval between breakpoints of the drives, the integral of Q dV by Simpson's rule where a voltage
// changes. A change of a force factor moves no charge: its work is the integral alone. Dissipation is integrated by Simpson's
// rule over each step. Once the residual exceeds 1e-4 of the bending energy, Lobatto's rule with four points integrates it over
// a motion that is exact for the modes.
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

  /// Changes all drives to the signal pieces that are valid after the state `here`. A jump of the voltage charges the electrode
  /// at fixed deflection, as an infinitely steep ramp does.
  void enter_stretch(const Knot& here, bool first);
  /// Adds an integration step between two states to the energy balance.
  void step(const Knot& here, const Knot& next, double dissipation_at_end, StepMotion& motion, bool implicit);
  /// Adds an interval in which the rigid plate rests on its contact while the drives change.
  void rest(const Knot& here, double until);
  /// Adds an impact on a rigid contact: `lost` is the energy lost [J], `dissipation` the dissipated power just after the impact
  /// [W].
  void impact(double lost, double dissipation);

  /// Computes the residual of the energy balance at a state of the switch.
  void settle(const Knot& here);
  [[nodiscard]] const EnergyBalance& balance() const { return balance_; }
  /// Returns the largest residual that settle() has found [J]; NaN if any residual was NaN.
  [[nodiscard]] double error() const { return error_; }
  /// Returns kinetic plus potential energy of the switch at a state, plus the energy that impacts on a rigid contact have
  /// dissipated [J].
  [[nodiscard]] double above_rest(const Knot& here);

 private:
  [[nodiscard]] bool holds_charge(std::size_t k) const { return model_.drive_kind(k) != DriveKind::dispersion; }
  [[nodiscard]] double charge(std::size_t k, double value, const double* q) {
    return model_.charge(k, value, q, equations_.workspace());
  }
  [[nodiscard]] double contact_dissipation(const double* state) const;
  /// Returns the energy stored in the contacts that act [J].
  [[nodiscard]] double stored_in_contacts(const double* q) const;
  /// Returns the energy lost to residual deformation of the contacts (dents) so far [J].
  [[nodiscard]] double lost_in_contacts(const double* q) const;
  void add_charges(const Knot& here, double sign);
  [[nodiscard]] double mean_dissipation(double at_end, StepMotion& motion, bool implicit);

  const Switch& model_;
  DriveCourse& drives_;
  ContactPhases& phases_;
  ClosingEquations& equations_;
  std::size_t modes_;
  double rest_energy_;      // energy of the switch at the start of the run [J]
  double source_work_ = 0;  // work of the sources, without V Q of the charges now on the electrodes [J]
  double dissipated_ = 0;   // energy that gas, film, modal damping and contacts have dissipated [J]
  double dissipation_ = 0;  // dissipated power at the last state [W]
  double impacts_ = 0;      // energy lost in impacts on a rigid contact [J]
  bool careful_ = false;    // true when dissipated_ is integrated with more points
  double error_ = 0;
  EnergyBalance balance_;
};

}  // namespace softland
