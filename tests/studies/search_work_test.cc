// Budgets of searches by computing work.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "studies/search/robust_search_study.h"
#include "studies/search/search_budget.h"
#include "studies/search/search_request.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

// A source with this sample rate, each sample of which is a breakpoint.
SceneFile sampled_gold(const std::string& rate) {
  return gold({"structure.modes=2", "simulate.accuracy=1e-3", "simulate.duration=200 us", "waveform.main.level=18 V",
               "driver.main={max_voltage=\"25 V\", sample_rate=\"" + rate + "\", bits=14, bandwidth=\"1 MHz\"}",
               "spread={\"driver.main.gain\"={distribution=\"normal\", cov=\"0.5 %\"}, "
               "gaps={keys=[\"gap.electrode\", \"gap.contact\"], distribution=\"normal\", cov=\"2 %\"}}"});
}

SearchSetting setting_of(const SceneFile& file, Actuator actuator = Actuator::electrostatic) {
  const std::string family(families_of(std::string(default_families(shaped_drives(file, actuator)))).front());
  return search_setting(file, Target::bounce, actuator, family, {});
}

TEST(SearchWork, LeavesABudgetOfUsualClosingsAsItIs) {
  EXPECT_EQ(within_work(5000, 100, 3000), 5000);
  EXPECT_EQ(within_work(5000, 3000, 3000), 5000);
  EXPECT_EQ(within_work(5000, 30'000, 3000), 500);
  EXPECT_EQ(within_work(5000, 1e12, 3000), 1) << "at least one";
  EXPECT_EQ(within_work(5000, std::nan(""), 3000), 5000);
}

// Shipped scenes have the usual budget, unless their closings are slow.
TEST(SearchWork, OfShippedScenesIsUsualWhereTheirClosingsAreQuick) {
  for (const char* name : {"mem-gold.toml", "mem-gold-pzt.toml", "mem-gold-modes.toml", "two-electrodes.toml", "nem-tin.toml",
                           "purdue-nickel.toml", "gap-closing-actuator.toml"}) {
    const SceneFile file = scene(name);
    for (const Actuator actuator : {Actuator::electrostatic, Actuator::pzt, Actuator::both}) {
      std::optional<SearchSetting> setting;
      try {
        setting.emplace(setting_of(file, actuator));
      } catch (const InvalidInput&) {
        continue;  // the scene has no such drive
      }
      const double work = closing_work(*setting).counted;
      EXPECT_LT(work, usual_work(shaped_drives(file, actuator))) << name << " " << name_of(actuators, actuator);
      EXPECT_GT(work, 0) << name;
    }
  }
}

TEST(SearchWork, GrowsWithTheSamplesOfASource) {
  const double slow = closing_work(setting_of(sampled_gold("25 MHz"))).counted;
  const double quick = closing_work(setting_of(sampled_gold("500 kHz"))).counted;
  EXPECT_GT(slow, 2 * quick);
  EXPECT_EQ(closing_work(setting_of(sampled_gold("25 MHz"))).counted, slow) << "counted, not measured";
}

// For scenes with slow closings evaluations times work stay within the budget of a usual scene.
TEST(SearchWork, OfASlowSceneStaysWithinThatOfAUsualOne_optimized) {
  for (const char* rate : {"2 MHz", "25 MHz"}) {
    SCOPED_TRACE(rate);
    const SceneFile file = sampled_gold(rate);
    const double work = closing_work(setting_of(file)).counted;
    constexpr long budget = 600;
    SearchEstimate told;
    OptimizeOptions options{.family = "pulse", .max_evaluations = budget, .counts_work = true, .seed = 1, .jobs = 2};
    options.on_estimate = [&](const SearchEstimate& estimate) { told = estimate; };
    const double of_pulse = closing_work(search_setting(file, Target::bounce, Actuator::electrostatic, "pulse", {})).counted;
    const double usual = usual_work(Shaped::electrode);
    const OptimizeResult found = optimize(file, options);
    EXPECT_LE(static_cast<double>(found.search.evaluations - 1) * std::max(of_pulse, usual), budget * usual);
    EXPECT_EQ(told.has_fewer, of_pulse > usual);
    EXPECT_LE(found.search.evaluations, told.evaluations);
    EXPECT_GT(told.closing, 0);
    EXPECT_GT(told.seconds, 0);
    EXPECT_GT(work, 0);
  }
}

// Returns the estimate that a search over devices of a slow scene reports. The search is stopped there.
SearchEstimate estimate_over_devices(const SceneFile& file) {
  struct Enough {};
  SearchEstimate told;
  OptimizeOptions options{.family = "knots", .max_evaluations = 5000, .counts_work = true, .jobs = 2};
  options.on_estimate = [&](const SearchEstimate& estimate) { told = estimate; };
  options.on_start = [](const FamilyColumns&) { throw Enough(); };
  try {
    (void)robust_search(file, options, {.families = "knots", .closings = tournament_closings, .counts_work = true});
  } catch (const Enough&) {
  }
  return told;
}

TEST(SearchWork, OverDevicesIsWithinThatOfAUsualScene) {
  const SearchEstimate slow = estimate_over_devices(sampled_gold("50 MHz")),
                       usual = estimate_over_devices(sampled_gold("100 kHz"));
  EXPECT_TRUE(slow.has_fewer);
  EXPECT_FALSE(usual.has_fewer);
  EXPECT_EQ(usual.evaluations, 5000);
  EXPECT_EQ(usual.closings, tournament_closings);
  EXPECT_LT(slow.evaluations, usual.evaluations * 3 / 4);
  EXPECT_LT(slow.closings, usual.closings * 3 / 4);
  EXPECT_GE(static_cast<double>(slow.closings), least_length_of_tournament * static_cast<double>(tournament_closings))
      << "a race still tells something";
  EXPECT_GT(slow.closing, 0);
  EXPECT_GT(slow.seconds, 0);
}

TEST(SearchWork, OfASlowSceneHasItsTableOfDevices_slow) {
  const SceneFile file = sampled_gold("25 MHz");
  ASSERT_GT(closing_work(setting_of(file)).counted, usual_work(Shaped::electrode)) << "a slow scene";
  const OptimizeOptions options{.family = "pulse", .max_evaluations = 300, .counts_work = true, .seed = 1, .jobs = 2};
  const RobustSearchResult found =
      robust_search(file, options, {.verdict = 200, .families = "catch", .closings = tournament_closings, .counts_work = true});
  ASSERT_GE(found.rows.size(), 3U);
  EXPECT_EQ(found.rows[0].name, "plain step");
  EXPECT_EQ(found.rows[2].name, "for the devices");
  EXPECT_EQ(found.verdict.devices, 200U) << "fresh ones, all of them";
}

// An explicit budget is used as it is.
TEST(SearchWork, IsNotCountedWhereABudgetIsGiven) {
  const SceneFile file = gold();
  const auto of = [&](const std::string& robust, const std::optional<std::string>& budget) {
    return planned(completed({.robust = robust, .budget = budget}, file), file);
  };
  for (const char* robust : {"none", "auto", "cvar:0.9"}) {
    EXPECT_TRUE(of(robust, std::nullopt).options.counts_work) << robust;
    EXPECT_FALSE(of(robust, "900").options.counts_work) << robust;
    EXPECT_FALSE(of(robust, "90 s").options.counts_work) << robust;
  }
  EXPECT_TRUE(of("auto", std::nullopt).for_devices->counts_work);
  EXPECT_FALSE(of("auto", "900").for_devices->counts_work);
}

}  // namespace
}  // namespace softland
