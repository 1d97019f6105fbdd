// Contact law of a spring under the contact point.
//
//   P = k d        U = k d^2 / 2
//
// P is the force on the beam, away from the contact [N]; d interference [m]; k stiffness [N/m]; U stored energy [J]. The law is
// lossless. Validity: any d; for d < 0 the same formula continues smoothly, where an integrator evaluates it before it locates
// the end of contact. Source: McCarthy et al. 2002.
#pragma once

#include <array>
#include <cmath>
#include <string_view>
#include <variant>

#include "base/field.h"
#include "model/contact/hunt_crossley.h"
#include "model/contact/summits.h"

namespace softland {

/// The contact law of a spring. `P` is the scalar type of the parameters; the scalar type of the state must be constructible
/// from P.
template <class P>
struct LinearContactOf {
  P stiffness = 0;  ///< stiffness of the contact spring [N/m]

  static constexpr bool grows_with_depth = true;  ///< the contact force is largest where the contact is deepest

  template <class S>
  S force(S d) const {
    return S(stiffness) * d;
  }
  /// Returns the interference at which the spring exerts this force [m].
  [[nodiscard]] double interference(double force) const { return force / stiffness; }
  [[nodiscard]] double energy(double d) const { return stiffness * d * d / 2; }
  /// Returns the interference at which the spring stores this energy [m].
  [[nodiscard]] double interference_of_energy(double energy) const { return std::sqrt(2 * energy / stiffness); }
};
using LinearContact = LinearContactOf<double>;

/// The parameters of a contact spring in a scene.
struct LinearSpring {
  static constexpr std::string_view name = "linear";
  double stiffness = 0;  ///< stiffness of the contact spring [N/m]
  double damping = 0;    ///< damping constant of the contact (Hunt and Crossley) [s/m]

  static consteval auto fields() {
    using Law = LinearSpring;
    // clang-format off
    return joined(std::to_array<Field<Law>>({
        {.key = "stiffness", .unit = "N/m", .about = "contact force per penetration; hysteretic: while loading", .in = reach<Law, &Law::stiffness>, .required = true},
    }), damping_fields<Law>());
    // clang-format on
  }
  [[nodiscard]] static constexpr LinearSpring example() { return {.stiffness = 1e4}; }
  [[nodiscard]] std::variant<LinearContact, HuntCrossley<LinearContact>> law(const ContactPad& pad) const {
    return damped(LinearContact{.stiffness = stiffness * pad.count}, damping);
  }
};

}  // namespace softland
