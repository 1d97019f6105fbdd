#include "model/closing/equations.h"

namespace softland {

ClosingEquations::ClosingEquations(const Switch& model, DriveCourse& drives, ContactPhases& phases, bool phase_decides)
    : model_(model), drives_(drives), phases_(phases), modes_(static_cast<std::size_t>(model.modes())), work_(model.workspace()) {
  const Eigen::VectorXd& omega = model.basis().angular_frequencies();
  system_.size = 2 * modes_ + model.film_states();
  system_.frequencies.assign(omega.begin(), omega.end());
  if (model.film_states() > 0) {
    system_.core = 2 * modes_;
    system_.block = ReynoldsFilm::nodes;
  }
  if (phase_decides) {
    system_.rates = [this](double t, const double* y, double* result) { rates(t, y, phases_.states(), result); };
    system_.jacobian = [this](double t, const double* y, double* result) { jacobian(t, y, phases_.states(), result); };
  } else {
    const auto law = [this](const double* y) { return phases_.first().law_at(model_.contact_deflection(y)); };
    system_.rates = [this, law](double t, const double* y, double* result) { rates(t, y, law(y), result); };
    system_.jacobian = [this, law](double t, const double* y, double* result) { jacobian(t, y, law(y), result); };
  }
}

void ClosingEquations::rates(double t, const double* state, const ContactStates& laws, double* result) {
  model_.rates(state, drives_.values(t), laws, work_, result);
  ++evaluations_;
}

void ClosingEquations::jacobian(double t, const double* state, const ContactStates& laws, double* result) {
  const auto n = static_cast<Eigen::Index>(modes_);
  const auto size = static_cast<Eigen::Index>(system_.size);
  Eigen::Map<Eigen::MatrixXd> full(result, size, size);
  full.setZero();
  full.block(0, n, n, n).setIdentity();
  model_.jacobian(state, state + modes_, drives_.values(t), laws, work_, full.block(n, 0, n, n), full.block(n, n, n, n));
  if (model_.film_states() > 0) model_.add_film_derivatives(state, work_, full);
}

FieldFigures ClosingEquations::field(const double* state) {
  return {.smallest_gap = Switch::smallest_gap(work_),
          .at_far_side = model_.at_far_side(work_),
          .dissipation = model_.damped() ? model_.dissipated_power(state + modes_, work_, film_of(state)) : 0};
}

}  // namespace softland
