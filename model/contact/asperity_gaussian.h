// Rough contact: Hertz asperities with Gaussian heights (Greenwood-Williamson).
//
//   P = C [F_1.5(h0 - d/sigma) - F_1.5(h0)],    C = (4/3) eta An E* sqrt(R) sigma^1.5,    h0 = 4
//   U = C sigma {[F_2.5(h0 - d/sigma) - F_2.5(h0)] / 2.5 - F_1.5(h0) d/sigma}
//   F_n(h) = integral from h to infinity of (s - h)^n exp(-s^2/2) / sqrt(2 pi) ds
//
// P is the force on the beam, away from the contact [N]; d interference [m]; sigma standard deviation of the summit heights
// [m]; R radius [m]; eta summits per area [1/m^2]; An = width x pad length [m^2]; E* effective modulus [Pa]; U stored energy
// [J]. The law is lossless.
//
// The tail of the heights is unbounded: in this law some summit is always in contact. Contact begins, by definition, where the
// mean of the summits is four standard deviations away (three summits in 100 000 are higher). The force there, 1e-5 of the
// force at the mean, is subtracted, so that the force starts from zero. For d < 0 the same formula continues smoothly; it is at
// least minus the subtracted force. Validity: elastic asperities that do not touch each other, many of them in contact,
// separation above the mean of the summits: d < 4 sigma. Source: Greenwood & Williamson 1966, eq. 15; the constant h0 is our
// choice. F_1.5 is tabulated as Taylor series about nodes an eighth apart, from the equation y'' + h y' - n y = 0 that F_n
// obeys. The series are computed from h = 14 towards smaller h, a direction in which the other solution of the equation decays,
// and scaled by the closed form of F_1.5(0). The relative error is below 1e-11 on [-8, 8] (checked against quadrature); below
// this range a series in 1/h^2 is used, and above it 0.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "base/select.h"
#include "model/contact/gaussian_asperities.h"

namespace softland {
namespace internal {

/// The integral F_1.5(h) of (s - h)^1.5 times the Gaussian density over s > h, as a table of Taylor series.
class GaussianTail {
 public:
  static const GaussianTail& instance();

  /// Returns F_1.5(h), for a number, a number with derivatives or a SIMD vector.
  template <class S>
  S operator()(S h) const {
    return one_by_one(h, [this](const auto& one) { return this->of_one(one); });
  }

 private:
  template <class S>
  S of_one(S h) const {
    using std::sqrt;
    if (h > last) return S(0);
    if (h < first) {
      // Series in 1/h^2 for h far below 0: F_1.5 is then nearly the mean of (s + |h|)^1.5 over the Gaussian density.
      const S m = -h, x = S(1) / (m * m);
      S sum(0);
      for (std::size_t k = moments.size(); k-- > 0;) sum = sum * x + S(moments[k]);
      return m * sqrt(m) * sum;
    }
    const std::size_t node = nearest(h);
    const S step = h - S(first + spacing * static_cast<double>(node));
    const Series& c = series_[node];
    S sum(c[degree]);
    for (std::size_t k = degree; k-- > 0;) sum = sum * step + S(c[k]);
    return sum;
  }

  static constexpr double first = -8, last = 8, spacing = 0.125;
  static constexpr std::size_t degree = 11;
  static constexpr std::size_t nodes = static_cast<std::size_t>((last - first) / spacing) + 1;
  using Series = std::array<double, degree + 1>;
  // Coefficients of h^(-2k) in the series of F_1.5 for h far below 0: binom(1.5, 2k) (2k - 1)!!.
  static constexpr std::array<double, 10> moments = [] {
    std::array<double, 10> m{1};
    for (std::size_t k = 1; k < m.size(); ++k) {
      const double j = 2 * static_cast<double>(k);
      m[k] = m[k - 1] * (3.5 - j) * (2.5 - j) / j;
    }
    return m;
  }();

  GaussianTail();
  template <class S>
  static std::size_t nearest(S h) {
    if constexpr (requires { h.value; }) {
      return nearest(h.value);
    } else {
      return static_cast<std::size_t>((h - first) / spacing + 0.5);  // NOLINT(bugprone-incorrect-roundings): never negative
    }
  }

  std::array<Series, nodes> series_;
};

}  // namespace internal

/// The contact law of Gaussian asperities. `P` is the scalar type of the parameters; the scalar type of the state must be
/// constructible from P.
template <class P>
struct GaussianAsperityContactOf {
  P strength = 0;   ///< factor C of the contact force [N] in the header's formula
  P deviation = 0;  ///< standard deviation of the asperity heights [m]

  /// Distance h0 from the mean of the summits to the contact plane, in standard deviations.
  static constexpr double first_touch = 4;

  /// Returns F_1.5(h), the integral of (s - h)^1.5 times the Gaussian density over s > h.
  template <class S>
  static S tail(S h) {
    return internal::GaussianTail::instance()(h);
  }
  /// Returns F_2.5(h) for the energy, computed as 1.5 F_0.5(h) - h F_1.5(h) with F_0.5 = -F_1.5' / 1.5.
  static double next_tail(double h);

  static constexpr bool grows_with_depth = true;  ///< the contact force is largest where the contact is deepest

  template <class S>
  S force(S d) const {
    return S(strength) * (tail(S(first_touch) - d / S(deviation)) - S(tail(first_touch)));
  }
  [[nodiscard]] double energy(double d) const {
    const double x = d / deviation;
    return strength * deviation * ((next_tail(first_touch - x) - next_tail(first_touch)) / 2.5 - tail(first_touch) * x);
  }
};

template <>
double GaussianAsperityContact::next_tail(double h);

inline double GaussianAsperities::largest_interference() const { return GaussianAsperityContact::first_touch * deviation; }

inline std::variant<GaussianAsperityContact, HuntCrossley<GaussianAsperityContact>> GaussianAsperities::law(
    const ContactPad& pad) const {
  return damped(GaussianAsperityContact{.strength = 4.0 / 3 * summits.hertz(pad) * deviation * std::sqrt(deviation),
                                        .deviation = deviation},
                damping);
}

}  // namespace softland
