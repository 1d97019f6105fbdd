#include "model/closing/energy_audit.h"

#include <cmath>
#include <vector>

namespace softland {
namespace {

// Residual of the energy balance above which dissipation is integrated with more points, as a share of the energy that bends
// the beam by the contact gap.
constexpr double worth_care = 1e-4;

}  // namespace

EnergyAudit::EnergyAudit(const Switch& model, DriveCourse& drives, ContactPhases& phases, ClosingEquations& equations,
                         const Knot& start)
    : model_(model),
      drives_(drives),
      phases_(phases),
      equations_(equations),
      modes_(static_cast<std::size_t>(model.modes())),
      rest_energy_(model.potential(start.state.data(), drives.before(), phases.apart(), equations.workspace())) {
  const std::vector<double> before = drives.before();
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (before[k] != 0 && holds_charge(k)) rest_energy_ += before[k] * charge(k, before[k], start.state.data());
  }
  if (!phases.in_contact()) return;
  rest_energy_ += stored_in_contacts(start.state.data());
  dissipated_ = -lost_in_contacts(start.state.data());
}

void EnergyAudit::enter_stretch(const Knot& here, bool first) {
  if (!first) add_charges(here, +1);
  const std::vector<double> at_start = first ? drives_.before() : std::vector<double>();
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    const double before = first ? at_start[k] : drives_.value(k, here.time);
    drives_.enter(k, here.time);
    const double after = drives_.value(k, here.time);
    if (before == after) continue;
    const double potential = model_.law_potential(k, here.state.data(), equations_.workspace());
    if (holds_charge(k)) {
      // At a voltage jump the source delivers the integral of V dQ with dQ = C dV, which is C/2 times the change of V^2. A
      // fixed charge on the dielectric shifts Q by a constant and does not matter.
      source_work_ -= (after * after - before * before) * potential;
    } else {
      source_work_ += (model_.strength(k, after) - model_.strength(k, before)) * potential;
    }
  }
  add_charges(here, -1);
}

void EnergyAudit::add_charges(const Knot& here, double sign) {
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    const double v = drives_.value(k, here.time);
    if (v != 0 && holds_charge(k)) source_work_ += sign * v * charge(k, v, here.state.data());
  }
}

double EnergyAudit::contact_dissipation(const double* state) const {
  if (!model_.has_damped_contact()) return 0;
  double power = 0;
  for (std::size_t c = 0; c < phases_.size(); ++c)
    if (phases_[c].law().active) power += model_.contact_dissipation(state, state + modes_, c);
  return power;
}

double EnergyAudit::stored_in_contacts(const double* q) const {
  double energy = 0;
  for (std::size_t c = 0; c < phases_.size(); ++c)
    if (phases_[c].law().active) energy += model_.contact_stored(q, phases_[c].law(), c);
  return energy;
}

double EnergyAudit::lost_in_contacts(const double* q) const {
  double energy = 0;
  for (std::size_t c = 0; c < phases_.size(); ++c) energy += phases_[c].lost(model_.contact_deflection(q, c));
  return energy;
}

void EnergyAudit::step(const Knot& here, const Knot& next, double dissipation_at_end, StepMotion& motion, bool implicit) {
  const double t0 = here.time, t1 = next.time;
  if (model_.damped()) {
    const double power = dissipation_at_end + contact_dissipation(next.state.data());
    dissipated_ += (t1 - t0) * mean_dissipation(power, motion, implicit);
    dissipation_ = power;
  }
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    const SignalPiece& piece = drives_.piece(k);
    if (piece.is_level()) continue;
    const auto flow = [&](double t, const std::vector<double>& state) {
      return piece.rate(t) * charge(k, piece.voltage(t), state.data());
    };
    source_work_ -= (t1 - t0) / 6 * (flow(t0, here.state) + 4 * flow((t0 + t1) / 2, motion.halfway()) + flow(t1, next.state));
  }
}

// Returns the mean dissipated power over a step, at the end of which the power is `at_end`. Within a step the phase of a mode
// may advance by two radians, and the phase of the dissipated power by four: too much for Simpson's rule in a careful audit,
// which uses Lobatto's rule. Simpson's rule remains when the free motion of the modes does not describe the motion within the
// step, as with a compressible film.
double EnergyAudit::mean_dissipation(double at_end, StepMotion& motion, bool implicit) {
  const auto power = [&](const std::vector<double>& state) {
    return equations_.dissipation(state.data()) + contact_dissipation(state.data());
  };
  const bool by_modes = careful_ && motion.moves_by_modes() && model_.film_states() == 0 && !implicit;
  if (!by_modes) return (dissipation_ + 4 * power(motion.halfway()) + at_end) / 6;
  const double place = 0.5 - 0.5 / std::sqrt(5.0);
  double sum = 0;
  for (const double share : {place, 1 - place}) sum += power(motion.state_at(share));
  return (dissipation_ + 5 * sum + at_end) / 12;
}

void EnergyAudit::rest(const Knot& here, double until) {
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    source_work_ += (model_.strength(k, drives_.value(k, until)) - model_.strength(k, drives_.value(k, here.time))) *
                    model_.law_potential(k, here.state.data(), equations_.workspace());
  }
}

void EnergyAudit::impact(double lost, double dissipation) {
  impacts_ += lost;
  dissipation_ = dissipation;
}

double EnergyAudit::above_rest(const Knot& here) {
  const double* q = here.state.data();
  const std::span<const double> values = drives_.values(here.time);
  return model_.basis().kinetic_energy(q + modes_) + model_.potential(q, values, phases_.states(), equations_.workspace()) +
         impacts_ + model_.film_energy(q, equations_.workspace());
}

// Switch::potential() counts the field of an electrode by its potential at constant voltage V, -C (V - V0)^2 / 2. The energy
// stored in the field is greater by V Q, Q the charge of the electrode; V Q is also part of the work of the sources.
void EnergyAudit::settle(const Knot& here) {
  const double* q = here.state.data();
  const std::span<const double> values = drives_.values(here.time);
  Switch::Workspace& work = equations_.workspace();
  balance_ = {.source_work = source_work_,
              .stored = model_.basis().kinetic_energy(q + modes_) + model_.potential(q, values, phases_.apart(), work) -
                        rest_energy_ + model_.film_energy(q, work),
              .dissipated = dissipated_ + impacts_};
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    if (values[k] == 0 || !holds_charge(k)) continue;
    const double work_of_charge = values[k] * charge(k, values[k], q);
    balance_.source_work += work_of_charge;
    balance_.stored += work_of_charge;
  }
  balance_.stored += stored_in_contacts(q);
  balance_.dissipated += lost_in_contacts(q);
  // This form makes the error NaN when the residual is NaN.
  if (!(std::abs(balance_.residual()) <= error_)) error_ = std::abs(balance_.residual());
  careful_ = careful_ || error_ > worth_care * model_.bending_energy();
}

}  // namespace softland
