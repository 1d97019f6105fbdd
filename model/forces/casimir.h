// Casimir attraction between two parallel plates in vacuum, per area: the retarded dispersion force.
//
//   p(h) = pi^2 hbar c eta(h) / (240 h^4)      [Pa], positive towards the electrode
//   u(h) with p = u'(h), u(infinity) = 0       [J/m^2]
//
// h is the local gap [m]. eta is the reduction by real metals: 1 for ideal conductors (then u = -pi^2 hbar c / (720 h^3)), see
// gold_casimir.h for gold. Each cross-section counts as if the beam were straight and flat, at zero temperature (thermal
// corrections stay below a percent for gaps below 200 nm). Ideal conductors are a limit for gaps well above the plasma
// wavelength (137 nm for gold): at 20 nm they overestimate the force between gold seven times. Singular at h = 0: the switch
// ends a run before any gap vanishes. Source: H. B. G. Casimir 1948, Proc. K. Ned. Akad. Wet. 51, 793.
#pragma once

#include "model/constants.h"

namespace softland {

/// Factor of the Casimir pressure between ideal conductors, pi^2 hbar c / 240 [N m^2].
inline constexpr double casimir_strength = pi * pi * reduced_planck_constant * speed_of_light / 240;

struct IdealCasimir {
  template <class S>
  S pressure(S h) const {
    return S(casimir_strength) / (h * h * h * h);
  }
  [[nodiscard]] double energy(double h) const { return -casimir_strength / (3 * h * h * h); }
};

}  // namespace softland
