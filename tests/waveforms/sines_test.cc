#include "waveforms/sines.h"

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

constexpr double kSinesRounding = 1e-13;  // relative to the sum of the amplitudes

TEST(Sines, FollowTheirFormula) {
  for (const double rise : {0_us, 3_us, 20_us, 90_us}) {
    const Sines sines{.base = 30_V, .rise_time = rise, .amplitudes = {5, -8, 0, 2}, .start = 6_us, .duration = 50_us};
    const Signal compiled = signal(sines);
    for (double t = 0; t < 100_us; t += 0.31_us) {
      double expected = t < rise ? 30 * t / rise : 30;
      if (t > 6_us && t < 56_us) {
        for (std::size_t k = 1; k <= 4; ++k)
          expected += sines.amplitudes[k - 1] * std::sin(static_cast<double>(k) * std::numbers::pi * (t - 6_us) / 50_us);
      }
      EXPECT_NEAR(compiled.voltage(t), expected, 45 * kSinesRounding) << t << " rise " << rise;
    }
  }
}

// Values by rotation from the first sine, at any time from the beginning of a piece on.
TEST(Sines, OfASeriesAreTheSumOfItsTerms) {
  Sines sines{.base = 30_V, .rise_time = 20_us, .start = 6_us, .duration = 50_us};
  double size = 30;
  for (int k = 0; k < 24; ++k)
    sines.amplitudes.push_back(k % 3 == 0 ? -4_V : 3_V / (1 + k)), size += std::abs(sines.amplitudes.back());
  int series = 0;
  const Signal compiled = signal(sines);
  for (const SignalPiece& piece : compiled.pieces()) {
    if (piece.terms.empty()) continue;
    EXPECT_TRUE(piece.is_series);
    ++series;
    SignalPiece plain = piece;
    plain.is_series = false;
    const double fastest = piece.terms.back().angular_frequency;
    for (double t = piece.begin; t < 60_us; t += 0.37_us) {
      EXPECT_NEAR(piece.voltage(t), plain.voltage(t), size * kSinesRounding) << t;
      EXPECT_NEAR(piece.rate(t), plain.rate(t), size * fastest * kSinesRounding) << t;
    }
  }
  EXPECT_EQ(series, 2) << "before and after the end of the rise";
}

TEST(Sines, BeginAndEndWithoutAJump) {
  const Signal sines = signal(Sines{.amplitudes = {5, -8, 1, 2}, .start = 6_us, .duration = 50_us});
  EXPECT_TRUE(std::isfinite(sines.peak_slew()));
  EXPECT_EQ(sines.hold_level(), 0);
}

TEST(Sines, OfOneHalfWaveReachItsAmplitude) {
  const Signal half = signal(Sines{.amplitudes = {-7_V}, .duration = 50_us});
  EXPECT_NEAR(half.minimum(), -7, 7e-9);
  EXPECT_EQ(half.maximum(), 0);
  EXPECT_NEAR(half.peak_slew(), 7 * std::numbers::pi / 50e-6, 1e-8 * half.peak_slew());
}

TEST(Sines, NameParameterValueAndRule) {
  expect_invalid([] { (void)signal(Sines{.duration = 1}); }, {"amplitudes of sines", "must not be empty"});
  expect_invalid([] { (void)signal(Sines{.amplitudes = {1, kNaN}, .duration = 1}); }, {"amplitude 2 of sines", "nan V"});
  expect_invalid([] { (void)signal(Sines{.amplitudes = {1}}); }, {"duration of sines", "0 s", "> 0"});
  expect_invalid([] { (void)signal(Sines{.amplitudes = {1}, .start = -1, .duration = 1}); }, {"start of sines", "-1 s"});
  expect_invalid([] { (void)signal(Sines{.base = kInfinity, .amplitudes = {1}, .duration = 1}); }, {"base of sines", "inf"});
}

}  // namespace
}  // namespace softland
