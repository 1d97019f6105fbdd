#include "waveforms/signal.h"

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

// Some roundings of the formula at arguments of order one.
constexpr double kRounding = 1e-14;
// The error of the extrema of sines that signal.h states, relative to their amplitude.
constexpr double kPromisedExtremum = 1e-9;

Signal of(std::vector<SignalPiece> pieces) { return Signal(std::move(pieces)); }

// 0 V to 10 V in 1 us, a jump to 20 V at 2 us, 4 V from 3 us on.
Signal ramp_and_jumps() { return Signal::piecewise_linear({{0, 0}, {1_us, 10}, {2_us, 10}, {2_us, 20}, {3_us, 20}, {3_us, 4}}); }

TEST(Signal, IsZeroForEverByDefault) {
  const Signal nothing;
  EXPECT_TRUE(nothing.is_zero());
  EXPECT_EQ(nothing.voltage(1), 0);
  EXPECT_EQ(nothing.hold_level(), 0);
  EXPECT_EQ(nothing.peak(), 0);
  EXPECT_EQ(nothing.peak_slew(), 0);
  EXPECT_EQ(nothing.resolving_step(0), kInfinity);
}

TEST(Signal, ConstantJumpsAtZero) {
  const Signal constant = Signal::constant(-3);
  EXPECT_FALSE(constant.is_zero());
  EXPECT_EQ(constant.voltage(-1_ns), 0);
  EXPECT_EQ(constant.voltage_before(0), 0);
  EXPECT_EQ(constant.voltage(0), -3);
  EXPECT_EQ(constant.hold_level(), -3);
  EXPECT_EQ(constant.maximum(), 0);
  EXPECT_EQ(constant.minimum(), -3);
  EXPECT_EQ(constant.peak(), 3);
  EXPECT_EQ(constant.peak_slew(), kInfinity);
}

TEST(Signal, TakesTheLaterPieceAtABreakpoint) {
  const Signal signal = ramp_and_jumps();
  EXPECT_EQ(signal.breakpoints(), (std::vector<double>{0, 1_us, 2_us, 3_us}));
  EXPECT_EQ(signal.piece_at(0), 0U);
  EXPECT_EQ(signal.piece_at(std::nextafter(2_us, 0)), 1U);
  EXPECT_EQ(signal.piece_at(2_us), 2U);
  EXPECT_EQ(signal.piece_at(1), 3U);
  EXPECT_EQ(signal.voltage(2_us), 20);
  EXPECT_EQ(signal.voltage_before(2_us), 10);
  EXPECT_EQ(signal.voltage_before(3_us), 20);
  EXPECT_EQ(signal.hold_level(), 4);
}

TEST(Signal, LimitFromTheLeftIsTheVoltageWhereNothingJumps) {
  // 0.7 / 0.3 has no finite binary form: the end of the ramp is 0.7 except for rounding.
  const Signal signal = Signal::piecewise_linear({{0, 0}, {0.3, 0.7}, {0.9, 0.1}});
  EXPECT_EQ(signal.voltage_before(0.3), 0.7);
  EXPECT_EQ(signal.voltage_before(0.9), 0.1);
  EXPECT_EQ(signal.voltage_before(0.2), signal.voltage(0.2));
  EXPECT_LT(signal.peak_slew(), kInfinity);
}

TEST(Signal, HardSwitchAtAZeroOfTheSineIsNoJump) {
  const double w = 2 * std::numbers::pi * 1e6;
  const double zero = 7 * std::numbers::pi / w;
  const Signal signal = of({{.value = 0, .amplitude = 5, .angular_frequency = w}, {.begin = zero, .value = 0}});
  EXPECT_EQ(signal.voltage_before(zero), 0);
  EXPECT_NEAR(signal.peak_slew(), 5 * w, kRounding * 5 * w);
}

TEST(Signal, DropsPointsThatOnlyRepeatTheHeldValue) {
  EXPECT_EQ(Signal::piecewise_linear({{0, 0}, {1, 2}, {3, 2}, {4, 2}}).breakpoints(), (std::vector<double>{0, 1}));
  EXPECT_EQ(Signal::piecewise_linear({{0, 2}, {1, 2}}).pieces(), Signal::constant(2).pieces());
}

TEST(Signal, RateIsTheDerivativeOfVoltage) {
  const SignalPiece piece{
      .begin = 0.3, .value = 1, .slope = -2, .amplitude = 3, .amplitude_slope = 0.7, .angular_frequency = 5, .phase = 0.4};
  // Central difference: h^2 V''' / 6 with V''' of order 500, and rounding over h.
  constexpr double h = 1e-5;
  constexpr double tolerance = 1e-7;
  for (double t = 0.3; t < 2; t += 0.1) {
    EXPECT_NEAR(piece.rate(t), (piece.voltage(t + h) - piece.voltage(t - h)) / (2 * h), tolerance);
  }
}

TEST(Signal, ExtremaOfRampsAreTheirEnds) {
  const Signal signal = ramp_and_jumps();
  EXPECT_EQ(signal.maximum(), 20);
  EXPECT_EQ(signal.maximum(2_us), 20) << "at a jump the value after it counts";
  EXPECT_EQ(signal.maximum(std::nextafter(2_us, 0)), 10);
  EXPECT_EQ(signal.maximum(0.5_us), 5);
  EXPECT_EQ(signal.minimum(), 0);
  EXPECT_EQ(Signal::piecewise_linear({{0, 0}, {1, -4}, {2, 3}}).minimum(), -4);
  EXPECT_EQ(Signal::piecewise_linear({{0, 0}, {1, -4}, {2, 3}}).peak(), 4);
}

TEST(Signal, PeakSlewIsInfiniteFromTheFirstJumpOn) {
  const Signal signal = ramp_and_jumps();
  EXPECT_DOUBLE_EQ(signal.peak_slew(1.5_us), 10 / 1e-6);
  EXPECT_EQ(signal.peak_slew(2_us), kInfinity);
}

TEST(Signal, ExtremaOfASineOnARampMatchTheClosedForm) {
  // V = s t + a sin(w t) is stationary at cos(w t) = -s / (a w); the last maximum before the end is the highest.
  constexpr double s = 2, a = 3, w = 4;
  const double angle = std::acos(-s / (a * w));
  const double last_maximum = (angle + 6 * std::numbers::pi) / w;
  const double end = last_maximum + 0.1;
  const Signal signal = of({{.slope = s, .amplitude = a, .angular_frequency = w}, {.begin = end, .value = 0}});
  EXPECT_NEAR(signal.maximum(), s * last_maximum + a * std::sin(angle), kPromisedExtremum * a);
  EXPECT_NEAR(signal.peak_slew(std::nextafter(end, 0)), s + a * w, kPromisedExtremum * a * w);
}

TEST(Signal, EndlessSineReachesItsAmplitudeFromAnyPhase) {
  for (const double phase : {-9.0, -1.0, 0.0, 0.5 * std::numbers::pi, 2.0, 100.0}) {
    const Signal signal = of({{.value = 10, .amplitude = -3, .angular_frequency = 1e7, .phase = phase}});
    EXPECT_NEAR(signal.maximum(), 13, kPromisedExtremum * 3);
    EXPECT_NEAR(signal.minimum(), 0, 0) << "the starting 0 V";
    EXPECT_EQ(signal.hold_level(), 10);
    EXPECT_DOUBLE_EQ(signal.resolving_step(1), 2 * std::numbers::pi / 1e7 / 20);
  }
}

TEST(Signal, ExtremaOfFadingSinesMatchDenseSampling) {
  // Includes an envelope that changes its sign, many periods, and less than a quarter of a period.
  const std::vector<SignalPiece> cases{
      {.value = 1, .slope = 0.5, .amplitude = 0, .amplitude_slope = 3, .angular_frequency = 9, .phase = 0.3},
      {.value = 1, .slope = -0.5, .amplitude = 2, .amplitude_slope = -3, .angular_frequency = 40, .phase = -2},
      {.value = -1, .slope = 3, .amplitude = 2, .amplitude_slope = -1, .angular_frequency = 0.7, .phase = 1},
      {.value = 0.1, .slope = -1.9, .amplitude = 1, .amplitude_slope = 1, .angular_frequency = 2, .phase = 0}};
  constexpr double duration = 1.3;
  constexpr int samples = 200000;
  for (SignalPiece piece : cases) {
    const double start = piece.voltage(0);
    const Signal signal = of({piece, {.begin = duration, .value = piece.voltage(duration)}});
    double largest = 0, smallest = 0, fastest = 0;
    for (int i = 0; i <= samples; ++i) {
      const double t = duration * i / samples;
      largest = std::max(largest, piece.voltage(t));
      smallest = std::min(smallest, piece.voltage(t));
      fastest = std::max(fastest, std::abs(piece.rate(t)));
    }
    const double swing = std::abs(piece.amplitude) + std::abs(piece.amplitude_slope) * duration;
    const double w = piece.angular_frequency;
    // The sample nearest to an extremum is h^2 V'' / 8 below it; for the rate the error has one more power of w.
    const double h = duration / samples;
    const double below = h * h / 8 * (swing * w * w + 2 * std::abs(piece.amplitude_slope) * w);
    EXPECT_GE(signal.maximum(), largest - kRounding);
    EXPECT_LE(signal.maximum(), largest + below + kRounding);
    EXPECT_LE(signal.minimum(), smallest + kRounding);
    EXPECT_GE(signal.minimum(), smallest - below - kRounding);
    EXPECT_EQ(signal.peak_slew(), kInfinity) << "the start is a jump";
    piece.value -= start;
    const Signal continuous = of({piece, {.begin = duration, .value = piece.voltage(duration)}});
    EXPECT_GE(continuous.peak_slew(), fastest * (1 - kRounding));
    EXPECT_LE(continuous.peak_slew(), fastest + below * (w + 2) + kRounding * w);
  }
}

TEST(Signal, SineThatStartsAtZeroToRoundingDoesNotJump) {
  const Signal signal = of({{.amplitude = 2, .angular_frequency = 3, .phase = std::numbers::pi}});
  EXPECT_NE(signal.voltage(0), 0);
  EXPECT_EQ(signal.voltage_before(0), signal.voltage(0));
  EXPECT_NEAR(signal.peak_slew(), 6, kPromisedExtremum * 6);
}

TEST(Signal, AnglesWithoutADigitLeftStillReturn) {
  const Signal signal = of({{.amplitude = 1, .angular_frequency = 1e300, .phase = 1e300}, {.begin = 1, .value = 0}});
  EXPECT_LE(signal.maximum(), 1);
}

TEST(Signal, RefusesBadPieces) {
  expect_invalid([] { of({}); }, {"at least one piece"});
  expect_invalid([] { of({{.begin = 1e-3}}); }, {"begins at 0.001 s", "must begin at 0"});
  expect_invalid([] { of({{}, {.begin = 2}, {.begin = 2}}); }, {"piece 3", "2 s", "after"});
  expect_invalid([] { of({{.value = kNaN}}); }, {"value of piece 1", "nan", "finite"});
  expect_invalid([] { of({{}, {.begin = kNaN}}); }, {"begin of piece 2", "nan"});
  expect_invalid([] { of({{.phase = kInfinity}}); }, {"phase", "inf"});
  expect_invalid([] { of({{.slope = 1.5}}); }, {"slope of the last piece", "1.5 V/s", "must be constant"});
  expect_invalid([] { of({{.amplitude_slope = 2, .angular_frequency = 1}}); }, {"amplitude_slope of the last piece", "2 V/s"});
  expect_invalid([] { of({{.amplitude = 2, .angular_frequency = -7}}); }, {"angular_frequency", "-7 rad/s", "> 0"});
  expect_invalid([] { Signal::constant(kNaN); }, {"nan"});
}

TEST(Signal, RefusesBadPoints) {
  expect_invalid([] { Signal::piecewise_linear({}); }, {"at least one point"});
  expect_invalid([] { Signal::piecewise_linear({{1, 2}}); }, {"begins at 1 s"});
  expect_invalid([] { Signal::piecewise_linear({{0, 0}, {2, 1}, {1, 2}}); }, {"point 3", "1 s", "2 s"});
  expect_invalid([] { Signal::piecewise_linear({{0, 0}, {kNaN, 1}, {1, 2}}); }, {"point 2", "nan"});
}

TEST(Signal, RefusesASpanThatEndsBeforeZero) {
  const Signal signal = ramp_and_jumps();
  expect_invalid([&] { (void)signal.maximum(-1); }, {"-1 s", ">= 0"});
  expect_invalid([&] { (void)signal.minimum(kNaN); }, {"nan", ">= 0"});
  expect_invalid([&] { (void)signal.peak_slew(kNaN); }, {"nan", ">= 0"});
}

TEST(Signal, ScaledIsTheSameShapeAtAnotherLevel) {
  const Signal sines = of({{.value = 2, .slope = 3, .amplitude = 4, .amplitude_slope = 5, .angular_frequency = 6, .phase = 1},
                           {.begin = 2, .value = 1, .amplitude = 2, .angular_frequency = 3}});
  const Signal half = scaled(sines, 0.5);
  for (const double t : {0.0, 0.7, 1.99, 2.0, 3.3}) EXPECT_EQ(half.voltage(t), 0.5 * sines.voltage(t)) << t;
  EXPECT_EQ(half.breakpoints(), sines.breakpoints());
  EXPECT_TRUE(scaled(sines, 0).is_zero());
}

TEST(Signal, IsHeldFromATimeAndGoesOnFromOne) {
  const Signal whole({{.begin = 0, .value = 1, .amplitude = 2, .angular_frequency = 3e6, .phase = 0.4},
                      {.begin = 2e-6, .value = 20},
                      {.begin = 5e-6, .value = 20, .slope = -1e7, .amplitude = 1, .angular_frequency = 4e6, .phase = 0.2},
                      {.begin = 7e-6, .value = 0}},
                     1.5);
  for (const double from : {1e-6, 5e-6, 6e-6}) {
    const Signal held = held_from(whole, from);
    for (const double t : {0.0, 0.7e-6, 0.9 * from}) EXPECT_EQ(held.voltage(t), whole.voltage(t));
    for (const double t : {from, 1.1 * from, 1.0}) EXPECT_EQ(held.voltage(t), whole.voltage_before(from));
    EXPECT_EQ(held.before(), 1.5);
  }
  EXPECT_EQ(held_from(whole, 0).voltage(3e-6), 1.5);
  const Signal later = part_from(whole, 5e-6, 20);
  EXPECT_EQ(later.before(), 20);
  for (const double t : {0.0, 0.3e-6, 1.9e-6, 2e-6, 1.0}) EXPECT_NEAR(later.voltage(t), whole.voltage(5e-6 + t), 1e-9);
}

}  // namespace
}  // namespace softland
