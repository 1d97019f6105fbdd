// Gauss-Legendre points and weights on [-1, 1] for any order: the tables of the libraries stop at fixed orders.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

namespace softland {

struct GaussRule {
  std::vector<double> points, weights;
};

/// n points, exact for polynomials of degree 2 n - 1 (Golub & Welsch 1969: eigenvalues of the Jacobi matrix).
[[nodiscard]] inline GaussRule gauss_rule(int n) {
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n), off(n > 1 ? n - 1 : 0);
  for (int k = 1; k < n; ++k) off[k - 1] = k / std::sqrt(4.0 * k * k - 1);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off);
  GaussRule rule;
  for (int i = 0; i < n; ++i) {
    rule.points.push_back(solver.eigenvalues()[i]);
    rule.weights.push_back(2 * solver.eigenvectors()(0, i) * solver.eigenvectors()(0, i));
  }
  return rule;
}

}  // namespace softland
