// Laws of the electric field that fringes at the sides of a beam: the factor phi by which it raises the force per length of an
// electrode (model/forces/electrostatic.h), and the capacitance per length c that belongs to that force.
//
// h local gap [m], a width [m], b thickness [m]. Fringing factors phi and c / eps0:
//   none            1                                                     a/h
//   linear          1 + 0.65 h/a           (Osterberg & Senturia 1997)    a/h - 0.65 ln(h/a)
//   meijs-fokkema   1 + 0.265 (h/a)^0.75 + 0.53 (h/a) (b/h)^0.5           a/h + 0.77 + 1.06 (a/h)^0.25 + 1.06 (b/h)^0.5
//                   (van der Meijs & Fokkema 1984, derivative of their capacitance; force within 1.5 % of a boundary-element
//                   solution for b <= h, within 4 % for b = 2 h)
//   bao-2001        1 + (h / (pi a)) [ln(pi a / h) + ln(1 + 2 b/h + 2 sqrt(b/h + b^2/h^2))]
//                   (Bao 2001 in Bognash 2019, eqs. 2.2-2.3: a capacitance correction used as a force factor; kept because
//                   Bognash uses it; 2 to 11 % too much force). c is then the integral of the force, not Bao's capacitance.
// Singular at h = 0: the switch ends a run before any gap vanishes. For linear and bao-2001 the constant in c is a convention;
// it shifts a charge, never a force. To add a law, write a struct and add an alternative of FringingLaw, an enumerator and a
// row of fringing_laws.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <variant>

#include "base/choice.h"
#include "base/gauss.h"
#include "model/constants.h"
#include "model/power.h"

namespace softland {

template <class P>
struct NoFringingOf {
  P width = 0;  ///< width of the beam [m]

  template <class S>
  S factor(S) const {
    return S(1);
  }
  template <class S>
  [[nodiscard]] S capacitance_over_eps0(S h) const {
    return S(width) / h;
  }
};
using NoFringing = NoFringingOf<double>;

template <class P>
struct LinearFringingOf {
  P width = 0;  ///< width of the beam [m]

  template <class S>
  S factor(S h) const {
    return S(1) + S(0.65 / width) * h;
  }
  template <class S>
  [[nodiscard]] S capacitance_over_eps0(S h) const {
    using std::log;
    return S(width) / h - S(0.65) * log(h / S(width));
  }
};
using LinearFringing = LinearFringingOf<double>;

template <class P>
struct MeijsFokkemaFringingOf {
  P width = 0;      ///< width of the beam [m]
  P thickness = 0;  ///< thickness of the beam [m]
  P side = P(0.265) / (root(width) * root(root(width)));
  P face = P(0.53) * root(thickness) / width;

  template <class S>
  S factor(S h) const {
    return h * h * factor_over_square(h);
  }
  /// Returns the fringing factor over h^2, at the gap h [1/m^2]; computed from h^(-1/4), which a gas film law can share.
  template <class S>
  [[nodiscard, gnu::always_inline]] S factor_over_square(S h) const {
    const S w = inverse_fourth_root(h), w2 = w * w, w4 = w2 * w2;
    return w4 * (w4 + w * (S(side) + S(face) * w));
  }
  template <class S>
  [[nodiscard]] S capacitance_over_eps0(S h) const {
    using std::sqrt;
    return S(width) / h + S(0.77) + S(1.06) * sqrt(sqrt(S(width) / h)) + S(1.06) * sqrt(S(thickness) / h);
  }

 private:
  static P root(const P& x) {
    using std::sqrt;
    return sqrt(x);
  }
};
using MeijsFokkemaFringing = MeijsFokkemaFringingOf<double>;

template <class P>
struct Bao2001FringingOf {
  P width = 0;      ///< width of the beam [m]
  P thickness = 0;  ///< thickness of the beam [m]

  template <class S>
  S factor(S h) const {
    using std::log;
    using std::sqrt;
    const S b = S(thickness) / h;
    return S(1) + h / S(pi * width) * (log(S(pi * width) / h) + log(S(1) + S(2) * b + S(2) * sqrt(b + b * b)));
  }
  [[nodiscard]] double capacitance_over_eps0(double h) const {
    // Integrate (1 + B(s)) / s^2 times the width, B the fringing correction, from h to the gap where both logarithms are 0.
    // With 1 + 2 x + 2 sqrt(x + x^2) = exp(2 asinh sqrt x), the second logarithm gives the integral of u coth u.
    const double u = std::asinh(std::sqrt(thickness / h)), l = std::log(pi * width / h);
    static const GaussRule rule = gauss_rule(30);
    double integral = 0;  // integral of s coth s from 0 to u
    for (std::size_t k = 0; k < rule.points.size(); ++k) {
      const double s = u / 2 * (1 + rule.points[k]);
      integral += u / 2 * rule.weights[k] * (s > 1e-8 ? s / std::tanh(s) : 1);
    }
    return width / h + (l * l / 2 + 4 * integral) / pi;
  }
};
using Bao2001Fringing = Bao2001FringingOf<double>;

using FringingLaw = std::variant<NoFringing, Bao2001Fringing, MeijsFokkemaFringing, LinearFringing>;

enum class Fringing { none, bao_2001, meijs_fokkema, linear };

/// A row of the table of fringing laws: name in a scene, sizes of the moving part that the law needs, and its constructor.
struct FringingRow {
  Fringing value;
  std::string_view name;
  bool needs_width = true;
  bool needs_thickness = false;
  FringingLaw (*make)(double width, double thickness);  ///< creates the law for width and thickness of the moving part [m]
};

inline constexpr auto fringing_laws = std::to_array<FringingRow>({
    {Fringing::none, "none", false, false, [](double width, double) -> FringingLaw { return NoFringing{.width = width}; }},
    {Fringing::bao_2001, "bao-2001", true, true,
     [](double width, double thickness) -> FringingLaw { return Bao2001Fringing{.width = width, .thickness = thickness}; }},
    {Fringing::meijs_fokkema, "meijs-fokkema", true, true,
     [](double width, double thickness) -> FringingLaw { return MeijsFokkemaFringing{.width = width, .thickness = thickness}; }},
    {Fringing::linear, "linear", true, false, [](double width, double) -> FringingLaw { return LinearFringing{.width = width}; }},
});
static_assert(is_complete<fringing_laws>());

}  // namespace softland
