// Electrostatic force between beam and electrode, per length and per volt squared, with the field that fringes at the sides of
// the beam.
//
//   f(h) = eps0 a phi(h) / (2 h^2)         [N / (m V^2)], positive towards the electrode
//   c(h) with f = -c'(h) / 2               [F/m], the capacitance per length that belongs to this force
//
// h is the local gap [m], a the width [m]; phi is the fringing factor; phi and c follow from the fringing law
// (model/forces/fringing.h).
#pragma once

#include "model/constants.h"
#include "model/device.h"
#include "model/forces/fringing.h"

namespace softland {

template <class Law>
struct ElectrostaticForce {
  Law fringing;
  static constexpr bool drive_depends = true;

  /// Returns the load of the electrode on the beam per volt squared [N / (m V^2)].
  template <class S>
  [[gnu::always_inline]] S load(S gap, S /*velocity*/) const {
    const S plane = S(0.5 * vacuum_permittivity * fringing.width);
    if constexpr (requires { fringing.factor_over_square(gap); }) {
      return plane * fringing.factor_over_square(gap);
    } else {
      return plane / (gap * gap) * fringing.factor(gap);
    }
  }
  /// Returns the capacitance between beam and electrode per length [F/m].
  template <class S>
  [[nodiscard]] S capacitance(S gap) const {
    return S(vacuum_permittivity) * fringing.capacitance_over_eps0(gap);
  }
  /// Returns the electric potential energy at constant voltage, per length and per volt squared [J / (m V^2)].
  [[nodiscard]] double potential(double gap) const { return -capacitance(gap) / 2; }
};

/// The electrostatic force through a dielectric on the electrode. The dielectric counts as an additional air gap `depth`, so
/// the force law is evaluated at h + depth, where h is the local gap to the dielectric's face.
template <class Law>
struct ThroughDielectric {
  Law law;
  double depth = 0;  ///< thickness of air that is electrically equivalent to the dielectric, Dielectric::depth() [m]
  static constexpr bool drive_depends = Law::drive_depends;

  template <class S>
  [[gnu::always_inline]] S load(S gap, S velocity) const {
    return law.load(gap + S(depth), velocity);
  }
  [[nodiscard]] double potential(double gap) const { return law.potential(gap + depth); }
};

}  // namespace softland
