#include "integrators/arrow.h"

#include <gtest/gtest.h>

#include <random>

namespace softland {
namespace {

TEST(ArrowEquations, AreSolvedAsADenseMatrixIs) {
  constexpr Eigen::Index core = 6, block = 3, size = 18;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return uniform(random); });
  for (Eigen::Index i = core; i < size; ++i) {
    for (Eigen::Index j = core; j < size; ++j) {
      if ((i - core) / block != (j - core) / block) a(i, j) = 0;
    }
  }
  ArrowEquations arrow(size, core, block);
  const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(random); });
  Eigen::VectorXd x = b;
  ASSERT_TRUE(arrow.factor(a.data()));
  arrow.solve(x.data());
  EXPECT_LT((a * x - b).cwiseAbs().maxCoeff(), 1e-12);
  a.block(core, core, block, block).setZero();
  EXPECT_FALSE(arrow.factor(a.data()));
}

}  // namespace
}  // namespace softland
