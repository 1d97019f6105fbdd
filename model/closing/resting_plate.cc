#include "model/closing/resting_plate.h"

#include <algorithm>

#include "integrators/roots.h"
#include "model/contact/contact_law.h"

namespace softland {

RestingPlate::RestingPlate(const Switch& model, DriveCourse& drives, ClosingEquations& equations)
    : model_(model),
      drives_(drives),
      equations_(equations),
      rates_(static_cast<std::size_t>(model.modes()) + model.film_states()) {}

double RestingPlate::load(const Knot& here, double t) {
  equations_.rates(t, here.state.data(), rates_.data());
  return rates_[0] / model_.basis().contact_shape()[0];
}

// The state of a rigid plate is one coordinate and one velocity, since a plate has a single mode.
RestingPlate::Impact RestingPlate::strike(Knot& here) {
  const RigidContact& contact = *model_.rigid_contact();
  const double shape = model_.basis().contact_shape()[0], plane = model_.contact_gap();
  double &q = here.state[0], &v = here.state[1];
  Impact impact{.energy = model_.basis().kinetic_energy(&v)};
  const double speed = contact.restitution * std::max(0.0, v * shape);
  q = plane / shape;  // reset the position, since position errors would add up over many impacts
  v = 0;
  impact.rests = RigidContact::rests(speed, load(here, here.time) * shape * shape, plane);
  if (!impact.rests) v = -speed / shape;
  impact.lost = impact.energy - model_.basis().kinetic_energy(&v);
  return impact;
}

void RestingPlate::begin(Knot& here, double stretch_end) {
  constexpr double looks = 32;  // evaluations of the force until the next breakpoint; more if a voltage oscillates
  force_ = here.rates[0] / model_.basis().contact_shape()[0];
  here.rates[0] = 0;
  look_ = std::min((stretch_end - here.time) / looks, drives_.resolving_step(here.time));
}

RestingPlate::Stay RestingPlate::stay(const Knot& here, double stretch_end) {
  const bool pressed = force_ >= 0;
  double t = pressed ? std::min(stretch_end, here.time + look_) : here.time, next = load(here, t);
  if (pressed && next < 0) {
    const double last = t;
    t = bracketed_zero([&](double at) { return load(here, at); }, here.time, last);
    // Move the end of the rest from the zero of the force to a slightly later time, at which the force pulls the plate off.
    // Exactly at the zero, the plate would count as resting again.
    for (double more = 1e-15 * last; (next = load(here, t)) >= 0; more *= 2) t = std::min(last, t + more);
  }
  force_ = next;
  return {.until = t, .leaves = next < 0};
}

}  // namespace softland
