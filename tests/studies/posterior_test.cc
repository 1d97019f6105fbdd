// The belief about a device: weighted points and normal distributions.
#include "studies/inverse/posterior.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

namespace softland::posterior_test {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double rounding = 1e-14;  // numbers of the order of 1 are rounded by less

Matrix2d covariance() { return Matrix2d{{4, 1.2}, {1.2, 1}}; }

TEST(Posterior, WeightsFollowTheLogarithmsWhateverTheirSize) {
  constexpr double of_logarithms = 2e-12;  // rounding of numbers of the order of 2000
  const std::vector<double> logarithms{-2000, -2000 + std::log(3)};
  const Weights weights = weights_of(logarithms);
  EXPECT_NEAR(weights.values[0], 0.25, of_logarithms);
  EXPECT_NEAR(weights.values[1], 0.75, of_logarithms);
  EXPECT_NEAR(weights.effective, 1 / (0.25 * 0.25 + 0.75 * 0.75), of_logarithms);
  EXPECT_NEAR(weights_of(logarithms, 0).effective, 2, of_logarithms) << "a power of 0 makes all weights equal";
}

TEST(Posterior, MomentsOfTwoPointsAreThoseOfTheirFormula) {
  const std::vector<double> weights{0.25, 0.75};
  const std::vector<VectorXd> points{Vector2d(-3, 0), Vector2d(1, 8)};
  const NormalBelief found = moments_of(weights, points);
  const Vector2d apart = points[1] - points[0];
  EXPECT_LT((found.mean - Vector2d(0, 6)).norm(), rounding);
  EXPECT_LT((found.covariance - 0.25 * 0.75 * apart * apart.transpose()).norm(), 10 * rounding);
}

TEST(Posterior, AMixtureAddsTheCovarianceOfItsPartsToThatOfTheirMeans) {
  const std::vector<double> weights{0.25, 0.75};
  const std::vector<VectorXd> means{Vector2d(-3, 0), Vector2d(1, 8)};
  const std::vector<NormalBelief> parts{{.mean = means[0], .covariance = covariance()},
                                        {.mean = means[1], .covariance = covariance()}};
  const MatrixXd added = moments_of(weights, parts).covariance - moments_of(weights, means).covariance;
  EXPECT_LT((added - covariance()).norm(), 10 * rounding);
}

TEST(Posterior, WhiteningUndoesAMapOfTheStandardDistribution) {
  const MatrixXd whitening = whitening_of(covariance());
  const NormalBelief standard = NormalBelief::standard(2);
  const NormalBelief mapped = standard.mapped(Vector2d(1, 2), whitening.inverse());
  EXPECT_LT((mapped.mean - Vector2d(1, 2)).norm(), rounding);
  EXPECT_LT((mapped.covariance - covariance()).norm(), 10 * rounding);
  EXPECT_NEAR(mapped.deviation(0), 2, rounding);
  EXPECT_LT((mapped.mapped(VectorXd::Zero(2), whitening).covariance - standard.covariance).norm(), 10 * rounding);
}

TEST(Posterior, CorrelationsHaveNoUnits) {
  const MatrixXd correlation = correlation_of(covariance());
  EXPECT_LT((correlation - Matrix2d{{1, 0.6}, {0.6, 1}}).norm(), rounding);
}

}  // namespace
}  // namespace softland::posterior_test
