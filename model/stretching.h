// Stretching of a beam between two clamps: bending makes the beam longer, but its ends are held.
//
//   U = EA/(8 L) (int y'^2 dx)^2         stored energy [J]
//   Q_i = -EA/(2 L) (q'G q) (G q)_i      modal force [N kg^(-1/2)],   G_ij = int phi_i' phi_j' dx,   y = sum phi_i q_i
//
// E is Young's modulus [Pa], A the cross-section [m^2], L the length [m], y the deflection [m], G [1/(kg m)]. The beam's middle
// line is longer than its chord by int y'^2/2 dx; axial motion is quasi-static, so that the tension EA/(2 L) int y'^2 dx is the
// same all along. Stretching is a hardening cubic stiffness: the force that holds the middle one thickness down is 1.7 times
// that of bending alone. E is Young's modulus as given, also with plate_strain: in tension the sides of a beam are free to
// contract. Valid for slopes well below 1 and rigid anchors. Source: Woinowsky-Krieger 1950, J. Appl. Mech. 17, 35-36; Nayfeh &
// Mook, Nonlinear Oscillations, 1979, sec. 7.1.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <vector>

namespace softland {

/// The modal forces of mid-plane stretching. `P` is the scalar type of the parameters; the scalar type S of the state must be
/// constructible from P.
template <class P>
struct MidPlaneStretchingOf {
  std::size_t modes = 0;
  std::vector<P> slopes = {};  ///< integrals of the products of the modes' slopes [1/(kg m)], column by column
  P stiffness = P(0);          ///< half the axial stiffness of the beam, EA/(2 L) [N/m]

  /// Adds the modal forces of stretching to `result`.
  template <class S>
  void add_force(const S* q, S* result) const {
    const S strain = strain_of(q);
    for (std::size_t i = 0; i < modes; ++i) result[i] = result[i] - S(stiffness) * strain * pull(i, q);
  }
  /// Adds the derivatives of the modal forces of stretching by the modal coordinates to `by_q`.
  void add_derivative(const double* q, Eigen::Ref<Eigen::MatrixXd> by_q) const requires std::same_as<P, double> {
    const auto n = static_cast<Eigen::Index>(modes);
    const Eigen::Map<const Eigen::MatrixXd> g(slopes.data(), n, n);
    const Coordinates at(q, n);
    const Eigen::VectorXd pulls = g * at;
    by_q -= stiffness * (at.dot(pulls) * g + 2 * pulls * pulls.transpose());
  }
  /// Adds the second derivatives, by modal coordinates, of the sum of multiplier_i times modal force i to `by_q_q`.
  void add_curvature(const double* q, const double* multipliers,
                     Eigen::Ref<Eigen::MatrixXd> by_q_q) const requires std::same_as<P, double> {
    const auto n = static_cast<Eigen::Index>(modes);
    const Eigen::Map<const Eigen::MatrixXd> g(slopes.data(), n, n);
    const Eigen::VectorXd pulls = g * Coordinates(q, n), weights = g * Coordinates(multipliers, n);
    by_q_q -= 2 * stiffness * (weights.dot(Coordinates(q, n)) * g + pulls * weights.transpose() + weights * pulls.transpose());
  }
  template <class S>
  [[nodiscard]] S energy(const S* q) const {
    const S strain = strain_of(q);
    return S(stiffness) / S(4) * strain * strain;
  }

 private:
  using Coordinates = Eigen::Map<const Eigen::VectorXd>;

  // Returns element i of G q, the product of the matrix of slope products and q; for doubles the compiler handles several terms
  // at once.
  template <class S>
  [[nodiscard]] S pull(std::size_t i, const S* q) const {
    const P* column = slopes.data() + i * modes;
    if constexpr (std::same_as<P, double> && std::same_as<S, double>) {
      const auto n = static_cast<Eigen::Index>(modes);
      return Coordinates(column, n).dot(Coordinates(q, n));
    } else {
      S sum = S(0);
      for (std::size_t j = 0; j < modes; ++j) sum = sum + S(column[j]) * q[j];
      return sum;
    }
  }
  // Returns the integral over the beam of its squared slope [m].
  template <class S>
  [[nodiscard]] S strain_of(const S* q) const {
    S sum = S(0);
    for (std::size_t i = 0; i < modes; ++i) sum = sum + q[i] * pull(i, q);
    return sum;
  }
};
using MidPlaneStretching = MidPlaneStretchingOf<double>;

}  // namespace softland
