// Converts between modal coordinates and one position on the beam, as templates over the scalars of the state and of the mode
// shapes.
//
//   y(x) = sum over modes of phi_i(x) q_i        Q_i += phi_i(x) F
//
// phi are mass-normalised modes [kg^(-1/2)], q modal coordinates [m kg^(1/2)], y is the deflection [m], F the force at x [N],
// or load per length times a quadrature weight, Q the modal force [N kg^(-1/2)]. For one device, switch.cc does both for many
// positions at once, one per SIMD lane. The templates here serve dual numbers, and several devices at once, one per SIMD lane.
#pragma once

#include <cstddef>
#include <span>

namespace softland {

/// Returns the deflection of the beam at a position from modal coordinates, or the velocity from their rates.
template <class P, class S>
[[nodiscard]] S deflection(std::span<const P> shape, const S* q) {
  S sum = S(0);
  for (std::size_t i = 0; i < shape.size(); ++i) sum = sum + S(shape[i]) * q[i];
  return sum;
}

/// Adds the contribution of a force at one position on the beam to every modal force.
template <class P, class S>
void add_modal_force(std::span<const P> shape, const S& force, S* modal) {
  for (std::size_t i = 0; i < shape.size(); ++i) modal[i] = modal[i] + S(shape[i]) * force;
}

}  // namespace softland
