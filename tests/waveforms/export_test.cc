#include "waveforms/export.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "base/literals.h"
#include "tests/support/not_finite.h"
#include "tests/support/temporary_folder.h"
#include "tests/waveforms/expect_invalid.h"
#include "waveforms/waveform.h"

namespace softland {
namespace {

using namespace literals;
using test::expect_invalid;
using test::TemporaryFolder;
using testing::HasSubstr;
using Points = std::vector<std::pair<double, double>>;

const Step kStep{.level = 45_V};
const Pulse kPulse{.levels = {0.2, 0.6, -0.3, 0}, .times = {20_us, 41_us, 46_us}, .edge = 5_us};
const Table kTable{.time = {0, 3_us, 3_us, 7_us, 7_us}, .voltage = {1, 0.1, 7, 0.3, 2}};
const Harmonic kHarmonic{
    .base = 30, .amplitude = 5, .angular_frequency = 1e6, .phase = 0.7, .start = 7_us, .end = 43_us, .fade = 9_us};

double interpolated(const Points& points, double time) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto& [t0, v0] = points[i];
    const auto& [t1, v1] = points[i + 1];
    if (time >= t0 && time < t1) return v0 + (v1 - v0) * (time - t0) / (t1 - t0);
  }
  return points.back().second;
}

TEST(Polyline, OfASplineThatStaysWhereItIsHasNoCurve) {
  for (const double level : {0.0, 0.7}) {
    const Signal still = signal(BSpline{.levels = std::vector<double>(8, level), .duration = 20e-6});
    const auto points = polyline(still, 30e-6, 0, 0);
    ASSERT_GE(points.size(), 2U);
    for (auto point = points.begin() + (level > 0); point != points.end(); ++point)
      EXPECT_DOUBLE_EQ(point->second, level) << point->first << ", after the jump from 0 V";
  }
}

TEST(Polyline, HasTheExactBreakpointsOfAPulse) {
  EXPECT_EQ(
      polyline(signal(kPulse), 60_us, 0, 0),
      (Points{
          {0, 0}, {5_us, 0.2}, {20_us, 0.2}, {20_us + 5_us, 0.6}, {41_us, 0.6}, {46_us, -0.3}, {46_us + 5_us, 0}, {60_us, 0}}));
}

TEST(Polyline, ShowsAJumpAsTwoPoints) {
  EXPECT_EQ(polyline(signal(kStep), 1_us, 0, 0), (Points{{0, 0}, {0, 45}, {1_us, 45}}));
  EXPECT_EQ(polyline(signal(kStep), 1_us, 0, 1_ns), (Points{{0, 0}, {1_ns, 45}, {1_us, 45}}));
  EXPECT_EQ(polyline(signal(Pulse{.levels = {1, 2}, .times = {1e-6}}), 1e-3, 0, 1e-3),
            (Points{{0, 0}, {1e-3 * 1e-6, 1}, {1e-6, 1}, {1e-6 + 1e-3, 2}}))
      << "a jump takes no more than a thousandth of the interval after it";
  EXPECT_EQ(polyline(signal(Table{.time = {0, 1, 1}, .voltage = {1, 3, 2}}), 2, 0, 0),
            (Points{{0, 0}, {0, 1}, {1, 3}, {1, 2}, {2, 2}}));
}

TEST(Polyline, EndsAtTheEnd) {
  EXPECT_EQ(polyline(signal(Step{.level = 4, .rise_time = 2}), 1, 0, 0), (Points{{0, 0}, {1, 2}}));
  EXPECT_EQ(polyline(signal(Step{.level = 4, .rise_time = 2}), 2, 0, 0), (Points{{0, 0}, {2, 4}}));
  EXPECT_EQ(polyline(signal(kStep), 0, 0, 0), (Points{{0, 0}, {0, 45}}));
  EXPECT_EQ(polyline(Signal(), 0, 0, 0), (Points{{0, 0}}));
}

TEST(Polyline, StaysWithinItsToleranceOfASineAndIsNotWasteful) {
  const Signal sine = signal(kHarmonic);
  for (const double tolerance : {1e-1, 1e-2, 1e-4}) {
    const Points points = polyline(sine, 60_us, tolerance, 0);
    double worst = 0;
    constexpr int samples = 20011;
    for (int i = 0; i <= samples; ++i) {
      const double time = 60_us * i / samples;
      worst = std::max(worst, std::abs(interpolated(points, time) - sine.voltage(time)));
    }
    EXPECT_LE(worst, tolerance);
    // Chords have equal length within a piece, so that a coarse polyline with an odd number of them may miss the extrema.
    constexpr double wasteful = 0.5;
    EXPECT_GE(worst, wasteful * tolerance);
  }
}

TEST(Polyline, RefusesWhatHasNoEnd) {
  const Signal sine = signal(kHarmonic);
  expect_invalid([&] { (void)polyline(sine, -1, 1, 0); }, {"-1 s", ">= 0"});
  expect_invalid([&] { (void)polyline(sine, std::numeric_limits<double>::infinity(), 1, 0); }, {"inf s", "finite"});
  expect_invalid([&] { (void)polyline(sine, 1, 1, kNaN); }, {"jump_time", "nan s"});
  expect_invalid([&] { (void)polyline(sine, 1, 0, 0); }, {"tolerance", "0 V", "> 0"});
  expect_invalid([&] { (void)polyline(sine, 1, kNaN, 0); }, {"tolerance", "nan V"});
  expect_invalid([&] { (void)polyline(sine, 1, 1e-30, 0); }, {"1e-30 V", "points"});
}

TEST(Csv, ReadsBackToTheSameSignalBitForBit) {
  const TemporaryFolder folder;
  for (const Waveform& waveform : {Waveform(kStep), Waveform(Step{.level = 0.7, .rise_time = 0.3}), Waveform(kPulse),
                                   Waveform(kTable), Waveform(Pulse{.levels = {1, 2, 1}, .times = {1, 2}})}) {
    const Signal original = signal(waveform);
    const std::string file = folder.write("one.csv", csv({{"main", original}}, 60));
    EXPECT_EQ(signal(read_table(file, "main")).pieces(), original.pieces()) << family(waveform);
  }
}

TEST(Csv, RampBeforeAJumpReadsBackBitForBit) {
  // The end of these ramps, computed from the slope, differs by rounding; the slope must still be kept.
  const TemporaryFolder folder;
  for (const auto& [t0, v0, t1, v1] :
       {std::array{9.6, 1.6, 14.8, 9.3}, {7.2, 4.9, 13.9, 3.1}, {0.5, 2.1, 6.2, 8.0}, {1.9, 0.3, 9.0, 4.0}}) {
    const Signal original = signal(Table{.time = {0, t0, t1, t1}, .voltage = {0, v0, v1, -1}});
    const std::string file = folder.write("ramp.csv", csv({{"main", original}}, 60));
    EXPECT_EQ(signal(read_table(file, "main")).pieces(), original.pieces()) << t0;
  }
}

TEST(Csv, HasAllDrivesOnTheUnionOfTheirBreakpoints) {
  EXPECT_EQ(
      csv({{"main", signal(Step{.level = 4, .rise_time = 2})}, {"piezo", signal(Pulse{.levels = {1, 0.1}, .times = {1}})}}, 3),
      "time_s,main,piezo\n0,0,0\n0,0,1\n1,2,1\n1,2,0.1\n2,4,0.1\n3,4,0.1\n");
}

TEST(Csv, SamplesASineToATenThousandthOfThePeak) {
  const TemporaryFolder folder;
  const Signal original = signal(kHarmonic);
  const Signal read = signal(read_table(folder.write("sine.csv", csv({{"main", original}}, 60_us)), "main"));
  const double promised = 1e-4 * original.peak();
  constexpr int samples = 20011;
  for (int i = 0; i <= samples; ++i) {
    const double time = 60_us * i / samples;
    ASSERT_NEAR(read.voltage(time), original.voltage(time), promised);
  }
}

TEST(Csv, RefusesNamesThatBreakTheHeader) {
  expect_invalid([] { (void)csv({}, 1); }, {"at least one waveform"});
  expect_invalid([] { (void)csv({{"a,b", Signal()}}, 1); }, {"\"a,b\"", "comma"});
  expect_invalid([] { (void)csv({{"", Signal()}}, 1); }, {"\"\"", "empty"});
  expect_invalid([] { (void)csv({{"a", Signal()}}, kNaN); }, {"nan s"});
}

TEST(SpicePwl, HasOneSubcircuitPerDrive) {
  const std::string text = spice_pwl({{"main", signal(kStep)}, {"Top-2", Signal()}}, 1e-4);
  EXPECT_THAT(text,
              HasSubstr(".subckt softland_main plus minus\nVdrive plus minus PWL(\n+ 0 0\n+ 1e-12 45\n+ 0.0001 45\n+ )\n.ends"));
  EXPECT_THAT(spice_pwl({{"main", signal(kStep)}}, 1e-9), testing::Not(HasSubstr("1e-12"))) << "of a switch of nanoseconds";
  EXPECT_THAT(text, HasSubstr(".subckt softland_top_2 plus minus\n"));
  expect_invalid([] { (void)spice_pwl({{"a-b", Signal()}, {"A_B", Signal()}}, 1); }, {"\"a-b\"", "softland_a_b"});
  expect_invalid([] { (void)spice_pwl({}, 1); }, {"at least one waveform"});
}

TEST(SpicePwl, TimesIncreaseStrictlyEvenWhenJumpsAreARoundingErrorApart) {
  const double next = std::nextafter(1.0, 2.0);
  const std::string text =
      spice_pwl({{"a", signal(Table{.time = {0, 1, 1, next, next, 1.5}, .voltage = {1, 1, 2, 2, 3, 4}})}}, 2);
  double last = -1;
  for (std::size_t at = text.find("\n+ "); text.compare(at, 4, "\n+ )") != 0; at = text.find("\n+ ", at + 1)) {
    const double time = std::strtod(text.c_str() + at + 3, nullptr);
    EXPECT_GT(time, last);
    last = time;
  }
  EXPECT_EQ(last, 2);
}

TEST(SpicePwl, RunsInNgspiceAndGivesTheSignal_optimized) {
  if (std::system("command -v ngspice >/dev/null 2>&1") != 0) GTEST_SKIP() << "skipped: no circuit simulator; needs: ngspice";
  const std::map<std::string, Signal> signals{
      {"jumps", signal(kTable)}, {"pulse", signal(kPulse)}, {"sine", signal(kHarmonic)}, {"step", signal(kStep)}};
  const TemporaryFolder folder;
  (void)folder.write("drives.cir", spice_pwl(signals, 60_us));
  std::string deck = "softland drives into resistors\n.include drives.cir\n";
  std::string outputs;
  for (const auto& [drive, one] : signals) {
    deck += fmt::format("X{0} {0} 0 softland_{0}\nR{0} {0} 0 1k\n", drive);
    outputs += " v(" + drive + ")";
  }
  deck += fmt::format(
      ".tran 20n 60u 0 20n\n.control\nset numdgt=15\nset wr_singlescale\nrun\nwrdata out.txt{}\nquit 0\n.endc\n.end\n", outputs);
  (void)folder.write("deck.cir", deck);
  const std::string command = fmt::format("cd '{}' && ngspice -b deck.cir >log.txt 2>&1", folder.path(""));
  ASSERT_EQ(std::system(command.c_str()), 0) << std::ifstream(folder.path("log.txt")).rdbuf();

  std::ifstream result(folder.path("out.txt"));
  int rows = 0;
  double time = 0;
  while (result >> time) {
    ++rows;
    for (const auto& [drive, one] : signals) {
      double voltage = kNaN;
      ASSERT_TRUE(result >> voltage);
      // ngspice prints times with 15 digits, and merges corners that are closer than 5e-5 of its largest step: a few
      // picoseconds.
      constexpr double same_time = 5e-12;
      bool near_jump = false;
      for (const double b : one.breakpoints())
        near_jump |= one.voltage_before(b) != one.voltage(b) && std::abs(time - b) < same_time;
      if (near_jump) continue;
      // Straight lines between points of a sine have an error of 1e-4 of the peak; elsewhere the error is the slope times a few
      // picoseconds.
      const double exact_to = 1e-9 * one.peak();
      const double tolerance = one.pieces()[one.piece_at(time)].oscillates() ? 1e-4 * one.peak() : exact_to;
      EXPECT_NEAR(voltage, one.voltage(time), tolerance) << drive << " at " << time;
    }
  }
  // 60 us in steps of at most 20 ns.
  EXPECT_GE(rows, 3000);
  EXPECT_NEAR(time, 60_us, 1e-9 * 60_us);
}

}  // namespace
}  // namespace softland
