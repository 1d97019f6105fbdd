// The equations of motion of the switch under its drives, as the right-hand side for an integrator. Each contact law is
// evaluated on the branch of its current phase (contact_phase.h).
#pragma once

#include "integrators/stepper.h"
#include "model/closing/contact_phase.h"
#include "model/closing/drive_course.h"
#include "model/closing/knot.h"
#include "model/switch.h"

namespace softland {

class ClosingEquations {
 public:
  /// Keeps references to its arguments. When `phase_decides` is true, the branch of a contact law is that of its current phase,
  /// and the integrator must be restarted where the phase changes. Otherwise the position of the contact point selects the
  /// branch.
  ClosingEquations(const Switch& model, DriveCourse& drives, ContactPhases& phases, bool phase_decides);
  ClosingEquations(const ClosingEquations&) = delete;
  ClosingEquations& operator=(const ClosingEquations&) = delete;

  [[nodiscard]] const OdeSystem& system() const { return system_; }
  /// Computes the time derivatives of velocities and film pressures in a state at time t, with every contact law on the branch
  /// of its current phase. The derivatives of the modal coordinates are the velocities and are not part of the result.
  void rates(double t, const double* state, double* result) { rates(t, state, phases_.states(), result); }
  void rates(Knot& knot) { rates(knot.time, knot.state.data(), knot.rates.data()); }
  /// Returns smallest gap, dissipated power, and whether the beam has reached an electrode or wall on the far side, all from
  /// the last evaluation of rates(). That evaluation must have been one of this `state`, up to rounding.
  [[nodiscard]] FieldFigures field(const double* state);
  /// Returns the power that gas, film and modal damping dissipate in any state [W]. The call overwrites the gaps that field()
  /// uses.
  [[nodiscard]] double dissipation(const double* state) {
    return model_.dissipated_power(state, state + modes_, work_, film_of(state));
  }
  /// Returns the workspace for computing electrical and elastic energies of a state. Such a computation overwrites the gaps
  /// that field() uses.
  [[nodiscard]] Switch::Workspace& workspace() { return work_; }
  [[nodiscard]] long evaluations() const { return evaluations_; }

 private:
  void rates(double t, const double* state, const ContactStates& laws, double* result);
  void jacobian(double t, const double* state, const ContactStates& laws, double* result);
  [[nodiscard]] const double* film_of(const double* state) const {
    return model_.film_states() > 0 ? state + 2 * modes_ : nullptr;
  }

  const Switch& model_;
  DriveCourse& drives_;
  ContactPhases& phases_;
  std::size_t modes_;
  Switch::Workspace work_;
  OdeSystem system_;
  long evaluations_ = 0;
};

}  // namespace softland
