// Loading of a rough contact whose asperities yield: the law of Zhao, Maietta and Chang for one asperity, heights uniform on
// [0, Hm].
//
//   one asperity at interference w:
//     w <= w1         P1 (w/w1)^1.5                        Hertz, P1 = pi R w1 k H,  w1 = (3 pi k H / (4 E*))^2 R
//     w1 < w < w2     A p,  A = pi R w (1 + 3 s^2 - 2 s^3),  s = (w - w1) / (w2 - w1)
//                           p = H - H (1 - k) (ln w2 - ln w) / (ln w2 - ln w1)
//     w >= w2         2 pi R w H                            fully plastic
//   P = (eta An / Hm) integral from max(0, d - Hm) to d of that;   W = integral of P, the work of loading
//
// P force on the beam, away from the contact [N]; d interference [m]; R radius [m]; H hardness of the softer surface [Pa]; E*
// effective modulus [Pa]; k = 0.4 mean pressure at first yield over H; w2 = 54 w1; eta summits per area [1/m^2]; An = width x pad
// length [m^2]; W [J]. Below w1 it is the law asperity-uniform. One asperity's force is continuous with kinks at w1 and w2, the
// sum has a continuous slope. Odd in d. Validity: asperities that do not touch each other; quasi-static yield. What happens on
// unloading is not this law's: see memory.h. Source: Zhao, Maietta & Chang 2000, eqs. 11, 20 and 24; the sum over heights as in
// Greenwood & Williamson 1966.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "model/constants.h"

namespace softland {

class PlasticAsperityLoading {
 public:
  PlasticAsperityLoading() = default;
  /// `summits` eta An, `height` Hm [m], `radius` R [m], `hardness` H and `modulus` E* [Pa]
  PlasticAsperityLoading(double summits, double height, double radius, double hardness, double modulus)
      : height_(height), yield_(first_yield(radius, hardness, modulus)) {
    strength_ = summits / height * pi * radius * yield_ * k * hardness * yield_;
  }

  /// w1 [m]
  [[nodiscard]] static double first_yield(double radius, double hardness, double modulus) {
    const double root = 3 * pi * k * hardness / (4 * modulus);
    return root * root * radius;
  }

  template <class S>
  S force(S d) const {
    using std::abs;
    const S m = abs(d);
    S sum = first_integral(m / S(yield_));
    if (m > height_) sum = sum - first_integral((m - S(height_)) / S(yield_));
    return d < 0 ? -(S(strength_) * sum) : S(strength_) * sum;
  }
  /// Work of loading from first touch to d [J]
  [[nodiscard]] double energy(double d) const {
    const double m = std::abs(d);
    const double sum = second_integral(m / yield_) - (m > height_ ? second_integral((m - height_) / yield_) : 0);
    return strength_ * yield_ * sum;
  }

 private:
  static constexpr double k = 0.4;     // mean pressure at first yield over hardness
  static constexpr double ratio = 54;  // w2 / w1

  // In units of w1 and P1, with u = w / w1, one asperity carries u^1.5 below 1, sum of a_j u^j (1 + beta ln u), j = 1 ... 4, up
  // to `ratio`, and 2 u / k beyond. The first and second antiderivative of the middle part:
  template <int Times, class S>
  static S middle(S u) {
    using std::log;
    constexpr double q = ratio - 1;
    constexpr std::array<double, 4> a{1 + 3 / (q * q) + 2 / (q * q * q), -6 / (q * q) - 6 / (q * q * q),
                                      3 / (q * q) + 6 / (q * q * q), -2 / (q * q * q)};
    const double beta = (1 - k) / (k * std::log(ratio));
    const S logarithm = log(u);
    S sum(0), power = u;
    for (std::size_t i = 0; i < a.size(); ++i) {
      double factor = a[i], constant = 1;
      for (int t = 1; t <= Times; ++t) {
        const double j = static_cast<double>(i) + 1 + t;
        factor /= j;
        constant -= beta / j;
      }
      sum = sum + S(factor) * power * (S(constant) + S(beta) * logarithm);
      power = power * u;
    }
    for (int t = 1; t <= Times; ++t) sum = sum * u;
    return sum;
  }
  // Integrals from 0.
  template <class S>
  static S first_integral(S u) {
    using std::sqrt;
    if (!(u > 1)) return S(0.4) * u * u * sqrt(u);
    if (!(u > ratio)) return S(0.4 - middle<1>(1.0)) + middle<1>(u);
    return S(first_integral(ratio) - ratio * ratio / k) + u * u * S(1 / k);
  }
  static double second_integral(double u) {
    if (!(u > 1)) return u * u * u * std::sqrt(u) / 8.75;
    if (!(u > ratio)) return 1 / 8.75 + (u - 1) * (0.4 - middle<1>(1.0)) + middle<2>(u) - middle<2>(1.0);
    return second_integral(ratio) + first_integral(ratio) * (u - ratio) +
           (u * u * u - 3 * ratio * ratio * u + 2 * ratio * ratio * ratio) / (3 * k);
  }

  double height_ = 1;    // [m]
  double yield_ = 1;     // w1 [m]
  double strength_ = 0;  // (eta An / Hm) P1 w1 [N]
};

}  // namespace softland
