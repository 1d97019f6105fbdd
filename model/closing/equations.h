// The equations of motion of the switch under its drives, with each contact law in its current phase (branch), for an
// integrator.
#pragma once

#include "integrators/stepper.h"
#include "model/closing/contact_phase.h"
#include "model/closing/drive_course.h"
#include "model/closing/knot.h"
#include "model/switch.h"

namespace softland {

class ClosingEquations {
 public:
  /// Keeps references to its arguments. If `phase_decides`, the state of a contact law follows from the phase (branch) of the
  /// contact, otherwise from the position of the contact point alone.
  ClosingEquations(const Switch& model, DriveCourse& drives, ContactPhases& phases, bool phase_decides);
  ClosingEquations(const ClosingEquations&) = delete;
  ClosingEquations& operator=(const ClosingEquations&) = delete;

  [[nodiscard]] const OdeSystem& system() const { return system_; }
  /// Computes the time derivatives of a state, except q', at time t, with every contact law in the branch of its current phase.
  void rates(double t, const double* state, double* result) { rates(t, state, phases_.states(), result); }
  void rates(Knot& knot) { rates(knot.time, knot.state.data(), knot.rates.data()); }
  /// Returns figures of the gap between beam and electrode (gap field) from the last evaluation of rates(), whose state must
  /// equal `state` up to rounding.
  [[nodiscard]] FieldFigures field(const double* state);
  /// Returns the power that gas, film and modal damping dissipate in any state [W]; overwrites the gap field.
  [[nodiscard]] double dissipation(const double* state) {
    return model_.dissipated_power(state, state + modes_, work_, film_of(state));
  }
  /// Returns the workspace in which electrical and elastic energies of a state are computed; their computation overwrites its
  /// gap field.
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
