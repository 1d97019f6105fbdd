// Explorations: every row is bit for bit the result of the verb of its study for the scene of the point.
#include "studies/exploration/exploration.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/executor.h"
#include "base/require.h"
#include "objectives/figures.h"
#include "scenes.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/certify.h"
#include "studies/devices/robustness.h"
#include "studies/exploration/stored_exploration.h"
#include "studies/search/optimize.h"
#include "tests/support/temporary_folder.h"

namespace softland {
namespace {

SceneFile short_gold(double accuracy = 1e-4) {
  SceneFile file = SceneFile::load(std::filesystem::path(SOFTLAND_SOURCE_DIR) / "scenes" / "mem-gold.toml");
  file.assign("simulate.accuracy", accuracy);
  file.assign("structure.modes", 2);
  return file;
}

PlanRequest request(const std::string& study, const std::vector<std::string>& vary) {
  PlanRequest asked{.scene = short_gold(), .vary = vary, .study = study};
  asked.place = [](std::string_view key, std::size_t) { return fmt::format("--{}", key); };
  return asked;
}

Exploration exploration(PlanRequest asked) {
  complete(asked);
  return Exploration(Plan(asked));
}

PointRow row_of(Exploration& e, std::uint64_t k, int jobs = 1) { return e.row(e.plan().scene(e.plan().values(k)), jobs); }

/// Expects equal bits, NaN included.
void expect_same(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) && std::isnan(b[i])) continue;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i])) << i << ": " << a[i] << " and " << b[i];
  }
}

std::size_t index_of(const Exploration& e, const std::string& quantity) {
  for (std::size_t i = 0; i < e.figures().size(); ++i) {
    if (e.figures()[i].quantity == quantity) return i;
  }
  throw std::logic_error("no figure " + quantity);
}

TEST(Exploration, OfClosingsGivesTheFiguresOfSimulate_optimized) {
  Exploration e = exploration(request("simulate", {"structure.length=248 um:260 um:2", "waveform.main.level=1.2 Vdp:1.3 Vdp:2"}));
  ASSERT_EQ(e.figures().size(), asked_among(all_figures, {}).size());
  for (std::uint64_t k = 0; k < e.plan().points(); ++k) {
    // A user can run the text of the scene.
    const SceneFile scene = SceneFile::parse(e.plan().scene(e.plan().values(k)).text(), "point.toml");
    const Closing closing = simulate(prepare_and_choose(scene), true);
    std::vector<double> expected;
    for (const Figure& figure : asked_among(all_figures, {})) {
      const double value = figure.value(closing.metrics);
      expected.push_back(std::isfinite(value) ? value : Metrics::unset);
    }
    const PointRow row = row_of(e, k);
    EXPECT_EQ(row.status, to_string(closing.metrics.status));
    expect_same(row.figures, expected);
  }
}

TEST(Exploration, StartsFromACanonicalSceneThatClosesAsTheGivenOne) {
  for (const std::string& name : shipped_scenes()) {
    SceneFile given = scene(name.c_str());
    given.assign("simulate.accuracy", 1e-3);
    if (given.json()["structure"]["kind"] != "plate") given.assign("structure.modes", 2);
    if (given.json().contains("gas") && given.json()["gas"]["model"] == "reynolds") given.set("gas.model=strip");
    const SceneFile same = canonical(given, "scene");
    const Closing a = simulate(prepare(given), false), b = simulate(prepare(same), false);
    for (const Figure& figure : all_figures)
      EXPECT_TRUE(figure.value(a.metrics) == figure.value(b.metrics) || std::isnan(figure.value(a.metrics)))
          << name << ": " << figure.key;
    EXPECT_EQ(a.metrics.status, b.metrics.status) << name;
  }
}

TEST(Exploration, FindsThePullInOfASwitchOnceAndOfEveryOtherOne_optimized) {
  // Points of a plan must equal those of plans with a single point, which have no pull-in voltage to reuse.
  Exploration by_switch = exploration(request("simulate", {"gap.contact=1.9 um,2 um", "waveform.main.level=1.2 Vdp,1.3 Vdp"}));
  for (std::uint64_t k = 0; k < 4; ++k) {
    Exploration alone = exploration(request("simulate", {fmt::format("gap.contact={} um", k < 2 ? 1.9 : 2.0),
                                                         fmt::format("waveform.main.level={} Vdp", k % 2 == 0 ? 1.2 : 1.3)}));
    expect_same(row_of(by_switch, k).figures, row_of(alone, 0).figures);
  }
}

TEST(PullInMemory, DistinguishesScenesOfDifferentSwitches) {
  // Asks the finder with another switch than that of the scene: the result shows whether it was computed or remembered.
  const PreparedScene ours = prepare(short_gold());
  SceneFile deep = short_gold();
  deep.assign("gap.contact", 2.1e-6);
  const PreparedScene other = prepare(deep);
  const double own = ours.pull_in.at("main").dynamically.voltage, of_other = other.pull_in.at("main").dynamically.voltage;
  ASSERT_NE(own, of_other);
  PullInMemory memory;
  const auto found = [&](const SceneFile& scene, const Switch& model) {
    return memory.finder(scene)(model, 0, {}, {}).dynamically.voltage;
  };
  EXPECT_EQ(found(short_gold(), ours.model), own);
  SceneFile driven = short_gold();
  driven.set("waveform.main.level=\"1.1 Vdp\"");
  driven.set("driver.main.max_voltage=\"1.2 Vdp\"");
  driven.set("simulate.duration=\"200 us\"");
  EXPECT_EQ(found(driven, other.model), own);
  for (const char* change : {"gap.contact=\"2.1 um\"", "gas.viscosity=\"2e-5 Pa s\"", "simulate.accuracy=1e-3"}) {
    SceneFile changed = short_gold();
    changed.set(change);
    EXPECT_EQ(found(changed, other.model), of_other) << change;
  }
}

TEST(Exploration, WithErrorsGivesThoseOfCertify_optimized) {
  PlanRequest asked = request("simulate", {"structure.length=250 um"});
  asked.options["certify"] = "true";
  Exploration e = exploration(asked);
  const PointRow row = row_of(e, 0);
  const Closing closing = certify(prepare_and_choose(SceneFile::parse(e.plan().scene(e.plan().values(0)).text(), "point.toml")));
  EXPECT_EQ(row.figures[index_of(e, "impact_velocity_error")], closing.errors[&Metrics::impact_velocity]);
  EXPECT_EQ(row.figures[index_of(e, "initial_contact_time")], closing.metrics.initial_contact_time);
}

TEST(Exploration, OfPullInGivesTheVoltages) {
  Exploration e = exploration(request("pull-in", {"gap.contact=1.8 um,2 um"}));
  ASSERT_EQ(e.figures().size(), 4U);
  const PreparedScene p = prepare(short_gold());
  SceneFile other = short_gold();
  other.assign("gap.contact", 1.8e-6);
  EXPECT_EQ(row_of(e, 1).figures[1], p.pull_in.at("main").dynamically.voltage);
  EXPECT_EQ(row_of(e, 0).figures[0], prepare(other).pull_in.at("main").statically.voltage);
  EXPECT_EQ(row_of(e, 1).figures[2], release_voltage(p.model, 0));
  EXPECT_EQ(row_of(e, 1).figures[3], p.pull_in.at("main").statically.deflection);
}

TEST(Exploration, OfADispersionForceGivesItsFactors) {
  PlanRequest asked = request("pull-in", {"structure.length=5.0 um"});
  asked.scene = SceneFile::load(std::filesystem::path(SOFTLAND_SOURCE_DIR) / "scenes" / "nem-casimir.toml");
  Exploration e = exploration(asked);
  const PointRow row = row_of(e, 0);
  ASSERT_EQ(row.figures.size(), 2U);
  EXPECT_GT(row.figures[0], row.figures[1]);  // the dynamic pull-in voltage is lower
  EXPECT_GT(row.figures[1], 1);
  EXPECT_LT(row.figures[0], 1.5);
}

TEST(Exploration, OfDevicesGivesTheYieldsOfRobustness_optimized) {
  PlanRequest asked = request("robustness", {"waveform.main.level=1.2 Vdp"});
  asked.options["samples"] = "24";
  asked.seed = 5;
  Exploration e = exploration(asked);
  const PointRow row = row_of(e, 0);
  SceneFile scene = short_gold();
  scene.set("waveform.main.level=\"1.2 Vdp\"");
  const PreparedScene nominal = prepare_and_choose(scene, true);
  const Robustness found =
      robustness(nominal, {{.name = "own", .waveforms = nominal.drives.waveforms()}}, {.samples = 24, .seed = 5});
  EXPECT_EQ(row.figures[0], found.drives.back().closing.value);
  EXPECT_EQ(row.figures[index_of(e, "bounce_free_yield")], found.drives.back().bounce_free.value);
  const auto height = &Metrics::major_bounce_height;
  EXPECT_EQ(row.figures[index_of(e, "major_bounce_height_q95")], found.drives.back().figures[height].quantiles[2].value);
}

TEST(Exploration, OfSearchesKeepsWinnersThatSimulateRunsToTheirFigures_optimized) {
  PlanRequest asked = request("optimize", {"gap.contact=2 um"});
  asked.options["budget"] = "120";
  Exploration e = exploration(asked);
  const PointRow row = row_of(e, 0);
  ASSERT_FALSE(row.scene.empty());
  EXPECT_LE(row.figures[index_of(e, "evaluations")], 120) << "gradients count too";
  EXPECT_GE(row.figures[index_of(e, "evaluations")], 60);
  int families = 0;  // number of families to which the winner belongs
  for (const char* family : {"knots", "dual-pulse", "staircase:5"})
    families += std::isfinite(row.figures[index_of(e, fmt::format("{}.main.level_1", family))]) ? 1 : 0;
  EXPECT_EQ(families, 1);
  const Closing again = simulate(prepare_and_choose(SceneFile::parse(row.scene, "best.toml")), true);
  EXPECT_EQ(row.figures[index_of(e, "impact_velocity")], again.metrics.impact_velocity);
  EXPECT_EQ(row.figures[index_of(e, "major_bounce_height")], again.metrics.major_bounce_height);
  EXPECT_GE(row.waveforms.at("main").size(), 4U);
  EXPECT_LT(row.figures[index_of(e, "cost")], row.figures[index_of(e, "plain_step_cost")]);
}

TEST(Exploration, IsTheSameOnAnyNumberOfThreadsInAnyOrder_optimized) {
  Exploration e = exploration(request("simulate", {"structure.length=246 um:262 um:3", "waveform.main.level=1.1 Vdp:1.4 Vdp:2"}));
  const auto rows = [&](int jobs, bool backwards) {
    std::vector<PointRow> all(e.plan().points());
    run_tasks(all.size(), jobs, [&](std::size_t i) {
      const std::size_t k = backwards ? all.size() - 1 - i : i;
      all[k] = row_of(e, k);
    });
    return all;
  };
  const std::vector<PointRow> one = rows(1, false), two = rows(2, true);
  for (std::size_t k = 0; k < one.size(); ++k) expect_same(one[k].figures, two[k].figures);
}

TEST(Exploration, RecordsAnImpossibleSceneAsAStatus) {
  Exploration e = exploration(request("simulate", {"structure.length=230 um,250 um", "gap.contact=2 um,4 um"}));
  const PointRow short_beam = row_of(e, 0), deep_gap = row_of(e, 3), good = row_of(e, 2);
  EXPECT_EQ(short_beam.status, infeasible);
  EXPECT_EQ(short_beam.reason.find("electrode.main.span"), 0U) << short_beam.reason;  // the electrode ends beyond the beam
  EXPECT_NE(short_beam.reason.find("must end on the beam"), std::string::npos) << short_beam.reason;
  EXPECT_EQ(deep_gap.status, infeasible) << deep_gap.reason;
  EXPECT_EQ(good.status, "done");
  for (const PointRow& row : {short_beam, deep_gap}) {
    EXPECT_EQ(row.figures.size(), e.figures().size());
    for (const double value : row.figures) EXPECT_TRUE(std::isnan(value));
  }
}

TEST(Exploration, ThatIsAskedToStopHasNoHalfRow) {
  Exploration e = exploration(request("simulate", {"gap.contact=2 um"}));
  const std::atomic<bool> stop = true;
  EXPECT_THROW((void)e.row(e.plan().scene(e.plan().values(0)), 1, {.stop = &stop}), Interrupted);
}

TEST(Exploration, KnowsEqualContentByItsText) {
  Exploration coarse = exploration(request("simulate", {"gap.contact=1.8 um:2.2 um:3"})),
              fine = exploration(request("simulate", {"gap.contact=1.8 um:2.2 um:5"}));
  const auto content = [](Exploration& e, std::uint64_t k) { return e.content(e.plan().scene(e.plan().values(k))); };
  EXPECT_EQ(content(coarse, 1), content(fine, 2));
  EXPECT_NE(content(coarse, 1), content(fine, 1));
  // Some options only matter to searches or to studies on devices.
  PlanRequest asked = request("simulate", {"gap.contact=1.8 um:2.2 um:3"});
  asked.seed = 2;
  Exploration seeded = exploration(asked);
  EXPECT_EQ(content(coarse, 1), content(seeded, 1));
  asked.study = "robustness";
  Exploration two = exploration(asked);
  asked.seed = 3;
  Exploration three = exploration(asked);
  EXPECT_NE(content(two, 1), content(three, 1));
}

TEST(Exploration, ChecksTheOptionsOfItsStudy) {
  const auto told = [](const std::string& study, const std::map<std::string, std::string>& options) -> std::string {
    PlanRequest asked = request(study, {"gap.contact=2 um"});
    asked.options = options;
    try {
      complete(asked);
      return fmt::format("{}", asked.options.size());
    } catch (const InvalidInput& error) {
      return error.what();
    }
  };
  EXPECT_EQ(told("simulate", {}), "0");
  EXPECT_EQ(told("optimize", {}), "5");
  EXPECT_EQ(told("robustness", {}), "1");
  EXPECT_EQ(told("optimise", {}), "--study: must be simulate, pull-in, robustness or optimize");
  EXPECT_EQ(told("simulate", {{"samples", "3"}}), "--samples: belongs to study robustness, not to simulate");
  EXPECT_EQ(told("robustness", {{"samples", "0"}}).find("--samples: must be a whole number from 1"), 0U);
  EXPECT_EQ(told("optimize", {{"target", "speed"}}).find("--target: must be bounce"), 0U);
  EXPECT_EQ(told("optimize", {{"budget", "90 s"}}).find("--budget: must be a whole number"), 0U);
  EXPECT_EQ(told("optimize", {{"optimizer", "none"}}).find("--optimizer: "), 0U);
  EXPECT_THROW((void)exploration([] {
                 PlanRequest asked = request("robustness", {"gap.contact=2 um"});
                 asked.scene.erase("spread");
                 return asked;
               }()),
               InvalidInput);
}

// The columns of a study from outside are those of the record of the plan's scene. That record is made once for a store.
TEST(Exploration, TakesItsColumnsFromAStoreOfItsPlan) {
  int records = 0;
  const OtherStudies others{
      {.name = "other",
       .check = [](const OtherStudy::Options&) {},
       .record =
           [&](const SceneFile&, const OtherStudy::Options&, std::uint64_t, int, const Progress&) {
             ++records;
             return OtherStudy::Record{.status = "done", .numbers = {{"touch.least_time_s", 2e-5}, {"share", 0.5}}};
           }}};
  const Plan plan(request("other", {"gap.contact=1.8 um,2 um"}));
  const test::TemporaryFolder folder;
  const std::filesystem::path store = folder.path() / "other.sqlite";
  Exploration fresh = exploration_for(plan, store, {}, others);
  EXPECT_EQ(records, 1);
  StudyStore(store, stored_plan(fresh, {}), {.program = "test"}, StudyStore::Opening::fresh).close();

  Exploration resumed = exploration_for(plan, store, {}, others);
  EXPECT_EQ(records, 1);
  EXPECT_EQ(stored_plan(resumed, {}).columns, stored_plan(fresh, {}).columns);
  expect_same(row_of(resumed, 1).figures, {2e-5, 0.5});
  (void)exploration_for(Plan(request("other", {"gap.contact=1.9 um"})), store, {}, others);
  EXPECT_EQ(records, 3);  // one for the row, and one for the other plan
}

}  // namespace
}  // namespace softland
