// Tests the prediction for the next device of a wafer from tuned ones, with simple beliefs.
#include "studies/inverse/wafer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "base/require.h"

namespace softland::wafer_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Eigen::Index size = 3;
const NormalBelief standard{.mean = VectorXd::Zero(size), .covariance = MatrixXd::Identity(size, size)};

// A belief in which the first coordinate is known.
TunedBelief known(double value, const NormalBelief& prior = standard) {
  constexpr double variance = 1e-4;
  TunedBelief tuned{.prior = prior, .posterior = prior};
  tuned.posterior.mean[0] = value;
  tuned.posterior.covariance(0, 0) = variance;
  return tuned;
}

TEST(Wafer, OfNothingIsTheSpread) {
  const WaferBelief wafer = believed_of_wafer({}, size);
  EXPECT_LT(wafer.next.mean.norm(), 1e-12);
  EXPECT_LT((wafer.next.covariance - standard.covariance).norm(), 1e-12);
  const std::vector<TunedBelief> idle{{.prior = standard, .posterior = standard}};
  EXPECT_LT((believed_of_wafer(idle, size).next.covariance - standard.covariance).norm(), 1e-12) << "it was told nothing";
}

TEST(Wafer, OfSimilarDevicesPredictsTheNext) {
  const std::vector<TunedBelief> alike(12, known(1.5));
  const WaferBelief wafer = believed_of_wafer(alike, size);
  EXPECT_GT(wafer.share, 0.9);
  EXPECT_NEAR(wafer.next.mean[0], 1.5, 0.1);
  EXPECT_LT(wafer.next.covariance(0, 0), 0.1);
  EXPECT_NEAR(wafer.next.covariance(1, 1), 1, 1e-12) << "nothing was told of it";
  EXPECT_NEAR(wafer.next.mean[1], 0, 1e-12);
}

TEST(Wafer, OfDevicesThatDifferAsTheSpreadPredictsLittle) {
  std::vector<TunedBelief> apart;
  for (std::uint64_t k = 0; k < 40; ++k) apart.push_back(known(random_normal(5, Stream::practice_device, k)));
  const WaferBelief wafer = believed_of_wafer(apart, size);
  EXPECT_LT(wafer.share, 0.35);
  EXPECT_GT(wafer.next.covariance(0, 0), 0.7);
}

// With a given rho and one measurement the next device is at rho times the measured value.
TEST(Wafer, OfOneDeviceCountsByTheShareOfTheWafer) {
  const std::vector<TunedBelief> one{known(1)};
  const WaferBelief wafer = believed_of_wafer(one, size);
  // The mean of 1 - 0.03^(2 s) over s from 0 to 1; the trapezoidal rule of the grid agrees with it except at the ends.
  const double mean = 1 - (1 - std::pow(0.03, 2)) / (-2 * std::log(0.03));
  EXPECT_NEAR(wafer.share, mean, 0.02) << "one device does not tell the share";
  EXPECT_NEAR(wafer.next.mean[0], wafer.share, 1e-3);
}

// The prior of a device is not part of its measurement.
TEST(Wafer, DoesNotCountAPriorTwice) {
  const WaferBelief first = believed_of_wafer(std::vector(1, known(1.0)), size);
  const TunedBelief second = known(1.2, first.next);
  const std::vector<TunedBelief> both{known(1.0), second}, apart{known(1.0), known(1.2)};
  EXPECT_NEAR(believed_of_wafer(both, size).next.mean[0], believed_of_wafer(apart, size).next.mean[0], 1e-3);
  EXPECT_NEAR(believed_of_wafer(both, size).share, believed_of_wafer(apart, size).share, 1e-3);
}

TEST(Wafer, RefusesInvalidBeliefs) {
  EXPECT_THROW(static_cast<void>(believed_of_wafer(std::vector(1, known(1)), size + 1)), InvalidInput);
  TunedBelief flat = known(1);
  flat.posterior.covariance(1, 1) = 0;
  EXPECT_THROW(static_cast<void>(believed_of_wafer(std::vector(1, flat), size)), InvalidInput);
}

}  // namespace
}  // namespace softland::wafer_test
