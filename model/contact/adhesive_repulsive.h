// Contact of rough surfaces as a pressure between them that acts before they touch: attraction and an exponential repulsion
// (soft wall) at a distance, adhesion and a stiff repulsion where asperities meet.
//
//   p(x) = l(x) - l(xr) - l'(xr) (x - xr) + c1 [max(0, dc - x) / 1 nm]^1.5 - c3 max(0, dc + ta - x) / 1 nm
//   l(x) = c2 exp(-x / tR) - A / (6 pi (x^3 + ds^3))                        for x < xr, p = 0 beyond
//   P = An p(x0 - d),   U = An integral of p from x0 - d to xr
//
// p is the pressure, positive when it pushes the surfaces apart [Pa]; x distance between their mean planes [m]; P force on the
// beam, away from the contact [N]; U stored energy, 0 beyond reach [J]; An = width x pad length [m^2]; d interference [m]; c1,
// c2, c3 factors of the pressures of asperities, soft wall and adhesion [Pa]; dc distance at which asperities meet [m]; ta
// distance beyond dc at which adhesion begins [m]; tR decay length of the soft wall [m]; A Hamaker constant [J]; ds distance
// that keeps the attraction finite [m]; xr reach, the distance beyond which no pressure acts [m]. The contact plane, d = 0, is
// at the outermost distance x0 within reach at which p vanishes: at larger distances the law only attracts.
//
// The published pressure l(x) extends to infinity. Subtracting its tangent at xr makes force and slope end continuously there
// (with the default, 1 um, the tangent is 1.2 % of the attraction at 150 nm). The law is lossless: jumping into contact and off
// it takes energy through the motion that follows. The force is continuous; its slope jumps at x = dc + ta, its second
// derivative at dc: the integrator restarts at both distances, if they are below x0. Validity: x > 0, and the pair of surfaces
// to which the law was fitted; the defaults are nickel on a dielectric. Source: the contact model of MEMOSA, Purdue's PRISM
// centre (public code of its force models); attraction: Hamaker 1937.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <vector>

#include "base/select.h"
#include "model/constants.h"
#include "model/contact/adhesive_repulsive_surfaces.h"
#include "model/dual.h"

namespace softland {

template <class P>
class AdhesiveRepulsiveContactOf {
 public:
  AdhesiveRepulsiveContactOf() = default;
  /// `area` is that of the pad [m^2], `touch` the distance x0 of the surfaces at first contact [m]. For scalars with
  /// derivatives, a step of Newton's method gives x0 its derivatives.
  AdhesiveRepulsiveContactOf(const SurfacePressureOf<P>& law, const P& area, const P& touch)
      : law_(law), area_(area), end_(far(DualOf<P>(law.reach, 1))), touch_(touch) {
    if constexpr (!std::same_as<P, double>) {
      const DualOf<P> at = pressure(DualOf<P>(touch, 1));
      touch_ = touch - at.value / at.slope;
    }
  }
  AdhesiveRepulsiveContactOf(const SurfacePressureOf<P>& law, const P& area) requires std::same_as<P, double>
      : AdhesiveRepulsiveContactOf(law, area, find_touch(law)) {}

  /// Returns the pressure between the surfaces at distance x within reach of the law [Pa].
  template <class S>
  S pressure(S x) const {
    using std::sqrt;
    const S from_afar = far(x) - S(end_.value) - S(end_.slope) * (x - S(law_.reach));
    const S p = select(
        x < law_.asperity_distance,
        [&]() -> S {
          const S depth = (S(law_.asperity_distance) - x) / S(unit);
          return from_afar + S(law_.asperity_pressure) * depth * sqrt(depth);
        },
        [&] { return from_afar; });
    const P onset = law_.asperity_distance + law_.adhesion_range;
    return select(
        x < onset, [&]() -> S { return p - S(law_.adhesion_pressure / unit) * (S(onset) - x); }, [&] { return p; });
  }
  /// Returns the force of the contact on the beam at interference d [N]; the surfaces must be within reach of the law.
  template <class S>
  S force(S d) const {
    return S(area_) * pressure(S(touch_) - d);
  }
  [[nodiscard]] double energy(double d) const;

  /// Returns the distance x0 of the surfaces' mean planes at first contact, where the pressure vanishes [m].
  [[nodiscard]] const P& touch_distance() const { return touch_; }
  /// Returns the height above the contact plane at which the contact law begins to act [m].
  [[nodiscard]] double reach() const { return law_.reach - touch_; }
  /// Returns the interferences above 0 at which adhesion begins and asperities meet [m]: the integrator restarts there.
  [[nodiscard]] std::vector<double> kinks() const;

 private:
  static constexpr double unit = 1e-9;  // length that divides distances in the formulas of the pressures [m]

  template <class S>
  S far(S x) const {
    using std::exp;
    const P s = law_.smoothing_distance;
    return S(law_.wall_pressure) * exp(-x / S(law_.wall_range)) -
           S(law_.hamaker_constant / (6 * pi)) / (x * x * x + S(s * s * s));
  }

  static double find_touch(const SurfacePressure& law);

  SurfacePressureOf<P> law_ = {};
  P area_ = 0;
  DualOf<P> end_ = P(0);  // published pressure l at the reach xr [Pa], with its slope [Pa/m]
  P touch_ = 0;           // distance x0 of the surfaces at first contact [m]
};
using AdhesiveRepulsiveContact = AdhesiveRepulsiveContactOf<double>;

template <>
double AdhesiveRepulsiveContact::energy(double d) const;
template <>
std::vector<double> AdhesiveRepulsiveContact::kinks() const;
template <>
double AdhesiveRepulsiveContact::find_touch(const SurfacePressure& law);

inline double AdhesiveRepulsiveSurfaces::largest_interference() const {
  return AdhesiveRepulsiveContact(pressure, 1).touch_distance();
}

inline AdhesiveRepulsiveContact AdhesiveRepulsiveSurfaces::law(const ContactPad& pad) const {
  return AdhesiveRepulsiveContact(pressure, pad.width * pad.length);
}

}  // namespace softland
