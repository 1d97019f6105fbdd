// Contact laws: the force that pushes the beam away from the contact, as a function of the interference d = y(x_c) - dt [m].
//
//   linear             P = k d                                                        U = k d^2 / 2
//   asperity-uniform   P = (8/15) eta An E* sqrt(R) [d^2.5 - max(0, d - Hm)^2.5] / Hm
//                      U = (16/105) eta An E* sqrt(R) [d^3.5 - max(0, d - Hm)^3.5] / Hm
//
// Hertz asperities of radius R [m], eta per area [1/m^2], heights uniform on [0, Hm] [m], on an area An = width x pad length
// [m^2], effective modulus E* [Pa]; U the stored energy [J]. Both are lossless. Force zero at d = 0; the asperity law has two
// continuous derivatives there. For d < 0 both are continued as odd functions of d: the right-hand side stays smooth past the
// event at which contact is broken. Validity: elastic asperities that do not touch each other: d well below Hm and R. Source:
// Greenwood & Williamson 1966 with the uniform heights of Wang et al. 2009 (closed form: integral of the Hertz law over heights).
#pragma once

#include <cmath>
#include <variant>

#include "model/device.h"

namespace softland {

struct LinearContact {
  double stiffness = 0;  ///< [N/m]

  template <class S>
  S force(S d) const {
    return S(stiffness) * d;
  }
  [[nodiscard]] double energy(double d) const { return stiffness * d * d / 2; }
};

struct UniformAsperityContact {
  double strength = 0;  ///< eta An E* sqrt(R) / Hm [N / m^2.5]
  double height = 0;    ///< Hm [m]

  template <class S>
  S force(S d) const {
    using std::abs;
    using std::sqrt;
    const S m = abs(d);
    S p = m * m * sqrt(m);
    if (m > height) {
      const S over = m - S(height);
      p = p - over * over * sqrt(over);
    }
    return d < 0 ? -(S(strength * 8 / 15) * p) : S(strength * 8 / 15) * p;
  }
  [[nodiscard]] double energy(double d) const {
    const double m = std::abs(d);
    const auto power = [](double x) { return x > 0 ? x * x * x * std::sqrt(x) : 0; };
    return strength * 16 / 105 * (power(m) - power(m - height));
  }
};

using ContactLaw = std::variant<LinearContact, UniformAsperityContact>;

[[nodiscard]] inline ContactLaw contact_law(const Contact& c, double width) {
  if (c.model == ContactModel::linear) return LinearContact{.stiffness = c.stiffness};
  return UniformAsperityContact{.strength = c.asperity_density * width * c.pad_length * c.effective_modulus *
                                            std::sqrt(c.asperity_radius) / c.asperity_height,
                                .height = c.asperity_height};
}

/// [N]
[[nodiscard]] inline double contact_force(const ContactLaw& law, double interference) {
  return std::visit([&](const auto& l) { return l.force(interference); }, law);
}
/// [J]
[[nodiscard]] inline double contact_energy(const ContactLaw& law, double interference) {
  return std::visit([&](const auto& l) { return l.energy(interference); }, law);
}

}  // namespace softland
