// Decompositions against their definitions.
#include "base/decompositions.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <optional>

namespace softland::decompositions_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rounding = 1e-13;  // error for matrices of order 1 and size 3

const MatrixXd definite = (MatrixXd(3, 3) << 4, 1, 0.5, 1, 3, -0.25, 0.5, -0.25, 2).finished();
const VectorXd right = (VectorXd(3) << 1, -2, 0.5).finished();

TEST(Decompositions, OfASymmetricMatrixGiveItBack) {
  const SymmetricEigen eigen = symmetric_eigen(definite);
  EXPECT_TRUE((eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose()).isApprox(definite, rounding));
  EXPECT_LT(eigen.values[0], eigen.values[1]);
  EXPECT_LT(eigen.values[1], eigen.values[2]);
  const MatrixXd factor = cholesky_factor(definite);
  EXPECT_TRUE((factor * factor.transpose()).isApprox(definite, rounding));
}

TEST(Decompositions, SolveLinearSystems) {
  MatrixXd unsymmetric = definite;
  unsymmetric(0, 2) = -3;
  EXPECT_TRUE((unsymmetric * solve_linear(unsymmetric, right)).isApprox(right, rounding));
  const std::optional<VectorXd> solved = solve_definite(definite, right);
  ASSERT_TRUE(solved.has_value());
  EXPECT_TRUE((definite * *solved).isApprox(right, rounding));
}

TEST(Decompositions, FitAnOverdeterminedSystemByLeastSquares) {
  EXPECT_TRUE((definite * solve_semidefinite(definite, right)).isApprox(right, rounding));
  MatrixXd tall(5, 2);
  tall << 1, 0, 1, 1, 1, 2, 1, 3, 1, 5;
  const VectorXd heights = (VectorXd(5) << 1, 2, 2, 5, 4).finished();
  const VectorXd left = tall * least_squares(tall, heights) - heights;
  EXPECT_LT((tall.transpose() * left).norm(), 1e2 * rounding);  // the residual is orthogonal to every column
  MatrixXd twice(5, 2);
  twice << tall.col(1), tall.col(1);
  EXPECT_LT((twice.transpose() * (twice * least_squares(twice, heights) - heights)).norm(), 1e2 * rounding);
}

TEST(Decompositions, RefuseAMatrixThatIsNotDefinite) {
  MatrixXd saddle = definite;
  saddle(2, 2) = -2;
  EXPECT_FALSE(solve_definite(saddle, right).has_value());
  EXPECT_FALSE(orthonormal_in(saddle, MatrixXd::Identity(3, 3)).has_value());
}

TEST(Decompositions, OfTwoMatricesSatisfyTheirDeterminant) {
  MatrixXd other = MatrixXd::Identity(3, 3);
  other(0, 0) = 2;
  const VectorXd values = generalized_eigenvalues(definite, other);
  for (const double k : values)
    EXPECT_LT(std::abs((definite - k * other).determinant()), 1e-11) << k;  // the determinant has terms of order 50
}

TEST(Decompositions, MakeBasesOrthonormal) {
  const std::optional<MatrixXd> basis = orthonormal_in(definite, MatrixXd::Identity(3, 3));
  ASSERT_TRUE(basis.has_value());
  EXPECT_TRUE((basis->transpose() * definite * *basis).isApprox(MatrixXd::Identity(3, 3), rounding));
  const MatrixXd held = definite.leftCols(1), rest = orthogonal_complement(held);
  ASSERT_EQ(rest.cols(), 2);
  EXPECT_LT((held.transpose() * rest).norm(), rounding);
  EXPECT_TRUE((rest.transpose() * rest).isApprox(MatrixXd::Identity(2, 2), rounding));
}

}  // namespace
}  // namespace softland::decompositions_test
