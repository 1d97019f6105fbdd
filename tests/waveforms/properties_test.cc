// Properties of every waveform, tested on random ones.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

#include "tests/support/temporary_folder.h"
#include "waveforms/export.h"
#include "waveforms/waveform.h"

namespace softland {
namespace {

/// Returns a number in [low, high] that is rarely round.
double number(double low, double high) { return low + (high - low) * *rc::gen::inRange(0, 999983) / 999983.0; }

/// Returns rows with jumps, ramps and voltages of very different sizes.
Table random_table() {
  Table table{.time = {0}, .voltage = {number(-5, 5)}};
  const int rows = *rc::gen::inRange(0, 12);
  for (int i = 0; i < rows; ++i) {
    const bool jump = *rc::gen::inRange(0, 3) == 0;
    table.time.push_back(table.time.back() + (jump ? 0 : std::pow(10, number(-12, -3))));
    table.voltage.push_back(number(-1, 1) * std::pow(10, number(-9, 3)));
  }
  return table;
}

Pulse random_pulse() {
  Pulse pulse{.levels = {number(-100, 100)}, .edge = *rc::gen::inRange(0, 2) == 0 ? 0 : std::pow(10, number(-12, -5))};
  double earliest = pulse.edge;
  const int more = *rc::gen::inRange(0, 6);
  for (int i = 0; i < more; ++i) {
    const bool meets = *rc::gen::inRange(0, 3) == 0 && earliest > 0;
    pulse.times.push_back(earliest + (meets ? 0 : std::pow(10, number(-9, -4))));
    pulse.levels.push_back(number(-100, 100));
    earliest = pulse.times.back() + pulse.edge;
  }
  return pulse;
}

/// Returns two pieces with random slopes and envelopes, then a constant.
Signal random_sines() {
  std::vector<SignalPiece> pieces;
  double begin = 0;
  for (int i = 0; i < 2; ++i) {
    pieces.push_back({.begin = begin,
                      .value = number(-2, 2),
                      .slope = number(-3, 3),
                      .amplitude = number(-2, 2),
                      .amplitude_slope = number(-3, 3),
                      .angular_frequency = number(0.1, 30),
                      .phase = number(-10, 10)});
    begin += number(0.01, 2);
  }
  pieces.push_back({.begin = begin});
  return Signal(std::move(pieces));
}

bool reads_back(const Signal& original) {
  const test::TemporaryFolder folder;
  return signal(read_table(folder.write("a.csv", csv({{"a", original}}, 10)), "a")).pieces() == original.pieces();
}

TEST(EveryTable, ReadsBackFromItsExportBitForBit) {
  EXPECT_TRUE(rc::check([] { RC_ASSERT(reads_back(signal(random_table()))); }));
}

TEST(EveryPulse, ReadsBackFromItsExportBitForBit) {
  EXPECT_TRUE(rc::check([] { RC_ASSERT(reads_back(signal(random_pulse()))); }));
}

TEST(EveryPulse, WithEdgesIsContinuousAndWithoutJumpsAtEveryBreakpoint) {
  EXPECT_TRUE(rc::check([] {
    const Pulse pulse = random_pulse();
    const Signal compiled = signal(pulse);
    for (const SignalPiece& piece : compiled.pieces()) {
      const bool jumps = compiled.voltage_before(piece.begin) != compiled.voltage(piece.begin);
      // Neighbouring levels may be equal, and the first may be 0 V.
      RC_ASSERT(pulse.edge == 0 || !jumps);
      RC_ASSERT(pulse.edge > 0 || piece.slope == 0);
    }
    RC_ASSERT(compiled.hold_level() == pulse.levels.back());
  }));
}

TEST(EverySine, StaysWithinItsExtremaAndReachesThem) {
  EXPECT_TRUE(rc::check([] {
    const Signal signal = random_sines();
    const double end = signal.breakpoints().back();
    constexpr int samples = 20000;
    double largest = 0, smallest = 0;
    for (int i = 0; i < samples; ++i) {
      const double voltage = signal.voltage(end * i / samples);
      largest = std::max(largest, voltage);
      smallest = std::min(smallest, voltage);
    }
    for (const double time : signal.breakpoints()) {
      largest = std::max({largest, signal.voltage_before(time), signal.voltage(time)});
      smallest = std::min({smallest, signal.voltage_before(time), signal.voltage(time)});
    }
    // Envelope <= 14, w <= 30, slope <= 3, two pieces of at most 2 s: V'' <= 14 * 30^2 + 2 * 3 * 30, a sample within h / 2 of the
    // extremum.
    const double h = end / samples;
    const double below = h * h / 8 * 13000 + 1e-12;
    RC_ASSERT(signal.maximum() >= largest - 1e-12);
    RC_ASSERT(signal.maximum() <= largest + below);
    RC_ASSERT(signal.minimum() <= smallest + 1e-12);
    RC_ASSERT(signal.minimum() >= smallest - below);
    RC_ASSERT(signal.peak() == std::max(signal.maximum(), -signal.minimum()));
  }));
}

TEST(EveryPolyline, StaysWithinItsTolerance) {
  EXPECT_TRUE(rc::check([] {
    const Signal signal = random_sines();
    const double end = signal.breakpoints().back();
    const double tolerance = std::pow(10, number(-4, 0));
    const auto points = polyline(signal, end, tolerance, 0);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const auto& [t0, v0] = points[i];
      const auto& [t1, v1] = points[i + 1];
      RC_ASSERT(t1 >= t0);
      for (const double share : {0.25, 0.5, 0.75}) {
        const double time = t0 + share * (t1 - t0);
        if (t1 > t0) RC_ASSERT(std::abs(v0 + share * (v1 - v0) - signal.voltage(time)) <= tolerance + 1e-12);
      }
    }
  }));
}

}  // namespace
}  // namespace softland
