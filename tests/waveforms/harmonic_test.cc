#include "waveforms/harmonic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/literals.h"
#include "tests/support/not_finite.h"
#include "tests/waveforms/expect_invalid.h"
#include "waveforms/step.h"

namespace softland {
namespace {

using namespace literals;
using test::expect_invalid;

// Rounding of angles up to some hundred radians, relative to the voltages.
constexpr double kSineRounding = 1e-12;

double envelope(const Harmonic& h, double t) {
  if (t < h.start || t > h.end) return 0;
  const double in = h.fade > 0 ? (t - h.start) / h.fade : 1;
  const double out = h.fade > 0 ? (h.end - t) / h.fade : 1;
  return std::min({1.0, in, out});
}

void expect_formula(const Harmonic& h, double span) {
  const Signal compiled = signal(h);
  constexpr int samples = 997;
  for (int i = 0; i <= samples; ++i) {
    const double t = span * i / samples;
    const double base = t < h.rise_time ? h.base * t / h.rise_time : h.base;
    const double expected = base + h.amplitude * envelope(h, t) * std::sin(h.angular_frequency * t + h.phase);
    EXPECT_NEAR(compiled.voltage(t), expected, kSineRounding * (std::abs(h.base) + std::abs(h.amplitude))) << "t = " << t;
  }
}

TEST(Harmonic, FollowsItsFormula) {
  const Harmonic whole{.base = 40_V, .amplitude = 6_V, .angular_frequency = 1e6_rad_s, .phase = 0.4};
  expect_formula(whole, 100_us);
  Harmonic faded = whole;
  faded.start = 11_us;
  faded.end = 83_us;
  faded.fade = 17_us;
  expect_formula(faded, 100_us);
  faded.fade = 36_us;
  expect_formula(faded, 100_us);
  faded.fade = 0;
  expect_formula(faded, 100_us);
  faded.end = std::numeric_limits<double>::infinity();
  faded.fade = 25_us;
  expect_formula(faded, 100_us);
}

TEST(Harmonic, RisesToItsBaseWhereverTheSineBegins) {
  const Harmonic faded{
      .base = 40_V, .amplitude = 6_V, .angular_frequency = 1e6_rad_s, .phase = 0.4, .start = 11_us, .end = 83_us, .fade = 17_us};
  // Times before the sine, up to its start, inside of each of its parts, up to its end, and after it.
  for (const double rise : {5_us, 11_us, 19_us, 40_us, 70_us, 83_us, 95_us}) {
    Harmonic risen = faded;
    risen.rise_time = rise;
    expect_formula(risen, 100_us);
    const Signal compiled = signal(risen);
    EXPECT_TRUE(std::isfinite(compiled.peak_slew())) << rise;
    EXPECT_EQ(compiled.hold_level(), 40_V) << rise;
  }
}

TEST(Harmonic, RisesWithoutAJumpWhateverTheBase) {
  // A slope that is rounded twice misses the base by a bit for two bases in five.
  for (int k = 0; k < 50; ++k) {
    const double base = 28.087_V * (1 + 0.003 * k);
    const Harmonic h{.base = base,
                     .rise_time = base / 2e6,
                     .amplitude = 2,
                     .angular_frequency = 9e4,
                     .start = 16_us,
                     .end = 50_us,
                     .fade = 5_us};
    EXPECT_TRUE(std::isfinite(signal(h).peak_slew())) << base;
  }
}

TEST(Harmonic, RisesAsAStepDoes) {
  const Harmonic calm{.base = 40_V, .rise_time = 7_us, .angular_frequency = 1e6_rad_s};
  EXPECT_EQ(signal(calm).pieces(), signal(Step{.level = 40_V, .rise_time = 7_us}).pieces());
  const Harmonic late{.base = 40_V, .rise_time = 8_us, .amplitude = 1_V, .angular_frequency = 1e6_rad_s, .start = 9_us};
  EXPECT_EQ(signal(late).peak_slew(8.5_us), signal(Step{.level = 40_V, .rise_time = 8_us}).peak_slew());
  // With a base of 0 V the rise has no breakpoint.
  EXPECT_EQ(signal(Harmonic{.rise_time = 7_us, .amplitude = 1_V, .angular_frequency = 1e6_rad_s}).pieces().size(), 1U);
}

TEST(Harmonic, FromZeroForEverIsOnePiece) {
  const Signal endless = signal(Harmonic{.base = 1_V, .amplitude = 2_V, .angular_frequency = 3_rad_s, .phase = 0.5});
  EXPECT_EQ(endless.pieces().size(), 1U);
  EXPECT_EQ(endless.hold_level(), 1);
  EXPECT_DOUBLE_EQ(endless.voltage(0), 1 + 2 * std::sin(0.5));
}

TEST(Harmonic, FadesAreContinuousAndMeetWithoutAPieceBetween) {
  // 0.3 + 0.1 is above 0.7 - 0.3 in binary: the fades overlap by rounding only.
  const Signal both = signal(Harmonic{.base = 0, .amplitude = 1, .angular_frequency = 50, .start = 0.1, .end = 0.7, .fade = 0.3});
  ASSERT_EQ(both.pieces().size(), 4U);
  EXPECT_NEAR(both.breakpoints()[2], 0.4, kSineRounding);
  EXPECT_TRUE(std::isfinite(both.peak_slew()));
  EXPECT_EQ(both.voltage_before(0.7), 0);
  // 0.1 + 0.5 is below 1.1 - 0.5: the fades are apart by rounding only.
  EXPECT_EQ(signal(Harmonic{.amplitude = 1, .angular_frequency = 50, .start = 0.1, .end = 1.1, .fade = 0.5}).pieces().size(), 4U);
}

TEST(Harmonic, HardSwitchIsAJump) {
  const Signal hard = signal(Harmonic{.base = 0, .amplitude = 1, .angular_frequency = 1, .phase = 1, .start = 2, .end = 3});
  EXPECT_EQ(hard.pieces().size(), 3U);
  EXPECT_EQ(hard.voltage_before(2), 0);
  EXPECT_DOUBLE_EQ(hard.voltage(2), std::sin(3.0));
  EXPECT_DOUBLE_EQ(hard.voltage_before(3), std::sin(4.0));
  EXPECT_EQ(hard.voltage(3), 0);
  EXPECT_FALSE(std::isfinite(hard.peak_slew()));
}

TEST(Harmonic, FadeLostInTheRoundingOfItsStartIsAHardSwitch) {
  const Signal lost = signal(Harmonic{.amplitude = 1, .angular_frequency = 1, .start = 1, .end = 2, .fade = 1e-20});
  EXPECT_EQ(lost.breakpoints(), (std::vector<double>{0, 1, 2}));
}

TEST(Harmonic, WithoutAmplitudeIsItsBase) {
  EXPECT_EQ(signal(Harmonic{.base = 7, .angular_frequency = 1, .start = 1, .end = 9, .fade = 1}).pieces(),
            Signal::constant(7).pieces());
}

TEST(Harmonic, NamesParameterValueAndRule) {
  const Harmonic good{.base = 1, .amplitude = 1, .angular_frequency = 1, .start = 1, .end = 3, .fade = 1};
  EXPECT_NO_THROW((void)signal(good));
  const auto refused = [&](auto change, const std::vector<std::string>& parts) {
    Harmonic bad = good;
    change(bad);
    expect_invalid([&] { (void)signal(bad); }, parts);
  };
  refused([](Harmonic& h) { h.base = kNaN; }, {"base", "nan V", "finite"});
  refused([](Harmonic& h) { h.rise_time = -1; }, {"rise_time", "-1 s", ">= 0"});
  refused([](Harmonic& h) { h.rise_time = std::numeric_limits<double>::infinity(); }, {"rise_time", "inf s", "finite"});
  refused([](Harmonic& h) { h.amplitude = kNaN; }, {"amplitude", "nan V", "finite"});
  refused([](Harmonic& h) { h.angular_frequency = 0; }, {"angular_frequency", "0 rad/s", "> 0"});
  refused([](Harmonic& h) { h.angular_frequency = kNaN; }, {"angular_frequency", "nan"});
  refused([](Harmonic& h) { h.phase = kNaN; }, {"phase", "nan rad"});
  refused([](Harmonic& h) { h.start = -1; }, {"start", "-1 s", ">= 0"});
  refused([](Harmonic& h) { h.end = 1; }, {"end", "1 s", "after"});
  refused([](Harmonic& h) { h.end = kNaN; }, {"end", "nan"});
  refused([](Harmonic& h) { h.fade = -1; }, {"fade", "-1 s", ">= 0"});
  refused([](Harmonic& h) { h.fade = 1.001; }, {"fade", "1.001 s", "half"});
}

}  // namespace
}  // namespace softland
