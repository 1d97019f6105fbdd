// A search over varied devices, with small budgets: what holds for any winner.
#include "studies/search/robust_optimize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "sampling/statistics.h"
#include "scenes.h"

namespace softland::robust_optimize_test {
namespace {

SceneFile quick() { return gold({"simulate.duration=150 us"}); }

RobustAim aim(std::string_view measure, std::initializer_list<std::string_view> conditions = {}) {
  const std::span<const Figure> figures = device_figures;
  RobustAim all{.measure = parse_robust_measure(measure, figures), .conditions = {}};
  for (const std::string_view text : conditions) all.conditions.push_back(parse_condition(text, figures));
  return all;
}

struct Log {
  std::map<long, Evaluation> evaluations;
  RobustResult result;
};

Log search(const SceneFile& file, const RobustAim& what, int jobs = 2, long closings = 3500) {
  std::map<long, Evaluation> seen;
  OptimizeOptions options{.max_evaluations = closings, .jobs = jobs};
  options.on_evaluation = [&](const Evaluation& e, const OptimizeProgress&) { seen[e.index] = e; };
  RobustResult result = robust_optimize(file, options, {.aim = what, .samples = 40, .verdict = 60});
  return {std::move(seen), std::move(result)};
}

const Log& reference() {
  static const Log log = search(quick(), aim("cvar:0.9"));
  return log;
}

TEST(RobustOptimize, DoesBetterOnFreshDevicesThanTheStep_optimized) {
  const OptimizeResult& found = reference().result.found;
  ASSERT_TRUE(found.best && reference().result.verdict);
  EXPECT_TRUE(found.better_than_baseline);
  EXPECT_EQ(found.goal_met, found.best->metrics.settled && found.best->metrics.bounce_count == 0);
  EXPECT_LT(found.best_cost, 0.6 * found.baseline_cost);
  const std::vector<DriveRobustness>& drives = reference().result.verdict->drives;
  ASSERT_EQ(drives.size(), 2U);
  EXPECT_EQ(drives[0].name, "plain step");
  EXPECT_EQ(drives[1].outcomes.size(), 60U);
  // best.toml has the winner's drives.
  EXPECT_EQ(drives[1].waveforms.size(), found.best_scene->drives.waveforms().size());
  EXPECT_EQ(signal(drives[1].waveforms.at("main")).pieces(), found.best_scene->signals()[0].pieces());
}

TEST(RobustOptimize, GivesTheSameBitsWhateverTheNumberOfJobs_optimized) {
  const Log one = search(quick(), aim("cvar:0.9"), 1);
  ASSERT_EQ(one.evaluations.size(), reference().evaluations.size());
  for (const auto& [index, e] : reference().evaluations) {
    ASSERT_TRUE(one.evaluations.contains(index)) << index;
    EXPECT_EQ(one.evaluations.at(index).x, e.x) << index;
    EXPECT_EQ(one.evaluations.at(index).value, e.value) << index;
  }
  EXPECT_EQ(one.result.found.parameters, reference().result.found.parameters);
  EXPECT_EQ(one.result.found.best_cost, reference().result.found.best_cost);
  EXPECT_EQ(one.result.findings.closings, reference().result.findings.closings);
}

TEST(RobustOptimize, KeepsToItsBudgetOfClosings_optimized) {
  EXPECT_LE(reference().result.findings.closings, 3500 + 7 * 40) << "a search ends with the candidate that it is at";
  EXPECT_GT(reference().result.findings.closings, 2500);
}

TEST(RobustOptimize, SaysWhichConditionsHold_optimized) {
  const Log log = search(quick(), aim("mean+2sigma", {"initial_contact_time < 1 ms", "v_max < 1 um/s"}));
  const std::vector<FulfilledCondition>& conditions = log.result.findings.conditions;
  ASSERT_EQ(conditions.size(), 2U);
  EXPECT_TRUE(conditions[0].holds);
  EXPECT_EQ(conditions[0].share.value, 1);
  EXPECT_FALSE(conditions[1].holds);
  EXPECT_EQ(conditions[1].share.value, 0);
  EXPECT_FALSE(log.result.found.goal_met);
}

TEST(RobustOptimize, KeepsAConditionThatItCanKeep_optimized) {
  // The winner without the condition touches later.
  std::vector<double> times;
  for (const DeviceOutcome& o : reference().result.verdict->drives[1].outcomes) times.push_back(o.metrics.initial_contact_time);
  ASSERT_GT(sample_quantile(times, 0.95), 39e-6);
  const Log log = search(quick(), aim("cvar:0.9", {"t_i < 39 us"}));
  times.clear();
  for (const DeviceOutcome& o : log.result.verdict->drives[1].outcomes) times.push_back(o.metrics.initial_contact_time);
  EXPECT_LT(sample_quantile(times, 0.9), 39e-6);
}

TEST(RobustOptimize, OfAYieldSaysHowManyDevicesHaveIt_optimized) {
  const Log log = search(quick(), aim("yield:v_max < 50 mm/s"));
  const std::optional<FulfilledCondition>& yield = log.result.findings.yield;
  ASSERT_TRUE(yield && log.result.verdict);
  const auto& outcomes = log.result.verdict->drives[1].outcomes;
  const auto good = std::count_if(outcomes.begin(), outcomes.end(),
                                  [](const DeviceOutcome& o) { return o.metrics.largest_impact_velocity < 0.05; });
  EXPECT_EQ(yield->share.devices, static_cast<std::size_t>(good));
  EXPECT_GT(yield->share.value, 0.5);
}

TEST(RobustOptimize, OfACalibratedSwitchLandsWhatFixedVoltsCannot_slow) {
  SceneFile file = quick();
  for (const char* set : {"calibration.Vdp.error=\"0 %\"", "calibration.frequency.error=\"0 %\""}) file.set(set);
  const Log log = search(file, aim("cvar:0.9"));
  ASSERT_TRUE(log.result.verdict);
  EXPECT_LT(log.result.found.best_cost, 0.8 * reference().result.found.best_cost);
  EXPECT_EQ(log.result.verdict->by_knowledge.size(), 7U) << "nothing, each alone, both in 4, 8 and 16 classes, both";
}

TEST(RobustOptimize, SpendsABudgetOfTimeOnAllOfItsRounds_slow) {
  // This clock counts its readings, one per evaluation, so that the time limit does not depend on the machine.
  double looks = 0;
  long on_all_devices = 0;
  OptimizeOptions options{.max_evaluations = 1'000'000'000, .max_seconds = 120, .jobs = 1};
  options.on_evaluation = [&](const Evaluation&, const OptimizeProgress&) { ++on_all_devices; };
  const RobustResult result = robust_optimize(
      quick(), options, {.aim = aim("cvar:0.9"), .samples = 40, .verdict = 60, .clock = [&looks] { return looks++; }});
  EXPECT_EQ(result.found.search.termination, Termination::time_budget);
  ASSERT_TRUE(result.verdict);
  // The starts and the ends of the first round are at most 18. The others evaluate every candidate on all devices, in three
  // fifths of the time.
  EXPECT_GT(on_all_devices, 50);
}

TEST(RobustOptimize, NeedsASpread) {
  EXPECT_NE(
      refusal([] { static_cast<void>(search(without(quick(), "spread"), aim("worst"))); }).find("a [spread] section must say"),
      std::string::npos);
}

TEST(RobustOptimize, EndsWhenAsked_optimized) {
  std::atomic<bool> stop = false;
  OptimizeOptions options{.max_evaluations = 1'000'000'000, .jobs = 2, .stop = &stop};
  options.on_evaluation = [&](const Evaluation&, const OptimizeProgress& p) { stop = p.evaluations > 2500; };
  const RobustResult result = robust_optimize(quick(), options, {.aim = aim("cvar:0.9"), .samples = 40, .verdict = 60});
  EXPECT_EQ(result.found.search.termination, Termination::interrupted);
  ASSERT_TRUE(result.found.best) << "what there is is kept";
  EXPECT_FALSE(result.verdict);
}

}  // namespace
}  // namespace softland::robust_optimize_test
