// Tests the cost of a device in a robust search: every figure relative to the plain step on the nominal device.
#include "studies/search/robust_cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "studies/devices/robustness.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

// The cost of a device with given figures, for one target.
class Score {
 public:
  explicit Score(Target target)
      : setting_(search_setting(gold({"simulate.duration=150 us", "structure.modes=2"}), target, Actuator::electrostatic, "pulse",
                                {})),
        cost_(setting_, aim_, {}) {}

  double operator()(const DeviceOutcome& outcome) const { return cost_.score(outcome); }

 private:
  SearchSetting setting_;
  RobustAim aim_{.measure = parse_robust_measure("worst", device_figures), .conditions = {}};
  RobustCost cost_;
};

DeviceOutcome device() {
  DeviceOutcome o;
  o.metrics.largest_impact_velocity = 0.05;
  o.metrics.status = Status::done;
  o.metrics.settled = true;
  o.metrics.initial_contact_time = 40e-6;
  o.metrics.permanent_contact_time = 60e-6;
  o.metrics.major_bounce_height = 100e-9;
  o.metrics.bounce_count = 6;
  o.metrics.impact_energy = 1e-15;
  o.metrics.peak_contact_force = 1e-6;
  o.metrics.drive_energy = 1e-12;
  o.metrics.steady_force_time = 50e-6;
  return o;
}

TEST(RobustCost, IsInProportionToTheFigureThatTheTargetIsAbout) {
  const std::map<Target, double Metrics::*> figures{
      {Target::rebound, &Metrics::major_bounce_height}, {Target::settling, &Metrics::permanent_contact_time},
      {Target::energy, &Metrics::impact_energy},        {Target::force, &Metrics::peak_contact_force},
      {Target::drive, &Metrics::drive_energy},          {Target::steady, &Metrics::steady_force_time}};
  for (const auto& [target, figure] : figures) {
    const Score score(target);
    DeviceOutcome other = device();
    const double own = score(other);
    EXPECT_GT(own, 0);
    other.metrics.largest_impact_velocity *= 3;
    other.metrics.bounce_count *= 3;
    EXPECT_EQ(score(other), own) << "of another target";
    other.metrics.*figure *= 2;
    EXPECT_NEAR(score(other), 2 * own, 1e-12 * own) << static_cast<int>(target);
  }
  DeviceOutcome more = device(), faster = device();
  more.metrics.bounce_count *= 2;
  faster.metrics.largest_impact_velocity *= 2;
  const Score count(Target::count), impact(Target::impact), bounce(Target::bounce), rebound(Target::rebound);
  EXPECT_NEAR(count(more), 2 * count(device()), 1e-12);
  EXPECT_NEAR(impact(faster), 2 * impact(device()), 1e-12);
  EXPECT_NEAR(bounce(device()), (impact(device()) + rebound(device())) / 2, 1e-12);
}

TEST(RobustCost, TakesWhatHasNotSettledForLater) {
  const Score score(Target::settling);
  DeviceOutcome o = device();
  const double own = score(o);
  o.metrics.settled = false;
  o.metrics.permanent_contact_time = Metrics::unset;
  EXPECT_GT(score(o), own);
  o.metrics.major_bounce_height = Metrics::unset;
  EXPECT_GT(score(o), RobustCost::not_closed - 1e-12) << "nor closed";
}

TEST(RobustCost, TakesAForceThatIsNotSteadyForLater) {
  const Score score(Target::steady);
  DeviceOutcome o = device();
  const double own = score(o);
  o.metrics.steady_force_time = Metrics::unset;
  EXPECT_GT(score(o), own);
  EXPECT_LT(score(o), 20 * own);
}

TEST(RobustCost, TakesAFigureThatIsNotKnownForTheWorst) {
  for (const auto& [target, figure] :
       {std::pair{Target::drive, &Metrics::drive_energy}, std::pair{Target::force, &Metrics::peak_contact_force}}) {
    DeviceOutcome o = device();
    o.metrics.*figure = Metrics::unset;
    EXPECT_EQ(Score(target)(o), RobustCost::not_closed) << to_string(target);
  }
}

// Each further failing device increases the cost. If all devices fail, is_told() is false.
TEST(RobustCost, OfFewerDevicesThatFailIsLess) {
  const SearchSetting setting = search_setting(gold({"simulate.duration=150 us", "structure.modes=2"}), Target::bounce,
                                               Actuator::electrostatic, "pulse", {});
  const auto with = [](std::size_t failing) {
    std::vector<DeviceOutcome> all(20, device());
    for (std::size_t k = 0; k < failing; ++k) {
      if (k % 3 == 0) all[k].failure = "no such device can be described";
      if (k % 3 == 1) all[k].metrics.major_bounce_height = Metrics::unset;  // open
      if (k % 3 == 2) all[k].is_held = false;
    }
    return all;
  };
  for (const char* measure : {"cvar:0.9", "quantile:0.9", "mean+2sigma", "worst"}) {
    const RobustAim aim{.measure = parse_robust_measure(measure, device_figures), .conditions = {}};
    const RobustCost cost(setting, aim, {});
    EXPECT_TRUE(cost.is_told(with(0))) << measure;
    EXPECT_FALSE(cost.is_told(with(20))) << measure;
    for (std::size_t failing = 0; failing < 20; ++failing)
      EXPECT_LT(cost.value(with(failing)), cost.value(with(failing + 1))) << measure << " " << failing;
  }
  const RobustAim yield{.measure = parse_robust_measure("yield:bounce_count == 0", device_figures), .conditions = {}};
  EXPECT_FALSE(RobustCost(setting, yield, {}).is_told(with(0))) << "all of these rebound";
}

// Every measure has the figures that it needs, whatever closings in lanes leave out.
TEST(RobustCost, OfEveryTargetIsKnownOnEveryScene_optimized) {
  int scenes = 0;
  for (const std::string& name : shipped_scenes()) {
    SceneFile file = scene(name.c_str(), {"simulate.accuracy=1e-3"});
    if (!read_scene(file).device.structure.is_rigid()) file.set("structure.modes=2");
    if (!file.written("contact") || file.keys("electrode").empty()) continue;  // no contact, or no electrode to shape
    ++scenes;
    for (const Target target : every_target) {
      const SearchSetting setting = search_setting(with_keys_for(target, file), target, Actuator::electrostatic, "pulse", {});
      const MeasuredUnits known;
      for (const char* measure : {"cvar:0.9", "quantile:0.9", "mean+2sigma", "worst"}) {
        const RobustAim aim{.measure = parse_robust_measure(measure, device_figures), .conditions = {}};
        const RobustCost cost(setting, aim, build_all(Ensemble(setting.given, 16, 1), known, 1, 1));
        const std::vector<DeviceOutcome> outcomes = cost.close(setting.drives({}), 0, cost.devices(), 1);
        EXPECT_TRUE(std::isfinite(cost.value(outcomes))) << name << " " << to_string(target) << " " << measure;
        for (const DeviceOutcome& o : outcomes) {
          if (target == Target::drive && o.closed()) {
            EXPECT_TRUE(std::isfinite(o.metrics.drive_energy)) << name;
          }
          // A device that lands bounce-free and stays closed reaches its steady force.
          if (target == Target::steady && is_bounce_free(o) && o.metrics.least_force_after_touch > 0) {
            EXPECT_TRUE(std::isfinite(o.metrics.steady_force_time)) << name;
          }
        }
      }
    }
  }
  EXPECT_GE(scenes, 5);
}

// The time until the contact is steady costs beyond a free time, but at most as much as the median first touch would.
TEST(RobustCost, PricesTheTimeFromWhichTheContactIsSteady) {
  const SearchSetting setting = search_setting(gold({"simulate.duration=150 us", "structure.modes=2"}), Target::bounce,
                                               Actuator::electrostatic, "pulse", {});
  RobustAim aim{.measure = parse_robust_measure("worst", device_figures), .conditions = {}};
  const RobustCost cost(setting, aim, {});
  DeviceOutcome one = device();
  one.metrics.steady_force_time = 300e-6, one.metrics.end = 400e-6;
  const auto price = [&](double until) {
    aim.free = {.figure = &Metrics::steady_force_time, .until = until};
    const std::vector<DeviceOutcome> all(20, one);
    return cost.value(all, aim) - cost.measured(all, aim);
  };
  constexpr double rounding = 1e-12, never = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(price(never), 0, rounding);
  EXPECT_NEAR(price(300e-6), 0, rounding);
  EXPECT_NEAR(price(200e-6), 0.02 * 0.5, rounding);
  const double of_first_touch = price(0);
  EXPECT_GT(of_first_touch, 0.02);
  EXPECT_NEAR(price(10e-6), of_first_touch, rounding) << "29 would be more";
  one.metrics.steady_force_time = Metrics::unset;
  EXPECT_NEAR(price(200e-6), std::min(0.02, of_first_touch), rounding) << "not steady at the end of its run: the end counts";
}

TEST(RobustCost, LeavesTheTimeFreeThatDevicesWaitUnderThePlainStep) {
  std::vector<DeviceOutcome> all(100, device());
  for (std::size_t k = 0; k < all.size(); ++k) all[k].metrics.steady_force_time = 1e-6 * static_cast<double>(k);
  const FreeTime steady = free_time(all);
  EXPECT_EQ(steady.figure, &Metrics::steady_force_time);
  EXPECT_NEAR(steady.until, 94.5e-6, 1e-6);
  for (std::size_t k = 90; k < all.size(); ++k) all[k].metrics.steady_force_time = Metrics::unset;
  EXPECT_EQ(free_time(all).figure, &Metrics::permanent_contact_time) << "a tenth is never steady";
  for (DeviceOutcome& one : all) one.metrics.permanent_contact_time = Metrics::unset;
  EXPECT_EQ(free_time(all).figure, &Metrics::initial_contact_time) << "nor does any settle";
  for (std::size_t k = 90; k < all.size(); ++k) all[k].failure = "open";
  EXPECT_EQ(free_time(all).until, 0) << "a tenth never touches";
}

}  // namespace
}  // namespace softland
