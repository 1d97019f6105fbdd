#include "waveforms/waveform.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/waveforms/expect_invalid.h"

namespace softland {
namespace {

TEST(Waveform, CompilesLikeItsFamily) {
  for_each_family([]<class Family>(const Family&) {
    const Family example = FamilyOf<Family>::example();
    EXPECT_EQ(signal(Waveform(example)).pieces(), signal(example).pieces()) << FamilyOf<Family>::name;
    EXPECT_EQ(family(example), FamilyOf<Family>::name);
  });
}

TEST(Waveform, ScaledIsTheSameCourseInOtherUnits) {
  constexpr double volts = 1.04, time = 0.97;
  for_each_family([]<class Family>(const Family&) {
    const Waveform waveform = FamilyOf<Family>::example(), other = scaled(waveform, volts, time);
    ASSERT_EQ(other.index(), waveform.index());
    const Signal own = signal(waveform), in_units = signal(other);
    EXPECT_GT(own.peak(), 0.5) << family(waveform) << ": the example shows nothing";
    for (double t = 0.0131; t < 12; t += 0.173)
      EXPECT_NEAR(in_units.voltage(t * time), volts * own.voltage(t), 1e-12) << family(waveform) << " at " << t;
    EXPECT_EQ(signal(scaled(waveform, 1, 1)).pieces(), own.pieces()) << family(waveform);
  });
}

TEST(Waveform, PassesOnWhatItsFamilyRefuses) {
  test::expect_invalid([] { (void)signal(Waveform(Step{.rise_time = -1})); }, {"rise_time", "-1 s"});
}

// Rises and first edges begin at the level before; all other waveforms jump from it.
TEST(Waveform, BeginsAtTheVoltageBefore) {
  constexpr double before = -7, rounding = 1e-14;
  const std::vector<Waveform> rising{
      Step{.level = 3, .rise_time = 1},
      Harmonic{.base = 1, .rise_time = 0.5, .amplitude = 2, .angular_frequency = 3, .start = 1},
      Harmonic{.rise_time = 0.5, .amplitude = 2, .angular_frequency = 3, .start = 1},
      Harmonic{.base = 1, .rise_time = 0.5, .angular_frequency = 3},
      Pulse{.levels = {1, -2, 0.5}, .times = {1, 4}, .edge = 0.5},
      SCurve{.levels = {1, -2, 0.5}, .times = {1, 4}, .edge = 0.5},
      Chirp{.base = 1, .rise_time = 0.5, .amplitude = 2, .angular_frequency = 3, .frequency_ratio = 2, .start = 1, .end = 4},
      Sines{.base = 1, .rise_time = 0.5, .amplitudes = {0.5, 2}, .start = 1, .duration = 3}};
  for (const Waveform& waveform : rising) {
    const Signal from_zero = signal(waveform), s = signal(waveform, before);
    EXPECT_EQ(s.before(), before) << family(waveform);
    EXPECT_EQ(s.voltage(-1), before) << family(waveform);
    EXPECT_NEAR(s.voltage(0), before, -rounding * before) << family(waveform);
    EXPECT_EQ(s.voltage_before(0), s.voltage(0)) << family(waveform);
    EXPECT_EQ(s.hold_level(), from_zero.hold_level()) << family(waveform);
    EXPECT_EQ(s.minimum(0.01), before) << family(waveform);
    for (const double time : {1.0, 2.3, 5.0}) EXPECT_EQ(s.voltage(time), from_zero.voltage(time)) << family(waveform);
  }
  const std::vector<Waveform> jumping{Step{.level = 3}, Table{.time = {0, 1}, .voltage = {1, 2}},
                                      BSpline{.levels = {1, 2, 0, 1}, .duration = 3}};
  for (const Waveform& waveform : jumping) {
    const Signal from_zero = signal(waveform), s = signal(waveform, before);
    EXPECT_EQ(s.voltage_before(0), before) << family(waveform);
    EXPECT_TRUE(std::isinf(s.peak_slew())) << family(waveform);
    EXPECT_EQ(s.pieces(), from_zero.pieces()) << family(waveform);
  }
}

TEST(Waveform, ThatGoesOnAsItHasStoodDoesNotJump) {
  const Signal s = signal(Step{.level = 3}, 3);
  EXPECT_EQ(s.peak_slew(), 0);
  EXPECT_EQ(s.minimum(), 3);
  EXPECT_FALSE(signal(Step{.level = 0}, 3).is_zero());
  EXPECT_THROW((void)signal(Step{.level = 3}, std::nan("")), InvalidInput);
}

}  // namespace
}  // namespace softland
