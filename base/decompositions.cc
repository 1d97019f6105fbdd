#include "base/decompositions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace softland {

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricEigen tridiagonal_eigen(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd generalized_eigenvalues(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness, mass, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& held) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(held);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(held.rows(), held.rows());
  return q.rightCols(held.rows() - held.cols());
}

Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& matrix) { return matrix.llt().matrixL(); }

std::optional<Eigen::VectorXd> solve_definite(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  const Eigen::LLT<Eigen::MatrixXd> factors(matrix);
  if (factors.info() != Eigen::Success) return std::nullopt;
  return factors.solve(right);
}

std::optional<Eigen::MatrixXd> orthonormal_in(const Eigen::MatrixXd& energy, const Eigen::MatrixXd& basis) {
  const Eigen::LLT<Eigen::MatrixXd> root(energy);
  if (root.info() != Eigen::Success) return std::nullopt;
  return root.matrixU().solve<Eigen::OnTheRight>(basis);
}

Eigen::VectorXd solve_semidefinite(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.ldlt().solve(right);
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Eigen::VectorXd solve_linear(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.partialPivLu().solve(right);
}

}  // namespace softland
