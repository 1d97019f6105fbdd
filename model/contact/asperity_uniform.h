// Rough contact: Hertz asperities with heights uniform on [0, Hm].
//
//   P = (8/15) eta An E* sqrt(R) [d^2.5 - max(0, d - Hm)^2.5] / Hm
//   U = (16/105) eta An E* sqrt(R) [d^3.5 - max(0, d - Hm)^3.5] / Hm
//
// P is the force on the beam, away from the contact [N]; d interference [m]; R radius [m]; eta summits per area [1/m^2]; An =
// width x pad length [m^2]; E* effective modulus [Pa]; U stored energy [J]. The law is lossless. The force is zero at d = 0
// with two continuous derivatives. For d < 0 it is continued as an odd function: the equations of motion stay smooth beyond the
// contact plane, where an integrator evaluates them before it locates the end of contact. Validity: elastic asperities that do
// not touch each other: d well below Hm and R. Source: Greenwood & Williamson 1966 with the uniform heights of Wang et al. 2009
// (closed form: integral of the Hertz law over heights).
#pragma once

#include <cmath>

#include "model/contact/uniform_asperities.h"
#include "model/dual.h"

namespace softland {

/// The contact law of asperities of uniform heights. `P` is the scalar type of the parameters; the scalar type of the state
/// must be constructible from P.
template <class P>
struct UniformAsperityContactOf {
  P strength = 0;  ///< factor eta An E* sqrt(R) / Hm of the contact force [N / m^2.5]
  P height = 0;    ///< greatest height of the asperities [m]

  static constexpr bool grows_with_depth = true;  ///< the contact force is largest where the contact is deepest

  template <class S>
  S force(S d) const {
    using std::abs;
    using std::sqrt;
    const S m = abs(d), all = m * m * sqrt(m);
    const S p = select(
        m > height,
        [&]() -> S {
          const S over = m - S(height);
          return all - over * over * sqrt(over);
        },
        [&] { return all; });
    return select(
        d < 0, [&]() -> S { return -(S(strength * 8 / 15) * p); }, [&]() -> S { return S(strength * 8 / 15) * p; });
  }
  [[nodiscard]] double energy(double d) const {
    const double m = std::abs(d);
    const auto power = [](double x) { return x > 0 ? x * x * x * std::sqrt(x) : 0; };
    return strength * 16 / 105 * (power(m) - power(m - height));
  }
  /// Returns the interference at which the contact force is `load` >= 0 [m].
  [[nodiscard]] double interference(double load) const {
    double d = std::pow(load / (strength * 8 / 15), 0.4);
    if (d <= height) return d;
    // Newton's method from below the solution: as the force is convex, the first step overshoots and later steps descend to it.
    for (int i = 0; i < 50; ++i) {
      const Dual at = force(Dual(d, 1));
      const double step = (at.value - load) / at.slope;
      d -= step;
      if (std::abs(step) < 1e-15 * d) break;
    }
    return d;
  }
  /// Returns the interference at which the contact stores this energy while only some asperities are in contact [m].
  [[nodiscard]] double interference_of_energy(double stored) const { return height * std::pow(stored / energy(height), 2.0 / 7); }
};

/// Returns the contact law of all asperities `summits` under the pad, with heights uniform up to `height` [m].
[[nodiscard]] inline UniformAsperityContact uniform_contact(const Summits& summits, double height, const ContactPad& pad) {
  return {.strength = summits.hertz(pad) / height, .height = height};
}

inline std::variant<UniformAsperityContact, HuntCrossley<UniformAsperityContact>> UniformAsperities::law(
    const ContactPad& pad) const {
  return damped(uniform_contact(summits, height, pad), damping);
}

}  // namespace softland
