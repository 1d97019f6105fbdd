// Decompositions of small dense matrices. Every unit that uses Eigen's decompositions takes seconds to compile; these functions
// are compiled once.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace softland {

/// Eigenvalues in rising order, and orthonormal eigenvectors as columns.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Decomposes a symmetric matrix; only its lower triangle is read.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);
/// Decomposes a symmetric tridiagonal matrix: n entries on its diagonal and n - 1 beside the diagonal.
[[nodiscard]] SymmetricEigen tridiagonal_eigen(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside);
/// Returns the eigenvalues k of stiffness x = k mass x, in rising order; both matrices are symmetric, `mass` is positive
/// definite.
[[nodiscard]] Eigen::VectorXd generalized_eigenvalues(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass);

/// Returns an orthonormal basis of all vectors that are orthogonal to the columns of `held`, as columns. The columns of `held`
/// must be linearly independent, and fewer than its rows.
[[nodiscard]] Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& held);

/// Returns the lower triangular L with L L^T = matrix, which is symmetric and positive definite.
[[nodiscard]] Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& matrix);
/// Returns the x with matrix x = right; none where the symmetric matrix is not positive definite.
[[nodiscard]] std::optional<Eigen::VectorXd> solve_definite(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
/// Returns combinations of the columns of `basis` that are orthonormal in an energy, for which `energy` is the symmetric matrix
/// of the energies between the columns. Returns none when `energy` is not positive definite.
[[nodiscard]] std::optional<Eigen::MatrixXd> orthonormal_in(const Eigen::MatrixXd& energy, const Eigen::MatrixXd& basis);

/// Returns the x with matrix x = right, for a symmetric matrix that is positive definite up to rounding.
[[nodiscard]] Eigen::VectorXd solve_semidefinite(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
/// Returns the least-squares solutions x of matrix x = right, one for each column of `right`. When the columns of `matrix` are
/// linearly dependent, the components of x that the equations do not determine are 0.
[[nodiscard]] Eigen::MatrixXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// Returns the x with matrix x = right, by elimination with partial pivoting; not finite where the matrix is singular.
[[nodiscard]] Eigen::VectorXd solve_linear(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

}  // namespace softland
