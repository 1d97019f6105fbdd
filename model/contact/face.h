// Landing of a beam along the face of the dielectric on its electrodes.
//
//   p = k max(0, d)        U = a k d^2 / 2        d = b - h
//
// p pressure of the face on the beam [Pa], d depth [m], h local gap between beam and face, b height above the face from which the
// pressure acts, k stiffness per area [Pa/m], U energy per length [J/m], a local width [m]. Lossless. Source: textbook, a bed of
// springs (Winkler).
//
// A wall has no growing field below its face. Its k is that at which the field of the voltage 2 V1 sinks the beam in by a
// fiftieth of H = t / eps_r + roughness, the smallest gap of the field: own choice. V1^2 = 8 K g^3 / (27 eps0 A) closes parallel
// plates. K stiffness of the beam at the contact point [N/m], g rest gap of the field, A area of the faces [m^2].
//
// A linear bed lets the field grow on below the face. One that is softer than 27 eps0 V^2 / (8 (H + b)^3) lets it pull the beam
// through, like parallel plates whose springs are at rest where the pressure begins.
#pragma once

#include <algorithm>

#include "base/select.h"
#include "model/constants.h"
#include "model/dual.h"

namespace softland {

/// Stiffness per area of the face of a wall [Pa/m]: K [N/m], g [m], A [m^2], H [m].
[[nodiscard]] constexpr double wall_stiffness(double stiffness, double gap, double area, double depth) {
  constexpr double voltages = 2, sinks = 1.0 / 50;
  const double eps0_square = 8.0 / 27 * stiffness * gap * gap * gap / area * voltages * voltages;  // eps0 V^2
  return eps0_square / (2 * sinks * depth * depth * depth);
}

/// Least stiffness per area that holds a beam off a face under a field [Pa/m]: V [V], H + b [m].
[[nodiscard]] constexpr double least_face_stiffness(double voltage, double depth) {
  return 27.0 / 8 * vacuum_permittivity * voltage * voltage / (depth * depth * depth);
}

/// The pressure of the face on a beam of one width.
struct FacePressure {
  double stiffness = 0;  ///< per length, a k [N/m^2]
  double from = 0;       ///< b [m]
  static constexpr bool driven = false;

  /// [N/m], away from the electrode
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

/// A force of a field that does not grow below the face, where a wall carries the beam.
template <class Law>
struct StopsAtFace {
  Law law;
  static constexpr bool driven = Law::driven;

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
