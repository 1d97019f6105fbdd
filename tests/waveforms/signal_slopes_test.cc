// Derivatives of signals by parameters: exact ones of splines, and differences that several parameters share.
#include "waveforms/signal_slopes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "waveforms/bspline.h"
#include "waveforms/sines.h"

namespace softland {
namespace {

constexpr std::size_t spline_levels = 60;
constexpr double spline_duration = 50e-6;  // [s]

// A spline whose levels and duration are the parameters; `calls` counts its evaluations.
struct ManySplines {
  std::vector<double> x, lower, upper;
  mutable int calls = 0;

  ManySplines() : lower(spline_levels, -10), upper(spline_levels, 40) {
    for (std::size_t k = 0; k < spline_levels; ++k) x.push_back(20 + 10 * std::sin(static_cast<double>(k)));
    x.push_back(spline_duration), lower.push_back(0.1 * spline_duration), upper.push_back(2 * spline_duration);
  }
  [[nodiscard]] SignalSlopes slopes(const std::vector<ParameterGroup>& groups = {}) const {
    const auto signals = [this](std::span<const double> at) {
      ++calls;
      return std::vector{signal(BSpline{.levels = {at.begin(), at.end() - 1}, .duration = at.back()})};
    };
    return SignalSlopes(signals, x, lower, upper, groups);
  }
};

void expect_same_slopes(const SignalSlopes& one, const SignalSlopes& other, std::size_t pieces) {
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    const auto &a = one.at(0, piece), &b = other.at(0, piece);
    ASSERT_EQ(a.size(), b.size()) << piece;
    for (const SignalSlopes::Slope& slope : a) {
      const auto same = std::find_if(b.begin(), b.end(), [&](const auto& s) { return s.parameter == slope.parameter; });
      ASSERT_NE(same, b.end()) << piece;
      EXPECT_EQ(slope.begin, same->begin);
      EXPECT_EQ(slope.voltage(0.3 * spline_duration), same->voltage(0.3 * spline_duration));
    }
  }
}

TEST(SignalSlopes, OfASplineByALevelAreItsBSpline) {
  constexpr double differences = 1e-8;  // rounding of 20 V over a step of 5e-5 V
  const ManySplines splines;
  const SignalSlopes slopes = splines.slopes();
  for (std::size_t k = 0; k < spline_levels; ++k) {
    BSpline unit{.levels = std::vector<double>(spline_levels, 0.0), .duration = spline_duration};
    unit.levels[k] = 1;
    const Signal basis = signal(unit);
    for (std::size_t piece = 0; piece < basis.pieces().size(); ++piece) {
      double found = 0;
      const double time = basis.pieces()[piece].begin + 0.3 * spline_duration / (spline_levels - 3);
      for (const SignalSlopes::Slope& slope : slopes.at(0, piece)) {
        if (slope.parameter == k) found = slope.voltage(time);
      }
      EXPECT_NEAR(found, basis.pieces()[piece].voltage(time), differences) << k << " " << piece;
    }
  }
}

TEST(SignalSlopes, OfSinesByAnAmplitudeAreItsSine) {
  constexpr double differences = 1e-8;
  const std::vector<double> x{5, -8, 1, 50e-6}, lower{-20, -20, -20, 20e-6}, upper{20, 20, 20, 80e-6};
  const auto signals = [](std::span<const double> at) {
    return std::vector{signal(Sines{.base = 30, .amplitudes = {at.begin(), at.end() - 1}, .duration = at.back()})};
  };
  const SignalSlopes slopes(signals, x, lower, upper);
  EXPECT_TRUE(slopes.kinks().empty());
  for (double t = 1e-6; t < 50e-6; t += 0.7e-6) {
    const double angle = std::numbers::pi * t / 50e-6;
    double by_duration = 0;
    for (int k = 1; k <= 3; ++k) by_duration -= x[static_cast<std::size_t>(k) - 1] * k * angle / 50e-6 * std::cos(k * angle);
    const std::vector<SignalSlopes::Slope>& all = slopes.at(0, 0);
    ASSERT_EQ(all.size(), 4U);
    for (const SignalSlopes::Slope& slope : all) {
      const double expected = slope.parameter < 3 ? std::sin(static_cast<double>(slope.parameter + 1) * angle) : by_duration;
      EXPECT_NEAR(slope.voltage(t), expected, differences * (slope.parameter < 3 ? 1 : 1e6)) << slope.parameter << " at " << t;
    }
  }
}

TEST(SignalSlopes, OfASplineByItsDurationAreThoseOfScaledTime) {
  constexpr double differences = 1e-8;  // over 20 V in the span: rounding of its times over a step of a millionth
  const ManySplines splines;
  const SignalSlopes slopes = splines.slopes();
  const Signal spline = signal(BSpline{.levels = {splines.x.begin(), splines.x.end() - 1}, .duration = spline_duration});
  for (std::size_t piece = 0; piece + 1 < spline.pieces().size(); ++piece) {
    const double begin = spline.pieces()[piece].begin, time = begin + 0.3 * spline_duration / (spline_levels - 3);
    const SignalSlopes::Slope& slope = slopes.at(0, piece).back();
    ASSERT_EQ(slope.parameter, spline_levels);
    EXPECT_NEAR(slope.begin, begin / spline_duration, differences);
    EXPECT_NEAR(slope.voltage(time), -time / spline_duration * spline.pieces()[piece].rate(time),
                differences * 20 * spline_levels / spline_duration);
  }
}

TEST(SignalSlopes, OfASplineTakeFewSignalsWhateverTheNumberOfLevels) {
  ManySplines splines;
  const SignalSlopes alone = splines.slopes();
  EXPECT_EQ(splines.calls, 1 + 2 * (spline_levels + 1));
  const std::vector<ParameterGroup> groups = alone.groups();
  splines.x[7] += 3, splines.x.back() *= 1.2;
  splines.calls = 0;
  const SignalSlopes together = splines.slopes(groups);
  EXPECT_TRUE(together.are_grouped());
  EXPECT_EQ(splines.calls, 1 + 2 * (4 + 1 + 1)) << "four groups of levels, the duration, and the check";
  expect_same_slopes(splines.slopes(), together, spline_levels - 2);
}

TEST(SignalSlopes, DoNotTakeGroupsThatAreWrong) {
  const ManySplines splines;
  const SignalSlopes alone = splines.slopes();
  const std::vector<ParameterGroup> right = alone.groups();
  ASSERT_TRUE(splines.slopes(right).are_grouped());

  std::vector<ParameterGroup> overlapping = right;  // the first level is in the next group, and shares pieces with it
  std::erase(overlapping[0].parameters, 0U);
  overlapping[1].parameters.push_back(0);
  for (auto& mover : overlapping[0].movers[0]) {
    if (mover == 0U) mover.reset();
  }
  overlapping[1].movers[0][0] = 0;

  std::vector<ParameterGroup> unclaimed = right;  // a piece that changes belongs to no parameter
  unclaimed[0].movers[0][0].reset();

  std::vector<ParameterGroup> of_another_length = right;
  of_another_length[0].movers[0].pop_back();

  std::vector<ParameterGroup> without_one = right;  // a level that is in no group
  std::erase(without_one[2].parameters, 2U);

  for (const auto& wrong : {overlapping, unclaimed, of_another_length, without_one}) {
    const SignalSlopes slopes = splines.slopes(wrong);
    EXPECT_FALSE(slopes.are_grouped());
    expect_same_slopes(alone, slopes, spline_levels - 2);
  }
}

TEST(SignalSlopes, ShareNothingWhereEveryParameterMovesEverything) {
  const auto signals = [](std::span<const double> x) { return std::vector{Signal::constant(x[0] + 2 * x[1] + x[2])}; };
  const std::vector<double> x(3, 1.0), lower(3, 0.0), upper(3, 2.0);
  EXPECT_TRUE(SignalSlopes(signals, x, lower, upper).groups().empty());
}

}  // namespace
}  // namespace softland
