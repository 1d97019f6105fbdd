// Damping of the beam that does not depend on the gap, as in a lumped model or from a measured quality factor.
//
//   f = -c v                                                                              [N/m], positive towards the electrode
//   c = omega_1 / (Q integral of phi_1^2 dx)                                              where a quality factor is given
//
// c is the damping per length [N s/m^2], v the velocity towards the electrode [m/s], omega_1, phi_1 the first mode, Q its
// quality factor in small free vibration; on a uniform beam c acts on every mode with the same rate c/m. The law ignores the
// gap: near contact its damping is far weaker than that of a gas film. Regular everywhere.
#pragma once

#include <cmath>

#include "model/gas/film.h"

namespace softland {

/// The law of gap-independent damping. `P` is the scalar type of the parameters; the scalar type of the state must be
/// constructible from P.
template <class P>
struct LinearDamperOf {
  P damping = 0;  ///< damping per length of the beam [N s/m^2]
  static constexpr bool drive_depends = false;

  /// Returns the damping load on the beam [N/m].
  template <class S>
  S load(S /*gap*/, S velocity) const {
    return S(-damping) * velocity;
  }
};
using LinearDamper = LinearDamperOf<double>;

/// The parameters of the gap-independent damping in a scene: either the damping or the quality factor.
struct LinearGas {
  static constexpr std::string_view name = "linear";
  double damping = not_given, quality_factor = not_given;

  static consteval auto fields() {
    using Law = LinearGas;
    // clang-format off
    return std::to_array<Field<Law>>({
        {.key = "damping", .unit = "N s/m^2", .about = "constant force per length and velocity [N s/m^2]; of a plate also that of all of it [N s/m]", .in = reach<Law, &Law::damping>, .required = true, .instead_of = "quality_factor", .such_as = "0.1 N s/m^2"},
        {.key = "quality_factor", .about = "of the first mode in small free vibration, instead of damping", .in = reach<Law, &Law::quality_factor>, .required = true, .instead_of = "damping"},
    });
    // clang-format on
  }
  [[nodiscard]] static constexpr LinearGas example() { return {.quality_factor = 5}; }
  [[nodiscard]] LinearDamper law(const Film& f) const {
    return {.damping = std::isnan(damping) ? f.unit_quality / quality_factor : damping};
  }
};

}  // namespace softland
