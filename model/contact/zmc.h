// One asperity that yields: the law of Zhao, Maietta and Chang, in units of its first yield.
//
//   u = w / w1     load / P1
//   u <= 1         u^1.5                                                    Hertz
//   1 < u < 54     a(s) (1 + beta ln u) u,  a = 1 + 3 s^2 - 2 s^3,  s = (u - 1) / 53,  beta = (1 - k) / (k ln 54)
//   u >= 54        2 u / k                                                  fully plastic
//
// w is the interference; w1 and P1 are those of first yield (plastic_asperity.h); k = 0.4 is the mean pressure at first yield
// over hardness, so that K = 1.5 k = 0.6. The load for 1 < u < 54 is contact area times mean pressure, A p, as published: A =
// pi R w a(s), p = H - H (1 - k) (ln w2 - ln w) / (ln w2 - ln w1), w2 = 54 w1. The load is continuous, with kinks at u = 1 and
// u = 54. Source: Zhao, Maietta & Chang 2000, eqs. 11, 20 and 24.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "base/select.h"

namespace softland {

class ZmcAsperity {
 public:
  static constexpr double pressure_factor = 0.6;  ///< largest pressure at first yield over hardness (K)

  /// Returns the work of loading one asperity from interference 0 to u, the integral of its load. Interference, load and work
  /// are in units of w1, P1 and P1 w1.
  template <class S>
  static S first_integral(S u) {
    using std::sqrt;
    const auto elastic = [&]() -> S { return S(0.4) * u * u * sqrt(u); };
    const auto yielding = [&]() -> S { return S(0.4 - middle<1>(1.0)) + middle<1>(u); };
    const auto plastic = [&]() -> S { return S(first_integral(ratio) - ratio * ratio / k) + u * u * S(1 / k); };
    return select(
        u > 1, [&] { return select(u > ratio, plastic, yielding); }, elastic);
  }
  /// Returns the integral of first_integral() from interference 0 to u, for the work of loading all asperities.
  static double second_integral(double u) {
    if (!(u > 1)) return u * u * u * std::sqrt(u) / 8.75;
    if (!(u > ratio)) return 1 / 8.75 + (u - 1) * (0.4 - middle<1>(1.0)) + middle<2>(u) - middle<2>(1.0);
    return second_integral(ratio) + first_integral(ratio) * (u - ratio) +
           (u * u * u - 3 * ratio * ratio * u + 2 * ratio * ratio * ratio) / (3 * k);
  }

 private:
  static constexpr double k = 0.4;     // mean pressure of an asperity at first yield over hardness
  static constexpr double ratio = 54;  // interference of an asperity at full plasticity over that at first yield

  // Returns the first or second antiderivative of the load for 1 < u < 54, which is a sum of a_j u^j (1 + beta ln u), j = 1 ...
  // 4.
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
};

}  // namespace softland
