// Stretching of a beam between two clamps: what bends must grow longer, and is held.
//
//   U = EA/(8 L) (int y'^2 dx)^2         stored energy [J]
//   Q_i = -EA/(2 L) (q'G q) (G q)_i      modal force [N kg^(-1/2)],   G_ij = int phi_i' phi_j' dx,   y = sum phi_i q_i
//
// E Young's modulus [Pa], A cross-section [m^2], L length [m], y deflection [m], G [1/(kg m)]. The beam's middle line is longer
// than its chord by int y'^2/2 dx; axial motion is quasi-static, so that the tension EA/(2 L) int y'^2 dx is the same all along.
// A hardening cubic stiffness: what holds the middle one thickness down is 1.7 times what bending alone asks for. E is Young's
// modulus as given, also with plate_strain: in tension the sides of a beam are free to contract. Valid for slopes well below 1
// and rigid anchors. Source: Woinowsky-Krieger 1950, J. Appl. Mech. 17, 35-36; Nayfeh & Mook, Nonlinear Oscillations, 1979,
// sec. 7.1.
#pragma once

#include <Eigen/Core>

namespace softland {

struct MidPlaneStretching {
  Eigen::MatrixXd slopes;  ///< G [1/(kg m)]
  double stiffness = 0;    ///< EA/(2 L) [N/m]

  using Coordinates = Eigen::Map<const Eigen::VectorXd>;

  /// result += Q
  void add_force(const double* q, double* result) const {
    const Eigen::Index n = slopes.rows();
    double strain = 0;  // q'G q
    for (Eigen::Index i = 0; i < n; ++i) strain += q[i] * slopes.col(i).dot(Coordinates(q, n));
    for (Eigen::Index i = 0; i < n; ++i) result[i] -= stiffness * strain * slopes.col(i).dot(Coordinates(q, n));
  }
  /// by_q += dQ/dq
  void add_derivative(const double* q, Eigen::Ref<Eigen::MatrixXd> by_q) const {
    const Coordinates at(q, slopes.rows());
    const Eigen::VectorXd pull = slopes * at;
    by_q -= stiffness * (at.dot(pull) * slopes + 2 * pull * pull.transpose());
  }
  [[nodiscard]] double energy(const double* q) const {
    const Coordinates at(q, slopes.rows());
    const double strain = at.dot(slopes * at);
    return stiffness / 4 * strain * strain;
  }
};

}  // namespace softland
