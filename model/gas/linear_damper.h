// Damping that does not depend on the gap: what a lumped model or a measured quality factor gives.
//
//   f = -c v                                                                              [N/m], positive towards the electrode
//   c = omega_1 / (Q integral of phi_1^2 dx)                                              where a quality factor is given
//
// c damping per length [N s/m^2], v velocity towards the electrode [m/s], omega_1, phi_1 first mode, Q its quality factor in
// small free vibration; on a uniform beam c acts on every mode with the same rate c/m. Says nothing of the gap: far too weak near
// contact where a film would act. Regular everywhere.
#pragma once

namespace softland {

/// Over the scalar of its parameters; that of the state is one they convert to.
template <class P>
struct LinearDamperOf {
  P damping = 0;  ///< c [N s/m^2]
  static constexpr bool driven = false;

  /// [N/m]
  template <class S>
  S load(S /*gap*/, S velocity) const {
    return S(-damping) * velocity;
  }
};
using LinearDamper = LinearDamperOf<double>;

}  // namespace softland
