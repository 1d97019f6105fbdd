// The search for varied devices, with short stages.
#include "studies/search/robust_search_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <initializer_list>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "studies/closing/auto_settings.h"
#include "studies/closing/plain_step.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

SceneFile quick_gold(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = gold({"simulate.duration=200 us", "structure.modes=2", "simulate.accuracy=1e-3", "waveform.main.level=18 V",
                         "driver.main.max_voltage=25 V"});
  for (const std::string_view change : changes) file.set(change);
  return file;
}

// A memory without content that records the families of the points it is asked for.
class Asked final : public EvaluationMemory {
 public:
  std::optional<EvaluationValues> recall(const EvaluationKey& key) noexcept override {
    const std::scoped_lock lock(mutex_);
    (key.devices > 0 ? on_devices : on_drawing).insert(key.family);
    alike = alike && key.family < columns.families.size() && key.x.size() == columns.families[key.family].size();
    return std::nullopt;
  }
  void note(const EvaluationKey&, const EvaluationValues&) noexcept override {}

  FamilyColumns columns;  // columns of the search
  std::set<std::size_t> on_drawing, on_devices;
  bool alike = true;  // true if all points have as many parameters as their family has columns

 private:
  std::mutex mutex_;
};

RobustSearchResult searched(const SceneFile& file, long closings, std::uint64_t seed = 1, int jobs = 2, Asked* memory = nullptr) {
  OptimizeOptions options{.family = "pulse", .max_evaluations = 300, .seed = seed, .jobs = jobs, .memory = memory};
  options.on_start = [memory](const FamilyColumns& columns) {
    if (memory != nullptr) memory->columns = columns;
  };
  return robust_search(file, options, {.verdict = 200, .families = "catch+pulse", .closings = closings});
}

double cost_of(const RobustSearchResult& found, std::string_view row) {
  const auto at = std::ranges::find(found.rows, row, &DevicesRow::name);
  EXPECT_NE(at, found.rows.end()) << row;
  return at->judged.figures[&Metrics::largest_impact_velocity].quantiles[2].value;
}

TEST(RobustSearchStudy, IsSofterThanThePlainStepAndTheNominalDesign_optimized) {
  Asked memory;
  const RobustSearchResult found = searched(quick_gold(), tournament_closings / 4, 1, 2, &memory);
  ASSERT_TRUE(found.best.best_scene);
  EXPECT_FALSE(found.best.plain_step_wins);
  EXPECT_LT(cost_of(found, "for the devices"), 0.7 * cost_of(found, "plain step"));
  EXPECT_LE(cost_of(found, "for the devices"), cost_of(found, "for the drawing"));
  EXPECT_LT(cost_of(found, "Vdp to 1 %"), cost_of(found, "for the devices"));
  // best.toml simulates to the reported figures.
  const Closing again =
      simulate(prepare_and_choose(SceneFile::parse(found.best.best_scene->scene.file.text(), "best.toml")), true);
  EXPECT_EQ(again.metrics.initial_contact_time, found.best.best->metrics.initial_contact_time);
  EXPECT_FALSE(found.findings.spread_assumed);
  EXPECT_TRUE(found.best.best_scene->scene.file.written("spread"));
  // The front contains no dominated point.
  for (std::size_t i = 1; i < found.findings.front.size(); ++i)
    EXPECT_GE(found.findings.front[i].first_touch, found.findings.front[i - 1].first_touch);
  ASSERT_TRUE(found.calibrated);
  const bool by_time = found.findings.measured == "closing time to 50 ns";
  EXPECT_EQ(found.calibrated->written(by_time ? "calibration.time.error" : "calibration.Vdp.error"), by_time ? "50 ns" : "1 %");
  EXPECT_LT(cost_of(found, "closing time to 50 ns"), cost_of(found, "for the devices"));
  for (const DevicesFindings::Row& row : found.findings.rows)
    EXPECT_TRUE(row.at_95.contains(std::string(key_of(&Metrics::steady_force_time)))) << row.name;
  // More measurements on the devices do not increase the impact velocity.
  const auto speed = [&](std::string_view row) { return cost_of(found, row); };
  for (const char* measured : {"Vdp to 1 %", "Vdp and period to 1 %", "Vdp and period to 0.2 %", "closing time to 50 ns"})
    EXPECT_LE(speed(measured), speed("for the devices")) << measured;
  EXPECT_LE(speed("Vdp and period to 1 %"), speed("Vdp to 1 %"));
  EXPECT_LE(speed("Vdp and period to 0.2 %"), speed("Vdp and period to 1 %"));
  for (const CalibrationError& known : found.findings.by_error) EXPECT_LE(known.impact_speed, 1.15 * speed("for the devices"));
  // Stores have the families of the tournament after that of the nominal design. The families of the tournament within the usual
  // limit are last: only that short tournament runs here.
  ASSERT_EQ(memory.columns.families.size(), 5U);
  EXPECT_EQ(memory.columns.families[1].front().substr(0, 14), "devices.catch.");
  EXPECT_TRUE(memory.alike);
  EXPECT_EQ(memory.on_drawing, std::set<std::size_t>{0});
  EXPECT_EQ(memory.columns.families[3].front().substr(0, 26), "devices.usual_limit.catch.");
  EXPECT_EQ(memory.on_devices, (std::set<std::size_t>{3, 4}));
}

// A piezo that moves the switch slowly lands all devices, and the pull-in voltage has no influence on it.
TEST(RobustSearchStudy, AreNotMeasuredWhereThatHasNoValue_optimized) {
  const SceneFile file = gold_pzt({"structure.modes=2", "simulate.accuracy=1e-3"});
  const RobustSearchResult found =
      robust_search(file, {.actuator = Actuator::pzt, .family = "bspline:16", .max_evaluations = 100, .jobs = 2},
                    {.verdict = 200, .families = "quasi-static", .closings = tournament_closings / 10});
  ASSERT_TRUE(found.chosen);
  EXPECT_EQ(found.chosen->family, "quasi-static");
  for (const char* measured : {"Vdp to 1 %", "Vdp and period to 1 %"})
    EXPECT_LE(cost_of(found, measured), cost_of(found, "for the devices")) << measured;
  EXPECT_EQ(found.calibrated.has_value(), !found.findings.measured.empty());
  if (found.calibrated) {
    EXPECT_LT(cost_of(found, found.findings.measured), 0.9 * cost_of(found, "for the devices"));
  }
}

TEST(RobustSearchStudy, HasTheSameBitsWithAnyJobs_slow) {
  const RobustSearchResult one = searched(quick_gold(), tournament_closings / 4, 2, 1),
                           two = searched(quick_gold(), tournament_closings / 4, 2, 2);
  EXPECT_EQ(one.best.best_scene->scene.file.text(), two.best.best_scene->scene.file.text());
  EXPECT_EQ(one.calibrated->text(), two.calibrated->text());
  EXPECT_EQ(one.findings.closings, two.findings.closings);
}

TEST(RobustSearchStudy, RanksTheNominalCandidatesAgainWithoutARace_optimized) {
  const RobustSearchResult found = searched(quick_gold(), 100);
  ASSERT_TRUE(found.chosen);
  EXPECT_EQ(found.chosen->measure, "drawing");
  EXPECT_LE(cost_of(found, "for the devices"), 1.02 * cost_of(found, "plain step"));
}

// Returns the cost of the winner on the devices from which it is chosen.
double least_cost(const SceneFile& file, std::uint64_t seed) {
  const RobustSearchResult found = searched(file, tournament_closings / 2, seed);
  EXPECT_FALSE(found.candidates.empty());
  return found.candidates.front().tail;
}

TEST(RobustSearchStudy, EndNoWorseWithMoreRoom_slow) {
  constexpr double most = 1.03;
  const char* const limit = "driver.main.max_voltage=";
  struct Ladder {
    const char* of;
    std::vector<std::string> steps;
  };
  const std::vector<Ladder> ladders{
      {"volts", {std::string(limit) + "1.5 Vsp", std::string(limit) + "2 Vsp", std::string(limit) + "5 Vsp"}},
      {"window", {"simulate.duration=200 us", "simulate.duration=600 us"}}};
  for (const char* const scene : {"gap.contact=2 um", "gas.pressure=\"10 kPa\"", "gap.contact=1.8 um"}) {
    for (const std::uint64_t seed : {1, 2}) {
      for (const Ladder& ladder : ladders) {
        double narrowest = 0;
        for (const std::string& step : ladder.steps) {
          const double cost = least_cost(quick_gold({scene, step}), seed);
          if (narrowest == 0) narrowest = cost;
          EXPECT_LE(cost, most * narrowest) << scene << ", seed " << seed << ", " << step;
        }
      }
    }
  }
}

TEST(RobustSearchStudy, AssumesASpreadWhereTheSceneHasNone_optimized) {
  SceneFile file = quick_gold();
  file.erase("spread");
  const RobustSearchResult found = searched(file, 100);
  EXPECT_TRUE(found.findings.spread_assumed);
  EXPECT_EQ(found.varied.scene.spread.variables.size(), 3U);
  EXPECT_FALSE(found.best.best_scene->scene.file.written("spread")) << "the scene stays what it was";
}

TEST(RobustSearchStudy, NeverGetAWaveformThatIsWorseThanThePlainStep_optimized) {
  // In this family the step can only rise more slowly.
  const RobustSearchResult found = robust_search(quick_gold(), {.family = "step", .max_evaluations = 100, .jobs = 2},
                                                 {.verdict = 200, .families = "step", .closings = 100});
  ASSERT_TRUE(found.best.best_scene);
  EXPECT_LE(cost_of(found, "for the devices"), 1.01 * cost_of(found, "plain step"));
  EXPECT_EQ(found.best.plain_step_wins, !found.findings.worse_in.empty());
}

TEST(RobustSearchStudy, ClosesDevicesBeforeTheNominalSearch_optimized) {
  for (const int jobs : {1, 2}) {
    std::atomic<long> evaluations = 0, before_first = -1;
    std::vector<double> costs;
    const RobustSearchResult found = robust_search(
        quick_gold(),
        {.family = "pulse",
         .max_evaluations = 100,
         .jobs = jobs,
         .on_evaluation = [&](const Evaluation&, const OptimizeProgress&) { ++evaluations; }},
        {.verdict = 100, .families = "catch+pulse", .closings = tournament_closings / 4, .on_leading = [&](const Leading& one) {
           if (before_first < 0) before_first = evaluations.load();
           EXPECT_EQ(one.own.size(), one.of_step.size());
           const std::string_view speed = key_of(&Metrics::largest_impact_velocity);
           EXPECT_LT(quantile_95(one.own, speed), quantile_95(one.of_step, speed));
           EXPECT_TRUE(one.scene.written("waveform.main.family"));
           costs.push_back(quantile_95(one.own, speed));
         }});
    EXPECT_EQ(before_first, 0) << jobs;
    ASSERT_FALSE(costs.empty());
    EXPECT_LE(costs.back(), 1.02 * costs.front());
  }
}

TEST(RobustSearchStudy, KeepsTheBestSoFarWhenItIsAskedToStop_optimized) {
  std::atomic<bool> stop = false;
  std::string leading;
  const RobustSearchResult found =
      robust_search(quick_gold(), {.family = "pulse", .max_evaluations = 100'000, .jobs = 2, .stop = &stop},
                    {.families = "catch+pulse", .closings = tournament_closings / 4, .on_leading = [&](const Leading& one) {
                       leading = one.scene.text();
                       stop = true;
                     }});
  EXPECT_TRUE(found.interrupted);
  EXPECT_TRUE(found.rows.empty());
  ASSERT_TRUE(found.best.best_scene);
  const PreparedScene told = prepare(SceneFile::parse(leading, "leading"), true);
  EXPECT_TRUE(same_drives(found.best.best_scene->signals(), told.signals()));
  EXPECT_LT(found.best.best_cost, found.best.baseline_cost);
}

TEST(RobustSearchStudy, KeepsTheNominalWinnerWhenItIsStoppedBeforeAnyDevice_optimized) {
  std::atomic<bool> stop = false;
  const RobustSearchResult found =
      robust_search(quick_gold(),
                    {.family = "pulse",
                     .max_evaluations = 100'000,
                     .jobs = 2,
                     .stop = &stop,
                     .on_evaluation = [&](const Evaluation& e, const OptimizeProgress&) { stop = stop || e.index > 50; }},
                    {.families = "catch+pulse", .closings = 100});
  EXPECT_TRUE(found.interrupted);
  EXPECT_TRUE(found.rows.empty());
  EXPECT_TRUE(found.best.best_scene);
}

}  // namespace
}  // namespace softland
