#include "waveforms/chirp.h"

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

// Rounding of angles up to some hundred radians, relative to the voltages.
constexpr double kChirpRounding = 1e-12;

void expect_formula(const Chirp& c, double span) {
  const Signal compiled = signal(c);
  constexpr int samples = 997;
  for (int i = 0; i <= samples; ++i) {
    const double t = span * i / samples, s = t - c.start, duration = c.end - c.start;
    const double base = t < c.rise_time ? c.base * t / c.rise_time : c.base;
    const double in = c.fade > 0 ? s / c.fade : 1, out = c.fade > 0 ? (c.end - t) / c.fade : 1;
    const double envelope = t < c.start || t >= c.end ? 0 : std::min({1.0, in, out}) * std::exp(-s / c.decay_time);
    const double sweep = std::isfinite(duration) ? (c.frequency_ratio - 1) * c.angular_frequency / duration : 0;
    const double expected = base + c.amplitude * envelope * std::sin(c.phase + c.angular_frequency * s + sweep * s * s / 2);
    EXPECT_NEAR(compiled.voltage(t), expected, kChirpRounding * (std::abs(c.base) + std::abs(c.amplitude))) << "t = " << t;
  }
}

const Chirp whole{.base = 40_V,
                  .rise_time = 19_us,
                  .amplitude = 6_V,
                  .angular_frequency = 1e6_rad_s,
                  .frequency_ratio = 3,
                  .phase = 0.4,
                  .start = 11_us,
                  .end = 83_us,
                  .fade = 17_us,
                  .decay_time = 30_us};

TEST(Chirp, FollowsItsFormula) {
  expect_formula(whole, 100_us);
  Chirp other = whole;
  other.fade = 0;
  expect_formula(other, 100_us);
  other.frequency_ratio = 0.2;
  expect_formula(other, 100_us);
  other.decay_time = kInfinity;
  expect_formula(other, 100_us);
  other = whole;
  other.frequency_ratio = 1;
  other.end = kInfinity;
  expect_formula(other, 100_us);
}

TEST(Chirp, ReachesTheRatioOfItsFrequencies) {
  Chirp plain = whole;
  plain.fade = 0;
  plain.decay_time = kInfinity;
  const Signal compiled = signal(plain);
  // At a zero of the sine the rate is amplitude times angular frequency.
  const SignalPiece& piece = compiled.pieces()[compiled.piece_at(50_us)];
  const double s = piece.begin - plain.start;
  ASSERT_EQ(piece.terms.size(), 1U);
  const double sweep = piece.terms[0].sweep;
  EXPECT_NEAR(piece.terms[0].angular_frequency + sweep * (plain.end - plain.start - s), 3e6, 3e6 * kChirpRounding);
}

TEST(Chirp, OfOneFrequencyWithoutDecayIsAHarmonic) {
  Chirp same = whole;
  same.frequency_ratio = 1;
  same.decay_time = kInfinity;
  const Signal chirp = signal(same);
  const Signal harmonic = signal(Harmonic{.base = same.base,
                                          .rise_time = same.rise_time,
                                          .amplitude = same.amplitude,
                                          .angular_frequency = same.angular_frequency,
                                          .phase = same.phase - same.angular_frequency * same.start,
                                          .start = same.start,
                                          .end = same.end,
                                          .fade = same.fade});
  EXPECT_EQ(chirp.breakpoints(), harmonic.breakpoints());
  for (double t = 0; t < 100_us; t += 0.37_us) EXPECT_NEAR(chirp.voltage(t), harmonic.voltage(t), 46 * kChirpRounding) << t;
}

TEST(Chirp, ThatNeverEndsDecaysToItsBase) {
  Chirp endless = whole;
  endless.frequency_ratio = 1;
  endless.end = kInfinity;
  const Signal compiled = signal(endless);
  EXPECT_EQ(compiled.hold_level(), 40);
  EXPECT_NEAR(compiled.voltage(11_us + 100 * 30_us), 40, 40 * kChirpRounding);
  EXPECT_LT(compiled.maximum(), 46);
  EXPECT_GT(compiled.maximum(), 40);
}

TEST(Chirp, WithFadesHasNoJump) {
  for (int k = 0; k < 50; ++k) {
    Chirp one = whole;
    one.base *= 1 + 0.003 * k;
    EXPECT_TRUE(std::isfinite(signal(one).peak_slew())) << one.base;
  }
}

TEST(Chirp, WithoutAmplitudeIsItsBase) {
  Chirp still = whole;
  still.amplitude = 0;
  still.rise_time = 0;
  EXPECT_EQ(signal(still).pieces(), Signal::constant(40).pieces());
}

TEST(Chirp, NamesParameterValueAndRule) {
  EXPECT_NO_THROW((void)signal(whole));
  const auto refused = [&](auto change, const std::vector<std::string>& parts) {
    Chirp bad = whole;
    change(bad);
    expect_invalid([&] { (void)signal(bad); }, parts);
  };
  refused([](Chirp& c) { c.base = kNaN; }, {"base of a chirp", "nan V", "finite"});
  refused([](Chirp& c) { c.angular_frequency = 0; }, {"angular_frequency of a chirp", "0 rad/s", "> 0"});
  refused([](Chirp& c) { c.frequency_ratio = 0; }, {"frequency_ratio of a chirp", "is 0", "> 0"});
  refused([](Chirp& c) { c.frequency_ratio = kInfinity; }, {"frequency_ratio", "inf", "finite"});
  refused([](Chirp& c) { c.decay_time = 0; }, {"decay_time of a chirp", "0 s", "> 0"});
  refused([](Chirp& c) { c.fade = 50_us; }, {"fade of a chirp", "half"});
  refused([](Chirp& c) { c.end = kInfinity; }, {"frequency_ratio of a chirp is 3", "without an end"});
  refused([](Chirp& c) { c.end = c.decay_time = kInfinity, c.frequency_ratio = 1; }, {"must have an end or a decay_time"});
}

}  // namespace
}  // namespace softland
