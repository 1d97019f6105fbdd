// The integrators of the library SUNDIALS: Hindmarsh et al. (2005), Gardner et al. (2022). Every return value of the library is
// checked; the library's message about a failure becomes the message of the stepper.
#pragma once

#include <memory>

#include "integrators/stepper.h"

namespace softland {

/// Makes a diagonally implicit Runge-Kutta 5(4) with eight stages (Kennedy & Carpenter 2003), ARKODE. At tight tolerances the
/// nonlinear iteration for a stage starts from an extrapolation of the last step.
[[nodiscard]] std::unique_ptr<Stepper> make_esdirk(const OdeSystem& system, double tolerance);
/// Makes backward differentiation formulas of orders 1 to 5, CVODE.
[[nodiscard]] std::unique_ptr<Stepper> make_bdf(const OdeSystem& system);
/// Makes the Adams-Moulton method of orders 1 to 12 with functional iteration, CVODE.
[[nodiscard]] std::unique_ptr<Stepper> make_adams(const OdeSystem& system);
/// Makes the explicit Runge-Kutta method 5(4) of Dormand & Prince (1980), ARKODE.
[[nodiscard]] std::unique_ptr<Stepper> make_arkode_erk(const OdeSystem& system);

}  // namespace softland
