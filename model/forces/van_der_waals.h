// Van der Waals attraction between two half spaces, per area, with the repulsion of the 9-3 wall: the dispersion force at short
// distance, where it is not retarded.
//
//   p(h) = A / (6 pi h^3) [1 - (h0/h)^6]             [Pa], positive towards the electrode
//   u(h) = -A / (12 pi h^2) [1 - (h0/h)^6 / 4]       [J/m^2], p = u'(h)
//
// h is the local gap [m], A the Hamaker constant [J], h0 the equilibrium distance [m]: p = 0 at h0, strongest pull at 3^(1/6)
// h0, adhesion energy 3/4 A / (12 pi h0^2). h0 = 0 means no repulsion. Valid while the gap is well below the wavelengths that
// carry the force (tens of nanometres; retardation begins at a few), and for flat surfaces; the thickness of beam and electrode
// counts as infinite. Singular at h = 0: the switch ends a run before any gap vanishes. Sources: H. C. Hamaker 1937, Physica 4,
// 1058; the 12-6 potential summed over half spaces: J. N. Israelachvili 2011, Intermolecular and Surface Forces, ch. 11 and 13.
#pragma once

#include "model/constants.h"

namespace softland {

/// The van der Waals law. `P` is the scalar type of the parameters; the scalar type of the state must be constructible from P.
template <class P>
struct VanDerWaalsOf {
  P hamaker_constant = 0;      ///< Hamaker constant [J]
  P equilibrium_distance = 0;  ///< gap at which attraction and repulsion balance [m]; 0: no repulsion

  template <class S>
  S pressure(S h) const {
    return attraction(h) - repulsion(h);
  }
  [[nodiscard]] double energy(double h) const { return attraction_energy(h) + repulsion_energy(h); }

  template <class S>
  S attraction(S h) const {
    return S(hamaker_constant / (6 * pi)) / (h * h * h);
  }
  template <class S>
  S repulsion(S h) const {
    const S ratio = S(equilibrium_distance) / h, cube = ratio * ratio * ratio;
    return attraction(h) * cube * cube;
  }
  [[nodiscard]] double attraction_energy(double h) const { return -hamaker_constant / (12 * pi * h * h); }
  [[nodiscard]] double repulsion_energy(double h) const { return h * repulsion(h) / 8; }
};
using VanDerWaals = VanDerWaalsOf<double>;

}  // namespace softland
