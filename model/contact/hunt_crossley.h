// Damping in contact that grows with the load (Hunt-Crossley), added to any lossless law that only pushes.
//
//   P = max(0, P0(d) (1 + 1.5 c d'))        dissipated power (P - P0) d' >= 0
//
// P is the force on the beam, away from the contact [N]; P0 force of the law without damping [N]; d interference [m] and d' its
// rate [m/s]; c damping [s/m]; the stored energy is that of P0. Unlike a dashpot the force starts from zero and never pulls. A
// mass that hits at v_i leaves with the restitution e given by G(v_i) = G(-e v_i), G(v) = v/g - ln(1 + g v)/g^2, g = 1.5 c,
// whatever P0: e -> 1 - c v_i for c v_i -> 0. For a single mass P0 (1 + 1.5 c d') is never negative. Other modes may pull the
// contact point out faster than 1/(1.5 c); the force then has a corner, which the step control has to find. Validity: c v_i
// well below 1, where c is a property of the pair. Source: Hunt & Crossley 1975, eqs. 8 to 11.
#pragma once

#include <array>
#include <variant>

#include "base/field.h"
#include "base/select.h"

namespace softland {

template <class Elastic, class P = double>
struct HuntCrossley {
  Elastic elastic = {};
  P damping = 0;  ///< damping constant of the contact (Hunt and Crossley) [s/m]

  template <class S>
  S force(S d, S rate) const {
    const S factor = S(1) + S(1.5 * damping) * rate;
    return select(
        factor > 0, [&]() -> S { return elastic.force(d) * factor; }, [] { return S(0); });
  }
  /// Returns the power that the damping dissipates [W].
  [[nodiscard]] double dissipation(double d, double rate) const { return (force(d, rate) - elastic.force(d)) * rate; }
  /// Returns the force of the contact law without damping.
  template <class S>
  S force(S d) const {
    return elastic.force(d);
  }
  [[nodiscard]] double energy(double d) const { return elastic.energy(d); }
};

/// Returns the contact law `elastic` with damping [s/m] added; `elastic` itself when the damping is 0.
template <class Elastic>
[[nodiscard]] std::variant<Elastic, HuntCrossley<Elastic>> damped(const Elastic& elastic, double damping) {
  if (damping > 0) return HuntCrossley<Elastic>{.elastic = elastic, .damping = damping};
  return elastic;
}

// clang-format off
// Returns the scene-file key of a contact law's member `damping`; 0 means no damping.
template <class Law>
[[nodiscard]] consteval auto damping_fields() {
  return std::to_array<Field<Law>>({
      {.key = "damping", .unit = "s/m", .about = "of Hunt and Crossley: restitution about 1 over 1 + damping times impact velocity; absent: none", .in = reach<Law, &Law::damping>},
  });
}
// clang-format on

}  // namespace softland
