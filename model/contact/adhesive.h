// Rough contact with adhesion: asperities of uniform heights, each pulled by the constant DMT adhesion force while in contact.
//
//   P = P_u(d) - 2 pi R W N(d),    N = eta An min(d, Hm) / Hm
//   U = U_u(d) - pi R W eta An [d^2 - max(0, d - Hm)^2] / Hm
//
// P is the force on the beam, away from the contact [N]: negative at small d, where adhesion dominates. P_u, U_u are force [N]
// and energy [J] of the law asperity-uniform; N summits in contact; R their radius [m]; W work of adhesion [J/m^2]; eta summits
// per area [1/m^2]; An = width x pad length [m^2]; Hm [m]; d interference [m]. The law is lossless. Attraction between summits
// that do not touch is neglected, so nothing acts before first contact and the force starts from zero. For d < 0 the force is
// continued as an odd function. W = 0 is asperity-uniform. Validity: Tabor number (R W^2 / (E*^2 z0^3))^(1/3) below about 0.1
// with z0 some 0.2 to 0.4 nm. Beyond about 5 adhesion forms a neck (JKR) and breaking dissipates; this law does not describe
// that. Source: Derjaguin, Muller & Toporov 1975; the sum over heights as in Greenwood & Williamson 1966.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/constants.h"
#include "model/contact/adhesive_asperities.h"
#include "model/contact/asperity_uniform.h"

namespace softland {

/// The law of rough contact with adhesion. `P` is the scalar type of the parameters; the scalar type of the state must be
/// constructible from P.
template <class P>
struct AdhesiveAsperityContactOf {
  UniformAsperityContactOf<P> repulsion = {};
  P attraction = 0;  ///< adhesion force per interference while the number of touching summits grows [N/m]

  template <class S>
  S force(S d) const {
    const auto most = [&] { return S(repulsion.height); };
    const auto least = [&] { return S(-repulsion.height); };
    const S bounded = select(d > repulsion.height, most, [&] { return select(d < -repulsion.height, least, [&] { return d; }); });
    return repulsion.force(d) - S(attraction) * bounded;
  }
  [[nodiscard]] double energy(double d) const {
    const double over = std::max(0.0, std::abs(d) - repulsion.height);
    return repulsion.energy(d) - attraction * (d * d - over * over) / 2;
  }
};
using AdhesiveAsperityContact = AdhesiveAsperityContactOf<double>;

inline AdhesiveAsperityContact AdhesiveAsperities::law(const ContactPad& pad) const {
  return {.repulsion = uniform_contact(summits, height, pad),
          .attraction = 2 * pi * summits.radius * adhesion_energy * summits.count(pad) / height};
}

}  // namespace softland
