// Decompositions of small dense matrices. Eigen makes the code of each anew in every unit that names its class, which takes
// seconds: here it is made once.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace softland {

/// Eigenvalues in rising order, and orthonormal eigenvectors as columns.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Of a symmetric matrix, whose lower triangle is looked at.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);
/// Of a symmetric tridiagonal matrix: n entries on its diagonal and n - 1 beside it.
[[nodiscard]] SymmetricEigen tridiagonal_eigen(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside);
/// The k in rising order for which stiffness x = k mass x, of symmetric matrices, the second positive definite.
[[nodiscard]] Eigen::VectorXd generalized_eigenvalues(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass);

/// Orthonormal columns that are orthogonal to those of `held`, which are fewer than its rows and independent.
[[nodiscard]] Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& held);

/// The lower triangular L with L L^T = matrix, which is symmetric and positive definite.
[[nodiscard]] Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& matrix);
/// The x with matrix x = right; none where the symmetric matrix is not positive definite.
[[nodiscard]] std::optional<Eigen::VectorXd> solve_definite(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
/// The columns of `basis` combined so that an energy, whose matrix between them this is, finds them orthonormal; none where it is
/// not positive definite.
[[nodiscard]] std::optional<Eigen::MatrixXd> orthonormal_in(const Eigen::MatrixXd& energy, const Eigen::MatrixXd& basis);

/// The x with matrix x = right, of a symmetric matrix that is positive definite but for rounding.
[[nodiscard]] Eigen::VectorXd solve_semidefinite(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
/// The x with the least squares of matrix x - right, column by column; unknowns that the matrix does not determine are 0.
[[nodiscard]] Eigen::MatrixXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// The x with matrix x = right, by elimination with partial pivoting; not finite where the matrix is singular.
[[nodiscard]] Eigen::VectorXd solve_linear(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

}  // namespace softland
