// A spring under the contact point.
//
//   P = k d        U = k d^2 / 2
//
// P force on the beam, away from the contact [N]; d interference [m]; k stiffness [N/m]; U stored energy [J]. Lossless. Validity:
// any d; for d < 0 the law is its own smooth continuation past the event that ends contact. Source: McCarthy et al. 2002.
#pragma once

namespace softland {

/// Over the scalar of its parameters; that of the state is one they convert to.
template <class P>
struct LinearContactOf {
  P stiffness = 0;  ///< [N/m]

  template <class S>
  S force(S d) const {
    return S(stiffness) * d;
  }
  /// Interference that carries a force [m]
  [[nodiscard]] double interference(double force) const { return force / stiffness; }
  [[nodiscard]] double energy(double d) const { return stiffness * d * d / 2; }
};
using LinearContact = LinearContactOf<double>;

}  // namespace softland
