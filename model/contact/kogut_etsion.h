// One asperity that yields: the fits of Kogut and Etsion, in units of its first yield and made continuous.
//
//   u = w / w1       published, load / P1     here                  here / published
//   u <= 1           u^1.5                    u^1.5                 1
//   1 < u <= 6       1.03 u^1.425             u^1.425               0.971
//   6 < u <= 110     1.40 u^1.263             1.337 u^1.263         0.955        1.337 = 6^(1.425 - 1.263)
//   u > 110          (3/K) u                  4.602 u               0.885        4.602 = 1.337 * 110^0.263
//
// w is the interference; w1 and P1 are those of first yield (plastic_asperity.h); K = 0.454 + 0.41 nu = 0.577, for Poisson's
// ratio 0.3. As published the load jumps up by 3 % at w1, by 1.7 % at 6 w1 and by 8 % at 110 w1, where the fully plastic load 2
// pi R w H takes over; at such a jump an integrator of motion would gain or lose energy. So every fit is scaled such that its
// load continues that of the fit for smaller u: Hertz's law is not changed, and the fully plastic load is 0.885 of 2 pi R w H.
// Kinks remain at the three limits. Validity: the fits are those of a frictionless elastic, perfectly plastic hemisphere on a
// rigid flat. Source: Kogut & Etsion 2002, J. Appl. Mech. 69, 657; K: Chang, Etsion & Bogy 1987; the scaling is ours.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "base/select.h"
#include "model/dual.h"
#include "model/power.h"

namespace softland {

class KogutEtsionAsperity {
 public:
  static constexpr double pressure_factor = 0.577;  ///< largest pressure at first yield over hardness (K)

  /// Returns the work of loading one asperity from interference 0 to u, the integral of its load. Interference, load and work
  /// are in units of w1, P1 and P1 w1.
  template <class S>
  static S first_integral(S u) {
    using std::sqrt;
    const auto elastic = [&]() -> S { return S(0.4) * u * u * sqrt(u); };
    const auto by = [&](std::size_t i) {
      return
          [&u, &fit = fits[i]]() -> S { return S(fit.first) + S(fit.factor / (fit.exponent + 1)) * power(u, fit.exponent + 1); };
    };
    const auto yielding = [&] { return select(u > fits[1].begin, by(1), by(0)); };
    return select(
        u > 1, [&] { return select(u > fits[2].begin, by(2), yielding); }, elastic);
  }
  /// Returns the integral of first_integral() from interference 0 to u, for the work of loading all asperities.
  static double second_integral(double u) {
    if (!(u > 1)) return u * u * u * std::sqrt(u) / 8.75;
    const Fit& fit = at(u);
    return fit.second + fit.first * u + fit.factor / ((fit.exponent + 1) * (fit.exponent + 2)) * power(u, fit.exponent + 2);
  }

 private:
  // A fit of the load of an asperity, valid from the interference `begin` on (in units of first yield): the load is factor
  // u^exponent; `first` and `second` are the constants of its first and second antiderivative.
  struct Fit {
    double begin, exponent, factor, first, second;
  };

  static const Fit& at(double u) { return u > fits[2].begin ? fits[2] : u > fits[1].begin ? fits[1] : fits[0]; }

  static inline const std::array<Fit, 3> fits = [] {
    std::array<Fit, 3> all{{{1, 1.425, 0, 0, 0}, {6, 1.263, 0, 0, 0}, {110, 1, 0, 0, 0}}};
    Fit below{0, 1.5, 1, 0, 0};
    for (Fit& fit : all) {
      const double u = fit.begin;
      const auto load = [u](const Fit& f) { return f.factor * std::pow(u, f.exponent); };
      fit.factor = load(below) / std::pow(u, fit.exponent);
      // Choose the constants so that the antiderivatives of this fit continue those of the fit for smaller u.
      fit.first = below.first + u * load(fit) * (1 / (below.exponent + 1) - 1 / (fit.exponent + 1));
      const auto second = [&](const Fit& f) { return f.first * u + u * u * load(f) / ((f.exponent + 1) * (f.exponent + 2)); };
      fit.second = below.second + second(below) - second(fit);
      below = fit;
    }
    return all;
  }();
};

}  // namespace softland
