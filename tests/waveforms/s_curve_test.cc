#include "waveforms/s_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/literals.h"
#include "tests/support/not_finite.h"
#include "tests/waveforms/expect_invalid.h"

namespace softland {
namespace {

using namespace literals;
using test::expect_invalid;

// Roundings of a sine of order one, relative to 6 V.
constexpr double kSCurveRounding = 1e-14;

TEST(SCurve, RisesAsHalfACosine) {
  const Signal curve = signal(SCurve{.levels = {6_V}, .edge = 8_us});
  for (const double part : {0.0, 0.1, 0.25, 0.5, 0.9, 1.0})
    EXPECT_NEAR(curve.voltage(part * 8_us), 3 * (1 - std::cos(std::numbers::pi * part)), 6 * kSCurveRounding) << part;
  EXPECT_EQ(curve.voltage(1), 6);
  EXPECT_EQ(curve.hold_level(), 6);
}

TEST(SCurve, IsSteepestInTheMiddleOfAnEdgeByHalfPi) {
  const Signal curve = signal(SCurve{.levels = {6_V}, .edge = 8_us});
  EXPECT_NEAR(curve.peak_slew(), std::numbers::pi / 2 * 6 / 8e-6, 1e-8 * curve.peak_slew());
}

TEST(SCurve, BeginsAndEndsEveryEdgeWithoutJumpOrCorner) {
  const Signal curve = signal(SCurve{.levels = {2_V, 6_V, -1_V}, .times = {20_us, 41_us}, .edge = 5_us});
  EXPECT_EQ(curve.breakpoints(), (std::vector<double>{0, 5_us, 20_us, 20_us + 5_us, 41_us, 41_us + 5_us}));
  const double steepest = curve.peak_slew();
  EXPECT_TRUE(std::isfinite(steepest));
  for (const double time : curve.breakpoints()) {
    const SignalPiece& piece = curve.pieces()[curve.piece_at(time)];
    EXPECT_NEAR(piece.rate(time), 0, 1e-9 * steepest) << time;
  }
  EXPECT_NEAR(curve.voltage(12_us), 2, 0);
  EXPECT_NEAR(curve.voltage(30_us), 6, 0);
  EXPECT_NEAR(curve.voltage(43.5_us), 2.5, 6 * kSCurveRounding);
}

TEST(SCurve, WithoutAnEdgeJumps) {
  const Signal curve = signal(SCurve{.levels = {1_V, -2_V}, .times = {1_us}});
  EXPECT_EQ(curve.breakpoints(), (std::vector<double>{0, 1_us}));
  EXPECT_EQ(curve.voltage_before(1_us), 1);
  EXPECT_EQ(curve.voltage(1_us), -2);
}

TEST(SCurve, NamesParameterValueAndRule) {
  expect_invalid([] { (void)signal(SCurve{}); }, {"levels of an S-curve", "must not be empty"});
  expect_invalid([] { (void)signal(SCurve{.levels = {1, 2}}); }, {"times of an S-curve", "0 for 2 levels"});
  expect_invalid([] { (void)signal(SCurve{.levels = {1, kNaN}, .times = {1}}); }, {"level 2 of an S-curve", "nan V"});
  expect_invalid([] { (void)signal(SCurve{.levels = {1}, .edge = -1}); }, {"edge of an S-curve", "-1 s", ">= 0"});
  expect_invalid([] { (void)signal(SCurve{.levels = {1, 2}, .times = {1}, .edge = 2}); }, {"time 1", "1 s", "at least 2 s"});
}

}  // namespace
}  // namespace softland
