#include "waveforms/pulse.h"

#include <gtest/gtest.h>

#include "base/literals.h"
#include "tests/support/not_finite.h"
#include "tests/waveforms/expect_invalid.h"

namespace softland {
namespace {

using namespace literals;
using test::expect_invalid;

TEST(Pulse, RunsItsEdgesFromTheSwitchingTimes) {
  const Signal pulse = signal(Pulse{.levels = {2_V, 6_V, 0_V}, .times = {20_us, 41_us}, .edge = 5_us});
  const std::vector<std::pair<double, double>> expected{{0, 0},     {2.5_us, 1},  {5_us, 2},         {12_us, 2},
                                                        {20_us, 2}, {22.5_us, 4}, {25_us, 6},        {40_us, 6},
                                                        {41_us, 6}, {43.5_us, 3}, {41_us + 5_us, 0}, {1, 0}};
  // Relative to 6 V: the roundings of one slope.
  constexpr double tolerance = 1e-14;
  for (const auto& [time, voltage] : expected) EXPECT_NEAR(pulse.voltage(time), voltage, 6 * tolerance) << "t = " << time;
  EXPECT_EQ(pulse.breakpoints(), (std::vector<double>{0, 5_us, 20_us, 20_us + 5_us, 41_us, 41_us + 5_us}));
  for (const double time : pulse.breakpoints()) EXPECT_EQ(pulse.voltage_before(time), pulse.voltage(time)) << "t = " << time;
  EXPECT_EQ(pulse.hold_level(), 0);
}

TEST(Pulse, WithoutEdgesJumps) {
  const Signal pulse = signal(Pulse{.levels = {1_V, -2_V}, .times = {1_us}});
  EXPECT_EQ(pulse.breakpoints(), (std::vector<double>{0, 1_us}));
  EXPECT_EQ(pulse.voltage(0), 1);
  EXPECT_EQ(pulse.voltage_before(1_us), 1);
  EXPECT_EQ(pulse.voltage(1_us), -2);
}

TEST(Pulse, EdgesOfAPicosecondKeepTheirSlope) {
  const Signal pulse = signal(Pulse{.levels = {1_V, 3_V}, .times = {500_us}, .edge = 1e-12});
  // The edge's length is the difference of two times near 500 us, known to 1e-7 of a picosecond.
  constexpr double rounding_of_the_edge = 1e-6;
  EXPECT_NEAR(pulse.peak_slew(), 2e12, 2e12 * rounding_of_the_edge);
  EXPECT_EQ(pulse.voltage(500_us + 1e-12), 3);
}

TEST(Pulse, OfOneLevelIsAStep) {
  EXPECT_EQ(signal(Pulse{.levels = {5_V}, .edge = 2_us}).breakpoints(), (std::vector<double>{0, 2_us}));
  EXPECT_EQ(signal(Pulse{.levels = {5_V}}).pieces(), Signal::constant(5_V).pieces());
}

TEST(Pulse, EdgesThatMeetLeaveNoPieceBetween) {
  const Signal exact = signal(Pulse{.levels = {1, 2, 3}, .times = {1, 2}, .edge = 1});
  EXPECT_EQ(exact.breakpoints(), (std::vector<double>{0, 1, 2, 3}));
  // In binary 0.1 + 0.2 > 0.3, and 0.7 + 0.1 < 0.8: both mean that the edges meet.
  EXPECT_EQ(signal(Pulse{.levels = {1, 2, 3}, .times = {0.2, 0.4}, .edge = 0.2}).breakpoints().size(), 4U);
  EXPECT_EQ(signal(Pulse{.levels = {1, 2}, .times = {0.3}, .edge = 0.1 + 0.2}).breakpoints(),
            (std::vector<double>{0, 0.3, 0.3 + (0.1 + 0.2)}));
  EXPECT_EQ(signal(Pulse{.levels = {1, 2, 5}, .times = {0.7, 0.8}, .edge = 0.1}).breakpoints(),
            (std::vector<double>{0, 0.1, 0.7, 0.8, 0.8 + 0.1}));
}

TEST(Pulse, NamesParameterValueAndRule) {
  expect_invalid([] { (void)signal(Pulse{}); }, {"levels", "must not be empty"});
  expect_invalid([] { (void)signal(Pulse{.levels = {1, 2}}); }, {"times", "0 for 2 levels", "one fewer"});
  expect_invalid([] { (void)signal(Pulse{.levels = {1, kNaN}, .times = {1}}); }, {"level 2", "nan V"});
  expect_invalid([] { (void)signal(Pulse{.levels = {kNaN, 1}, .times = {1}}); }, {"level 1", "nan V"});
  expect_invalid([] { (void)signal(Pulse{.levels = {1, 2}, .times = {kNaN}}); }, {"time 1", "nan s"});
  expect_invalid([] { (void)signal(Pulse{.levels = {1}, .edge = -1}); }, {"edge", "-1 s", ">= 0"});
  expect_invalid([] { (void)signal(Pulse{.levels = {1, 2}, .times = {1}, .edge = 2}); }, {"time 1", "1 s", "at least 2 s"});
  expect_invalid([] { (void)signal(Pulse{.levels = {1, 2, 3}, .times = {3, 4}, .edge = 2}); }, {"time 2", "4 s", "at least 5 s"});
  expect_invalid([] { (void)signal(Pulse{.levels = {1, 2, 3}, .times = {3, 2}}); }, {"time 2", "2 s", "at least 3 s"});
}

}  // namespace
}  // namespace softland
