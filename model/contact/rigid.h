// A rigid stop under a rigid plate: the velocity at the contact plane is reversed at once.
//
//   v+ = -e v-        lost: (1 - e^2) m v-^2 / 2        rest: e v- < sqrt(2 a h_r), a > 0        N = m a at rest
//
// v- and v+ are the velocities towards the stop before and after the impact [m/s]; e restitution, 0 <= e < 1; m moving mass
// [kg]; a acceleration of the plate at the stop by all other forces, towards it [m/s^2]; N force of the stop on the resting
// plate [N].
//
// Under a constant force the rebounds are a geometric series: infinitely many in the finite time (1 + e) / (1 - e) v / a. So a
// rebound that would rise less than h_r = 1e-6 of the contact gap, u^2 / (2 a) under that force, is not simulated. The plate
// loses the remaining velocity and rests on the plane, held there by N, until N would have to pull. An impact has an impulse (1
// + e) m v- but no force. Validity: the impact lasts much shorter than anything else, and e is a property of the pair of
// bodies; for a beam, whose other modes take up energy at every impact, it is not. Source: Newton's law of impact; e.g.
// Brogliato, Nonsmooth Mechanics, 2016, secs. 1.3 and 4.1.
#pragma once

#include <array>
#include <string_view>

#include "base/field.h"
#include "model/contact/summits.h"

namespace softland {

/// The law of a rigid stop. `P` is the scalar type of the parameters; the scalar type of the state must be constructible from
/// P.
template <class P>
struct RigidContactOf {
  P restitution = 0;  ///< coefficient of restitution of an impact

  static constexpr double rest_height = 1e-6;  ///< rebound height, over the contact gap, below which the plate stays at rest

  /// Returns true when a plate that leaves the stop at `speed` [m/s] against `acceleration` [m/s^2] would rebound less than
  /// rest_height times the contact gap, so that it counts as resting.
  [[nodiscard]] static bool rests(double speed, double acceleration, double contact_gap) {
    return acceleration > 0 && speed * speed < 2 * acceleration * rest_height * contact_gap;
  }

  /// Returns 0: a rigid stop has no force as a function of the interference, and stores no energy. The stop acts outside this
  /// law: model/closing.cc keeps the plate above it in a simulation, model/pull_in.cc in equilibria.
  template <class S>
  S force(S) const {
    return S(0);
  }
  [[nodiscard]] double energy(double) const { return 0; }
};
using RigidContact = RigidContactOf<double>;

/// The parameters of a rigid stop in a scene.
struct RigidStop {
  static constexpr std::string_view name = "rigid", not_along_pad = "whose impacts have no force";
  double restitution = 0;  ///< coefficient of restitution of an impact

  static consteval auto fields() {
    using Law = RigidStop;
    // clang-format off
    return std::to_array<Field<Law>>({
        {.key = "restitution", .about = "velocity after an impact over that before", .in = reach<Law, &Law::restitution>, .required = true, .range = below_one},
    });
    // clang-format on
  }
  [[nodiscard]] static constexpr RigidStop example() { return {.restitution = 0.5}; }
  [[nodiscard]] RigidContact law(const ContactPad&) const { return {.restitution = restitution}; }
};

}  // namespace softland
