// Measures of risk against their definitions.
#include "sampling/risk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace softland::risk_test {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

const std::vector<double> sample{4, 1, 3, 2, 10, 5, 8, 6, 7, 9};

TEST(Risk, OfATenthIsTheWorst) {
  EXPECT_DOUBLE_EQ(risk(sample, {.kind = RiskKind::cvar, .parameter = 0.9}), 10);
  EXPECT_DOUBLE_EQ(risk(sample, {.kind = RiskKind::cvar, .parameter = 0.7}), 9);
  EXPECT_DOUBLE_EQ(risk(sample, {.kind = RiskKind::cvar, .parameter = 0}), 5.5);
  EXPECT_DOUBLE_EQ(risk(sample, {.kind = RiskKind::worst, .parameter = 0}), 10);
}

TEST(Risk, OfAQuantileInterpolates) {
  EXPECT_DOUBLE_EQ(risk(sample, {.kind = RiskKind::quantile, .parameter = 0.5}), 5.5);
  EXPECT_DOUBLE_EQ(risk(sample, {.kind = RiskKind::quantile, .parameter = 1}), 10);
}

TEST(Risk, OfMeanAndDeviation) {
  const double deviation = std::sqrt(82.5 / 9);
  EXPECT_NEAR(risk(sample, {.kind = RiskKind::mean_sigma, .parameter = 2}), 5.5 + 2 * deviation, 1e-12);
  EXPECT_DOUBLE_EQ(risk(sample, {.kind = RiskKind::mean_sigma, .parameter = 0}), 5.5);
  EXPECT_DOUBLE_EQ(risk(std::vector<double>{3}, {.kind = RiskKind::mean_sigma, .parameter = 2}), 3)
      << "one device has no deviation";
}

TEST(Risk, CountsAFailureAsInfinitelyBad) {
  const std::vector<double> one_fails{1, 2, infinite};
  EXPECT_EQ(risk(one_fails, {.kind = RiskKind::worst, .parameter = 0}), infinite);
  EXPECT_EQ(risk(one_fails, {.kind = RiskKind::cvar, .parameter = 0.9}), infinite);
  EXPECT_EQ(risk(one_fails, {.kind = RiskKind::quantile, .parameter = 0.5}), 2);
  EXPECT_EQ(risk(one_fails, {.kind = RiskKind::mean_sigma, .parameter = 2}), infinite);
}

}  // namespace
}  // namespace softland::risk_test
