// Contact of a beam along the whole face of the dielectric on its electrodes: laws `wall`, `linear` (springs) and
// `asperity-uniform`.
//
//   wall, linear       p = k max(0, d)        U = a k d^2 / 2        d = b - h
//   asperity-uniform   p and U / a are force and energy per area An of model/contact/asperity_uniform.h; b = Hm
//
// p is the pressure of the face on the beam [Pa], d depth [m], h local gap between beam and face, b height above the face from
// which the pressure acts, k stiffness per area [Pa/m], U energy per length [J/m], a local width [m]. The law is lossless.
// Source: textbook, a bed of springs (Winkler), and for asperities the source of their law. The asperities stand on the face,
// with heights up to Hm above it: the beam touches the highest asperity at h = Hm.
//
// For a `wall`, the electric field does not grow when the beam sinks below the face. The k of a wall is such that the field of
// the voltage 2 V1 presses the beam in by a fiftieth of H = t / eps_r + roughness (dielectric thickness t), the smallest
// effective gap of the field; this is our choice. V1, with V1^2 = 8 K g^3 / (27 eps0 A), is the pull-in voltage of parallel
// plates. K is the stiffness of the beam at the contact point [N/m], g the rest gap of the field, A the area of the faces
// [m^2].
//
// For `linear`, the field keeps growing when the beam sinks in. The beam collapses onto the electrode if k is below 27 eps0 V^2
// / (8 (H + b)^3): the limit for parallel plates whose suspension is relaxed where the pressure begins. Asperities keep these
// parallel plates apart up to a voltage V:
//
//   eps0 V^2 / 2 = max over d of p(d) (H + b - d)^2
//
// The product p(d) (H + b - d)^2 has one maximum: p / p' is two thirds of the mean depth of the summits in contact, weighted
// with the root of the depth, and grows with d, while H + b - d falls. Derived here.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/select.h"
#include "model/constants.h"
#include "model/contact/asperity_uniform.h"
#include "model/dual.h"

namespace softland {

/// Returns the stiffness per area of a dielectric's face with the law `wall` [Pa/m]. `stiffness` is that of the beam at the
/// contact point [N/m]. `gap` is the rest gap of the field [m], `area` its area [m^2], `depth` its smallest effective gap [m].
[[nodiscard]] constexpr double wall_stiffness(double stiffness, double gap, double area, double depth) {
  constexpr double voltages = 2, sinks = 1.0 / 50;
  // Vacuum permittivity times the square of twice the pull-in voltage of parallel plates [N].
  const double eps0_square = 8.0 / 27 * stiffness * gap * gap * gap / area * voltages * voltages;
  return eps0_square / (2 * sinks * depth * depth * depth);
}

/// Returns the least stiffness per area at which springs on the dielectric (law `linear`) keep a beam off the electrode [Pa/m].
/// `depth` is the height at which the springs begin plus the smallest effective gap of the field [m].
[[nodiscard]] constexpr double least_face_stiffness(double voltage, double depth) {
  return 27.0 / 8 * vacuum_permittivity * voltage * voltage / (depth * depth * depth);
}

/// Returns the voltage [V] up to which the pressure of a dielectric's face keeps parallel plates apart. Their suspension is
/// taken as relaxed at the height at which the pressure begins. `pressure` is a law of elastic contact per area. `depth` [m] is
/// the sum of the height at which the pressure begins and the smallest effective gap of the field.
template <class Law>
[[nodiscard]] double most_face_voltage(const Law& pressure, double depth) {
  double low = 0, high = depth;  // bounds of the depth at which pressure times squared gap is largest [m]
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    const Dual at = pressure.force(Dual(middle, 1));
    (at.slope * (depth - middle) > 2 * at.value ? low : high) = middle;
  }
  return (depth - low) * std::sqrt(2 * pressure.force(low) / vacuum_permittivity);
}

/// The force law of a dielectric's face with asperities, which presses on a beam of constant width.
struct RoughFacePressure {
  UniformAsperityContact asperities;  ///< law of the face's asperities, per length of the beam
  static constexpr bool drive_depends = false;

  /// Returns the load of the face on the beam [N/m], away from the electrode.
  template <class S>
  [[gnu::always_inline]] S load(S gap, S /*velocity*/) const {
    const S depth = S(asperities.height) - gap;
    return select(
        depth > 0, [&] { return -asperities.force(depth); }, [] { return S(0); });
  }
  [[nodiscard]] double potential(double gap) const { return asperities.energy(std::max(0.0, asperities.height - gap)); }
};

/// The force law of a dielectric's face as springs (`wall` or `linear`), which press on a beam of constant width.
struct FacePressure {
  double stiffness = 0;  ///< stiffness of the face per area, times the beam's width [N/m^2]
  double from = 0;       ///< height above the dielectric's face at which the pressure begins [m]
  static constexpr bool drive_depends = false;

  /// Returns the load of the face on the beam [N/m], away from the electrode.
  template <class S>
  [[gnu::always_inline]] S load(S gap, S /*velocity*/) const {
    const S depth = S(from) - gap;
    return select(
        depth > 0, [&] { return S(-stiffness) * depth; }, [] { return S(0); });
  }
  [[nodiscard]] double potential(double gap) const {
    const double depth = std::max(0.0, from - gap);
    return stiffness * depth * depth / 2;
  }
};

/// An electrode's force law above a dielectric with the contact law `wall`: once the beam is below the face, the electric field
/// is that at the face.
template <class Law>
struct StopsAtFace {
  Law law;
  static constexpr bool drive_depends = Law::drive_depends;

  template <class S>
  [[gnu::always_inline]] S load(S gap, S velocity) const {
    return law.load(select(
                        gap > 0, [&] { return gap; }, [] { return S(0); }),
                    velocity);
  }
  [[nodiscard]] double potential(double gap) const {
    return gap > 0 ? law.potential(gap) : law.potential(0) + gap * law.load(0.0, 0.0);
  }
};

}  // namespace softland
