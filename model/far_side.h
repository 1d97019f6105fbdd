// A force law on the far side of the moving part, where the gap grows as the gap on the near side closes.
//
//   f(h, v) = -law(H - h, -v)       H = d0 + d_far
//
// h is the local gap on the near side [m], v the velocity towards the near side [m/s], d0 and d_far the rest gaps of both sides
// [m]. Below the far gap `floor`, at which a run ends, the law is continued by its tangent. A law that depends on the velocity
// must be linear in it.
#pragma once

#include "model/dual.h"

namespace softland {

template <class Law, class P = double>
struct FarSide {
  Law law = {};
  P both_gaps = 0;  ///< sum of the gaps at rest on both sides of the moving part [m]
  P floor = 0;      ///< gap on the far side below which the law is continued by its tangent [m]
  /// Value and slope of the force law at the gap `floor`, for a velocity of 1 m/s: the tangent that continues the law.
  DualOf<P> at_floor = law.load(DualOf<P>(floor, 1), DualOf<P>(1));
  static constexpr bool drive_depends = Law::drive_depends;

  /// Returns the load of the force law on the far side [N/m], positive towards the near side; for a law that a drive scales,
  /// the load at unit strength of the drive.
  template <class S>
  S load(S gap, S velocity) const {
    const S far = S(both_gaps) - gap;
    return select(
        far < floor,
        [&]() -> S {
          const S tangent = S(at_floor.value) + S(at_floor.slope) * (far - S(floor));
          return drive_depends ? -tangent : tangent * velocity;
        },
        [&]() -> S { return -law.load(far, -velocity); });
  }
  /// Returns the potential per length of the force law on the far side [J/m] at unit strength of the drive. Below the gap
  /// `floor` it is the parabola whose slope is the tangent.
  [[nodiscard]] double potential(double gap) const requires(Law::drive_depends) {
    const double far = both_gaps - gap, below = far - floor;
    if (below >= 0) return law.potential(far);
    return law.potential(floor) + (at_floor.value + at_floor.slope * below / 2) * below;
  }
};

/// The force law of one electrode that acts on both sides of the moving part.
template <class Law, class P = double>
struct BothSides {
  Law near = {};
  FarSide<Law, P> far = {};
  static constexpr bool drive_depends = Law::drive_depends;

  template <class S>
  S load(S gap, S velocity) const {
    return near.load(gap, velocity) + far.load(gap, velocity);
  }
  [[nodiscard]] double potential(double gap) const { return near.potential(gap) + far.potential(gap); }
};

}  // namespace softland
