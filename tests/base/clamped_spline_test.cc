// The spline with a clamped end: what it reproduces exactly, and the order of its error.
#include "base/clamped_spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/require.h"

namespace softland {
namespace {

constexpr double rounding = 1e-14;

TEST(ClampedSpline, IsTheCubicThatAClampedBeamBendsInUnderAForceAtItsEnd) {
  const auto beam = [](double x) { return x * x * (3 - x); };  // s'(0) = 0, s''(1) = 0
  const std::vector<double> x{0, 0.2, 0.35, 0.7, 1};
  std::vector<double> y;
  for (const double at : x) y.push_back(beam(at));
  const ClampedSpline s(x, y);
  for (double at = 0; at <= 1; at += 0.01) {
    EXPECT_NEAR(s.value(at), beam(at), rounding);
    EXPECT_NEAR(s.slope(at), 6 * at - 3 * at * at, 10 * rounding);
  }
  EXPECT_NEAR(s.integral_of_square(), 33.0 / 35, rounding) << "of x^4 (9 - 6 x + x^2)";
}

TEST(ClampedSpline, KeepsValueAndSlopeOfTheClampWhateverThePoints) {
  const ClampedSpline s({0, 1, 2, 3}, {0, 5, -7, 2});
  EXPECT_EQ(s.value(0), 0);
  EXPECT_NEAR(s.slope(0), 0, rounding * 10);
  for (const double at : {1.0, 2.0, 3.0}) EXPECT_NEAR(s.value(at), at == 1 ? 5 : at == 2 ? -7 : 2, 10 * rounding);
}

// The first mode of a cantilever meets both end conditions, so that the error has fourth order. A natural spline has second
// order at the clamp.
TEST(ClampedSpline, HasAnErrorOfFourthOrderForTheModeOfACantilever) {
  constexpr double root = 4.694091132974174;
  const double sigma = (std::cosh(root) + std::cos(root)) / (std::sinh(root) + std::sin(root));
  const auto mode = [&](double x) {
    return std::cosh(root * x) - std::cos(root * x) - sigma * (std::sinh(root * x) - std::sin(root * x));
  };
  const auto error = [&](int parts) {
    std::vector<double> x, y;
    for (int i = 0; i <= parts; ++i) x.push_back(static_cast<double>(i) / parts), y.push_back(mode(x.back()));
    const ClampedSpline s(x, y);
    double most = 0;
    for (int i = 0; i < 1000; ++i) most = std::max(most, std::abs(s.value((i + 0.5) / 1000) - mode((i + 0.5) / 1000)));
    return most;
  };
  const double order = std::log2(error(20) / error(40));
  EXPECT_GT(order, 3.7);
  EXPECT_LT(order, 4.3);
}

TEST(ClampedSpline, BetweenTwoClampsIsTheCubicThatStaysFlatAtBoth) {
  const auto beam = [](double x) { return x * x * (3 - 2 * x); };  // s'(0) = s'(1) = 0
  const std::vector<double> x{0, 0.2, 0.35, 0.7, 1};
  std::vector<double> y;
  for (const double at : x) y.push_back(beam(at));
  const ClampedSpline s(x, y, SplineEnd::clamped), half_as_far(x, {0, y[1] / 2, y[2] / 2, y[3] / 2, 0.5}, SplineEnd::clamped);
  for (double at = 0; at <= 1; at += 0.01) {
    EXPECT_NEAR(s.value(at), beam(at), rounding);
    EXPECT_NEAR(s.slope(at), 6 * at * (1 - at), 10 * rounding);
  }
  EXPECT_NEAR(s.integral_of_slopes(s), 1.2, 10 * rounding) << "of 36 x^2 (1 - x)^2";
  EXPECT_NEAR(s.integral_of_slopes(half_as_far), 0.6, 10 * rounding);
}

TEST(ClampedSpline, SeesHingesByTheSlopeWithWhichTheyAreLeft) {
  const auto at_places = [](int parts, auto curve) {
    std::vector<double> x, y;
    for (int i = 0; i <= parts; ++i) x.push_back(static_cast<double>(i) / parts), y.push_back(curve(x.back()));
    return std::pair(x, y);
  };
  const auto sees = [&](int parts, auto curve) {
    const auto [x, y] = at_places(parts, curve);
    return std::pair(is_hinged(x, y), is_hinged_at_end(x, y));
  };
  const auto clamps = [](double x) { return x * x * (1 - x) * (1 - x); };
  const auto clamp_and_hinge = [](double x) { return x * x * (1 - x); };
  const auto hinges = [](double x) { return x * (1 - x); };
  EXPECT_EQ(sees(30, clamps), std::pair(false, false));
  EXPECT_EQ(sees(30, clamp_and_hinge), std::pair(false, true));
  EXPECT_EQ(sees(30, hinges), std::pair(true, true));
  EXPECT_EQ(sees(5, hinges), std::pair(false, false)) << "too few places to tell";
}

TEST(ClampedSpline, RefusesPointsThatDoNotRise) {
  EXPECT_THROW(ClampedSpline({0, 1, 1}, {0, 1, 2}), InvalidInput);
  EXPECT_THROW(ClampedSpline({0}, {0}), InvalidInput);
  EXPECT_THROW(ClampedSpline({0, 1}, {0}), InvalidInput);
}

}  // namespace
}  // namespace softland
