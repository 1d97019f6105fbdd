#include "integrators/stepper.h"

#include <stdexcept>

#include "integrators/lawson.h"
#include "integrators/sundials_steppers.h"

namespace softland {

std::unique_ptr<Stepper> make_stepper(Integrator integrator, const OdeSystem& system, double tolerance) {
  switch (integrator) {
    case Integrator::lawson:
      return std::make_unique<Lawson>(system);
    case Integrator::arkode_erk:
      return make_arkode_erk(system);
    case Integrator::esdirk:
      return make_esdirk(system, tolerance);
    case Integrator::bdf:
      return make_bdf(system);
    case Integrator::adams:
      return make_adams(system);
    case Integrator::automatic:
      break;
  }
  throw std::logic_error("no stepper exists for Integrator::automatic; choose a method");
}

}  // namespace softland
