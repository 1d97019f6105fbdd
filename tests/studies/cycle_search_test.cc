// The search for a pair of waveforms at a rate. Oracles: the plain pair at that rate, and a new run of the written scene.
#include "studies/search/cycle_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "studies/closing/open_command.h"
#include "studies/search/search_setting.h"

namespace softland::cycle_search_test {
namespace {

using testing::HasSubstr;

// A plate that vibrates for many cycles at 12 kHz.
SceneFile plate(const std::string& rest = "") {
  return SceneFile::parse(R"(
structure = { kind = "plate", mass = "1e-10 kg", stiffness = "10 N/m", area = "1e-8 m^2", damping_ratio = 0.05 }
gap = { electrode = "4 um", contact = "3 um" }
electrode.main.fringing = "none"
contact = { model = "linear", stiffness = "5 kN/m", damping = "0.5 s/m" }
waveform.main = { family = "step", level = "45 V" }
driver.main = { min_voltage = "0 V", max_voltage = "60 V" }
)" + rest,
                          "plate.toml");
}

CycleSearchOptions at(double rate) { return {.rate = rate, .family = "pulse", .max_evaluations = 240, .cycles = 6}; }

double highest(const CycledDrive& drive) {
  double most = 0;
  for (const CycleFigures& cycle : drive.cycles->cycles) most = std::max(most, cycle.metrics.major_bounce_height);
  return most;
}

TEST(CycleSearch, LandsEveryCycleSofterThanThePlainPair) {
  const CycleSearchResult found = search_cycle(plate(), at(8e3));
  ASSERT_TRUE(found.is_better()) << found.cost << " " << found.plain_cost;
  ASSERT_EQ(found.cycling.drives.size(), 2u);
  const CycledDrive &plain = found.cycling.drives.front(), &best = found.cycling.drives.back();
  ASSERT_EQ(best.cycles->cycles.size(), 6u) << best.cycles->message;
  for (const CycleFigures& cycle : best.cycles->cycles) EXPECT_TRUE(cycle.closes && cycle.opens);
  EXPECT_LT(highest(best), 0.5 * highest(plain));
  EXPECT_FALSE(found.interrupted);
}

// best.toml has bit for bit the reported pair of waveforms.
TEST(CycleSearch, LeavesASceneOfOneCycle) {
  const CycleSearchResult found = search_cycle(plate(), at(8e3));
  const PreparedScene p = prepare(found.scene.again("best.toml"));
  const auto command = open_command(p, p.commanded(p.waveforms()));
  ASSERT_TRUE(command);
  EXPECT_EQ(command->time, 0.5 / 8e3);
  CycleWaveforms again{.name = "again", .closing = command->held, .opening = {}};
  for (const Signal& s : p.commanded(p.waveforms()))
    again.opening.push_back(part_from(s, command->time, s.voltage_before(command->time)));
  const Cycles run =
      CycledSwitch(found.given, found.given.model, again).run({.period = 1 / 8e3, .on_time = 0.5 / 8e3, .cycles = 6}, false);
  const Cycles& told = *found.cycling.drives.back().cycles;
  ASSERT_EQ(run.cycles.size(), told.cycles.size());
  for (std::size_t n = 0; n < run.cycles.size(); ++n)
    EXPECT_EQ(run.cycles[n].metrics.largest_impact_velocity, told.cycles[n].metrics.largest_impact_velocity);
}

TEST(CycleSearch, IsTheSameOnTwoThreads) {
  CycleSearchOptions two = at(8e3);
  two.jobs = 2;
  const CycleSearchResult one = search_cycle(plate(), at(8e3)), other = search_cycle(plate(), two);
  EXPECT_EQ(one.cost, other.cost);
  EXPECT_EQ(one.parameters, other.parameters);
}

TEST(CycleSearch, KeepsTheLimitsOfItsDriver) {
  const CycleSearchResult found = search_cycle(plate(), at(8e3));
  for (const Signal& s : cycled(found.cycling.drives.back().waveforms, {.period = 1 / 8e3, .on_time = 0.5 / 8e3, .cycles = 1}))
    EXPECT_TRUE(violation(s, {.min_voltage = 0, .max_voltage = 60 * (1 + 1e-9)}).empty());
}

TEST(CycleSearch, RefusesARateThatNoWaveformFitsInto) {
  try {
    static_cast<void>(search_cycle(plate(), at(1e6)));
    FAIL() << "a cycle of a microsecond";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("at 1 MHz and a duty of 50 % no waveform of the family \"pulse\" fits"));
  }
}

TEST(CycleSearch, EndsWithWhatItHasWhenItIsStopped) {
  std::atomic<bool> stop = false;
  const CycleSearchResult found = search_cycle(plate(), at(8e3), {.stop = &stop, .report = [&](std::string_view what, double) {
                                                                    if (what == "openings") stop = true;
                                                                  }});
  EXPECT_TRUE(found.interrupted);
  EXPECT_FALSE(found.is_better());
  EXPECT_THAT(found.scene.text(), HasSubstr("open_at"));
}

}  // namespace
}  // namespace softland::cycle_search_test
