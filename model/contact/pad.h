// Contact along the pad of a cantilever: the force of a contact law, spread evenly over the pad, acts wherever the pad is
// beyond the contact plane.
//
//   d(xi) = d - theta xi,  0 <= xi <= lt        f_i = -(1 / lt) integral of P(d(xi)) [phi_i - xi phi_i'] dxi over d(xi) > 0
//   U = (1 / lt) integral of U(d(xi)) dxi,      dissipated power likewise
//
// xi is the distance from the free end [m], lt pad length [m], d interference of the free end [m], theta = y'(L) its slope;
// phi_i and phi_i' mode and slope at the free end; P force [N] and U energy [J] of the law for the whole pad at one
// interference. Every mode leaves the free end without curvature and shear, so the pad is taken as straight: over the pad mode
// i, of wave number k, departs from its tangent by (k lt)^4 / 24 of its deflection.
//
// Gauss points cover the part in contact, whose edge moves with the beam, in the root of the distance from that edge. In this
// variable the half-integer powers of the contact laws are polynomials, so the rule is exact while part of the pad is in
// contact. Measured errors, relative to the force: 2e-12 when the whole pad is in contact, 3e-10 for Gaussian summits, 3e-5
// where summits are crushed (d > Hm: the law has a corner there). Limits: laws without memory whose force starts from zero; a
// law with memory would keep a dent at every point. Validity: pad much shorter than the beam. Source: textbook.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/gauss.h"

namespace softland {

class PadQuadrature {
 public:
  explicit PadQuadrature(double length) : length_(length) {
    const GaussRule rule = gauss_rule(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double root = (1 + rule.points[i]) / 2;
      places_[i] = root * root;
      shares_[i] = rule.weights[i] * root;
    }
  }

  /// Calls f(xi, share, interference) for each Gauss point in the part of the pad that is beyond the contact plane; xi is the
  /// distance from the free end [m]. The weights `share` add up to the length of this part over the pad's length.
  template <class F>
  void over_contact(double end, double slope, F&& f) const {
    const double inner = end - slope * length_, deep = std::max(end, inner);
    if (!(deep > 0)) return;
    const double shallow = std::max(0.0, std::min(end, inner)), rise = deep - shallow;
    // A pad that lies parallel to the contact plane is in contact over its whole length.
    const double part = shallow > 0 || rise == 0 ? length_ : rise / std::abs(slope);
    for (std::size_t i = 0; i < count; ++i) {
      const double from_deep = part * (1 - places_[i]);
      f(slope < 0 ? length_ - from_deep : from_deep, part / length_ * shares_[i], shallow + rise * places_[i]);
    }
  }

 private:
  static constexpr std::size_t count = 12;
  double length_;  // length of the contact pad [m]
  // Positions of the Gauss points in (0, 1), from the shallow end of the pad's part in contact to its deep end.
  std::array<double, count> places_{};
  std::array<double, count> shares_{};  // weights of the Gauss points, with sum 1
};

}  // namespace softland
