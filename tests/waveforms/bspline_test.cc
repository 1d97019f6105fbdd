#include "waveforms/bspline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/literals.h"
#include "tests/support/not_finite.h"
#include "tests/waveforms/expect_invalid.h"

namespace softland {
namespace {

using namespace literals;
using test::expect_invalid;

constexpr double kBsplineRounding = 1e-13;  // rounding of a few sums of numbers of order ten

/// Evaluates a spline by de Boor's algorithm: means of neighbouring levels, three times.
double de_boor(const std::vector<double>& levels, double u) {
  const std::size_t n = levels.size();
  std::size_t k = 3;
  while (k + 1 < n && u >= internal::bspline_knot(k + 1, n)) ++k;
  std::vector<double> d;
  for (std::size_t j = 0; j <= 3; ++j) d.push_back(levels[j + k - 3]);
  for (std::size_t r = 1; r <= 3; ++r) {
    for (std::size_t j = 3; j >= r; --j) {
      const double left = internal::bspline_knot(j + k - 3, n), right = internal::bspline_knot(j + 1 + k - r, n);
      const double share = (u - left) / (right - left);
      d[j] = (1 - share) * d[j - 1] + share * d[j];
    }
  }
  return d[3];
}

const std::vector<double> some_levels{8, -3, 5, 12, 1, 0.5, 7};

TEST(BSpline, IsWhatDeBoorsAlgorithmGives) {
  for (const std::size_t n : {4U, 5U, 6U, 7U, 10U, 11U, 16U}) {
    std::vector<double> levels = some_levels;
    for (std::size_t k = levels.size(); k < n; ++k) levels.push_back(levels[k - 7] + levels[k - 5]);
    levels.resize(n);
    const Signal spline = signal(BSpline{.levels = levels, .duration = 30_us});
    const double spans = static_cast<double>(n - 3);
    for (int i = 0; i < 300; ++i) {
      const double part = i / 300.0;
      EXPECT_NEAR(spline.voltage(part * 30_us), de_boor(levels, part * spans), 12 * kBsplineRounding) << n << " at " << part;
    }
  }
}

TEST(BSpline, OfLevelsOnALineAtTheMeansOfTheKnotsIsThisLine) {
  // Greville: the levels of a straight line are its values at the means of three knots.
  const std::size_t n = 7;
  std::vector<double> levels;
  for (std::size_t i = 0; i < n; ++i) {
    double mean = 0;
    for (std::size_t k = 1; k <= 3; ++k) mean += internal::bspline_knot(i + k, n) / 3;
    levels.push_back(2 + 3 * mean);
  }
  const Signal spline = signal(BSpline{.levels = levels, .duration = 4});
  for (double t = 0; t < 4; t += 0.1) EXPECT_NEAR(spline.voltage(t), 2 + 3 * t, 14 * kBsplineRounding) << t;
}

TEST(BSpline, IsContinuousWithItsFirstTwoDerivatives) {
  const Signal spline = signal(BSpline{.levels = some_levels, .duration = 1});
  const std::vector<SignalPiece>& pieces = spline.pieces();
  for (std::size_t i = 1; i + 1 < pieces.size(); ++i) {
    const double t = pieces[i].begin;
    EXPECT_EQ(spline.voltage_before(t), spline.voltage(t)) << t;
    EXPECT_NEAR(pieces[i - 1].rate(t), pieces[i].rate(t), 1e3 * kBsplineRounding) << t;
    constexpr double h =
        1e-4;  // the second derivative of a cubic is linear, so that this difference is exact except for rounding over h
    const auto curvature = [&](const SignalPiece& piece) { return (piece.rate(t + h) - piece.rate(t - h)) / (2 * h); };
    EXPECT_NEAR(curvature(pieces[i - 1]), curvature(pieces[i]), 1e-6) << t;
  }
  EXPECT_TRUE(std::isinf(spline.peak_slew())) << "it begins with a jump";
}

// Rounding of the times grows with the time.
TEST(BSpline, OfManyLevelsHasNoJumps) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const int n : {20, 100, 1000}) {
    for (int draw = 0; draw < 200'000 / n; ++draw) {
      std::vector<double> levels(static_cast<std::size_t>(n));
      for (double& level : levels) level = 40 * uniform(random) - 5;
      levels.front() = 0;
      ASSERT_TRUE(std::isfinite(signal(BSpline{.levels = levels, .duration = 1e-4 * (1 + uniform(random))}).peak_slew())) << n;
    }
  }
}

TEST(BSpline, StaysBetweenItsLevelsAndEndsOnTheLast) {
  const Signal spline = signal(BSpline{.levels = some_levels, .duration = 1});
  EXPECT_LE(spline.maximum(), 12);
  EXPECT_GE(spline.minimum(), -3);
  EXPECT_EQ(spline.voltage(0), 8);
  EXPECT_EQ(spline.voltage(1), 7);
  EXPECT_EQ(spline.voltage_before(1), 7);
  EXPECT_EQ(spline.hold_level(), 7);
}

TEST(BSpline, NamesParameterValueAndRule) {
  expect_invalid([] { (void)signal(BSpline{.levels = {1, 2, 3}, .duration = 1}); }, {"levels of a bspline", "3", "at least 4"});
  expect_invalid([] { (void)signal(BSpline{.levels = {1, 2, kNaN, 3}, .duration = 1}); }, {"level 3 of a bspline", "nan V"});
  expect_invalid([] { (void)signal(BSpline{.levels = {1, 2, 3, 4}}); }, {"duration of a bspline", "0 s", "> 0"});
  expect_invalid([] { (void)signal(BSpline{.levels = {1, 2, 3, 4}, .duration = kInfinity}); }, {"duration", "inf", "finite"});
}

}  // namespace
}  // namespace softland
