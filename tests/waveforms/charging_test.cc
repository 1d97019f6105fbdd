// Oracles: closed forms of the sum of all rises of V^2, and for every family the same sum over very many samples.
#include "waveforms/charging.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/literals.h"
#include "expect_invalid.h"
#include "waveforms/waveform.h"

namespace softland::charging_test {
namespace {

using namespace literals;

constexpr double rounding = 1e-12;  // relative

TEST(Charging, OfAStepIsHalfTheSquareAndOfADischargeNothing) {
  EXPECT_DOUBLE_EQ(charging(signal(Step{.level = 3}), 1_us), 4.5);
  EXPECT_DOUBLE_EQ(charging(signal(Step{.level = 3, .rise_time = 2_us}), 5_us), 4.5);
  EXPECT_DOUBLE_EQ(charging(signal(Step{.level = 3, .rise_time = 2_us}), 1_us), 4.5 / 4) << "half of the way";
  EXPECT_DOUBLE_EQ(charging(Signal::constant(0, 3), 1_us), 0);
  EXPECT_DOUBLE_EQ(charging(Signal::standing(3), 1_us), 0);
}

TEST(Charging, CountsEveryRiseAndThroughZeroTheWholeSquare) {
  const Signal pulse = signal(Pulse{.levels = {1_V, -2_V, 0_V, 3_V}, .times = {1_us, 2_us, 3_us}, .edge = 0.1_us});
  EXPECT_NEAR(charging(pulse, 10_us), (1 + 4 + 9) / 2.0, 7 * rounding);
  const Signal jumps = signal(Pulse{.levels = {1_V, -2_V, 0_V, 3_V}, .times = {1_us, 2_us, 3_us}});
  EXPECT_NEAR(charging(jumps, 10_us), (1 + 4 + 9) / 2.0, 7 * rounding);
  EXPECT_NEAR(charging(pulse, 1.5_us), (1 + 4) / 2.0, 7 * rounding) << "up to the end of a window";
}

TEST(Charging, OfASineIsHalfTheSquareOfTheAmplitudeTwiceAPeriod) {
  constexpr double omega = 1e6, amplitude = 0.7, periods = 12;
  const Signal sine = signal(Harmonic{.amplitude = amplitude, .angular_frequency = omega});
  EXPECT_NEAR(charging(sine, periods * 2 * std::numbers::pi / omega), 2 * periods * amplitude * amplitude / 2, 1e-9);
}

TEST(Charging, IsTheSumOverSamplesForEveryFamily) {
  const std::vector<Waveform> all{Chirp{.base = 1, .amplitude = 2, .angular_frequency = 2e5, .frequency_ratio = 3, .end = 80_us},
                                  SCurve{.levels = {4, -1, 2}, .times = {30_us, 60_us}, .edge = 20_us},
                                  BSpline{.levels = {0, 3, -2, 1, 2}, .duration = 60_us},
                                  Sines{.base = 1, .amplitudes = {0.5, -1, 0.25}, .duration = 60_us},
                                  Table{.time = {0, 10_us, 10_us, 40_us}, .voltage = {1, 2, -3, 0.5}}};
  for (const Waveform& waveform : all) {
    const Signal one = signal(waveform, -0.5);
    constexpr double end = 100_us;
    constexpr int samples = 2'000'000;
    double sum = 0, last = one.before();
    const auto reach = [&](double v) {
      if (v * last < 0) last = 0;
      sum += std::max(0.0, v * v - last * last) / 2;
      last = v;
    };
    for (int k = 0; k <= samples; ++k) reach(one.voltage(end * k / samples));
    constexpr double sampled = 1e-5;  // a corner or a jump between two samples
    EXPECT_NEAR(charging(one, end), sum, sampled * sum) << family(waveform);
  }
}

TEST(Charging, NeedsAnEnd) {
  test::expect_invalid([] { (void)charging(Signal::constant(1), -1); }, {"finite"});
  test::expect_invalid([] { (void)charging(Signal::constant(1), std::numeric_limits<double>::infinity()); }, {"finite"});
}

}  // namespace
}  // namespace softland::charging_test
