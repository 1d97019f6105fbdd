// Loading of a rough contact whose asperities yield, heights uniform on [0, Hm].
//
//   P = (eta An / Hm) integral from max(0, d - Hm) to d of p(w) dw;   W = integral of P, the work of loading
//
// P is the force on the beam, away from the contact [N]; d interference [m]; p load of one asperity at interference w [N]:
// zmc.h or kogut_etsion.h, each in units of the load P1 and the interference w1 of first yield,
//
//   w1 = (pi K H / (2 E*))^2 R,   P1 = (2/3) pi K H R w1
//
// p is Hertz's load for w < w1. R is the summit radius [m]; H hardness of the softer surface [Pa]; K the law's factor between
// largest pressure and hardness at first yield; E* effective modulus [Pa]; eta summits per area [1/m^2]; An = width x pad
// length [m^2]; W [J]. The integrals are in closed form. For d < w1 the law equals asperity-uniform. One asperity's load is
// continuous with kinks; the sum has a continuous slope. The law is odd in d (P(-d) = -P(d)). Validity: asperities that do not
// touch each other; quasi-static yield. Unloading is not part of this law: see memory.h. Source: the laws of one asperity as
// named there; the sum over heights as in Greenwood & Williamson 1966.
#pragma once

#include <cmath>

#include "model/constants.h"
#include "model/contact/kogut_etsion.h"
#include "model/contact/zmc.h"

namespace softland {

template <class Asperity, class P = double>
class PlasticAsperityLoading {
 public:
  PlasticAsperityLoading() = default;
  /// `summits` is the number of summits under the pad; `height` is the greatest height of the summits [m], `radius` their
  /// radius [m], `hardness` that of the softer surface [Pa], `modulus` the effective modulus [Pa].
  PlasticAsperityLoading(const P& summits, const P& height, const P& radius, const P& hardness, const P& modulus)
      : height_(height), yield_(first_yield(radius, hardness, modulus)) {
    strength_ = summits / height * 2 / 3 * pi * Asperity::pressure_factor * hardness * radius * yield_ * yield_;
  }

  /// Returns the interference of an asperity at first yield [m].
  [[nodiscard]] static P first_yield(const P& radius, const P& hardness, const P& modulus) {
    const P root = pi * Asperity::pressure_factor * hardness / (2 * modulus);
    return root * root * radius;
  }

  template <class S>
  S force(S d) const {
    using std::abs;
    const S m = abs(d), all = Asperity::first_integral(m / S(yield_));
    const S sum = select(
        m > height_, [&]() -> S { return all - Asperity::first_integral((m - S(height_)) / S(yield_)); }, [&] { return all; });
    return select(
        d < 0, [&]() -> S { return -(S(strength_) * sum); }, [&]() -> S { return S(strength_) * sum; });
  }
  /// Returns the work of loading the contact from first contact to the interference d [J].
  [[nodiscard]] double energy(double d) const {
    const double m = std::abs(d);
    const double beyond = m > height_ ? Asperity::second_integral((m - height_) / yield_) : 0;
    return strength_ * yield_ * (Asperity::second_integral(m / yield_) - beyond);
  }

 private:
  P height_ = 1;    // greatest height of the asperity summits [m]
  P yield_ = 1;     // interference of an asperity at first yield [m]
  P strength_ = 0;  // factor of the contact force [N]: (eta An / Hm) P1 w1 of the header's formula
};

}  // namespace softland
