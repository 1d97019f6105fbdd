// Tests `softland explore` as a user does: the content of the store after any end of the run.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <bit>
#include <cmath>
#include <random>

#include "explorations.h"

namespace softland {
namespace {

using nlohmann::json;
using test::expect_same_rows;
using test::Explore;
using test::explore;
using test::levels;
using test::quick;
using test::rows_of;

TEST_F(Explore, LeavesOneRowPerPointWithTheFiguresOfSimulate_optimized) {
  const json j = done(explore({"--vary", "structure.length=235um,250um", "--vary", "waveform.main.level=1.2Vdp:1.3 Vdp:2",
                               "--out", "map.sqlite", "--jobs", "2"}));
  EXPECT_EQ(j["status"], "done");
  EXPECT_EQ(j["points"], 4);
  EXPECT_EQ(j["rows"]["computed"], 4);
  EXPECT_EQ(j["by_status"], (json{{"infeasible", 2}, {"not_settled", 2}})) << j;
  EXPECT_EQ(j["variables"][1]["column"], "waveform_main_level_Vdp");
  const std::vector<StoredRow> rows = rows_of(at("map.sqlite"));
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].status, "infeasible");
  EXPECT_NE(rows[0].reason.find("must end on the beam"), std::string::npos) << rows[0].reason;
  EXPECT_EQ(rows[3].values[0], 250e-6);
  EXPECT_EQ(rows[3].values[1], 1.3);
  for (const std::int64_t point : {2, 3}) expect_simulated("map.sqlite", point);
  EXPECT_FALSE(fs::exists(at("map.sqlite-wal")));
}

TEST_F(Explore, OfSearchesGivesScenesThatSimulateRunsToTheirRows_optimized) {
  const json j = done({"explore", "gold.toml", "--vary", "gap.contact=1.9um,2um", "--study", "optimize", "--budget", "60",
                       "--set", "structure.modes=2", "--set", "simulate.accuracy=1e-3", "--quiet", "--out", "best.sqlite"});
  EXPECT_EQ(j["rows"]["computed"], 2);
  expect_simulated("best.sqlite", 1);
}

TEST_F(Explore, HasTheSameRowsWhateverTheNumberOfJobsAndTheParts_optimized) {
  const std::vector<std::string> plan{"--vary", levels + "5", "--vary", "gap.contact=1.8um:2.2um:3"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), plan.begin(), plan.end());
    return explore(more);
  };
  (void)done(with({"--out", "one.sqlite", "--jobs", "1"}));
  (void)done(with({"--out", "two.sqlite", "--jobs", "2"}));
  const std::vector<StoredRow> whole = rows_of(at("one.sqlite"));
  ASSERT_EQ(whole.size(), 15U);
  expect_same_rows(whole, rows_of(at("two.sqlite")));
  std::vector<StoredRow> parts;
  for (const char* part : {"1/2", "2/2"}) {
    const std::string out = fmt::format("part{}.sqlite", part[0]);
    (void)done(with({"--out", out, "--shard", part}));
    for (StoredRow& row : rows_of(at(out))) parts.push_back(std::move(row));
  }
  std::sort(parts.begin(), parts.end(), [](const StoredRow& a, const StoredRow& b) { return a.point < b.point; });
  expect_same_rows(whole, parts);
}

// Every number of a point is that in the verb's own record of the same scene.
TEST_F(Explore, OfOtherStudiesHasTheNumbersOfTheirRecords_optimized) {
  struct Asked {
    std::string study;
    std::vector<std::string> options, as_verb;
    std::string key;  // the record must have it
  };
  const std::vector<Asked> all{{"check", {}, {}, "/pull_in/dynamic_V"},
                               {"effects", {}, {}, "/relative_spread/gas/impact_velocity"},
                               {"limit",
                                {"--option", "impact-velocity=2 mm/s", "--option", "no-curves=true"},
                                {"--impact-velocity", "2 mm/s", "--no-curves"},
                                "/touch/least_time_s"},
                               {"release",
                                {"--option", "budget=40", "--option", "samples=8"},
                                {"--budget", "40", "--samples", "8"},
                                "/plain/figures/settling_time_s"}};
  for (const Asked& asked : all) {
    SCOPED_TRACE(asked.study);
    const std::string store = asked.study + ".sqlite";
    const auto explored = [&](const std::string& out, const std::string& jobs) {
      std::vector<std::string> words{"--vary", "gap.contact=1.8 um,2 um", "--study", asked.study, "--out", out, "--jobs", jobs};
      words.insert(words.end(), asked.options.begin(), asked.options.end());
      return done(explore(words));
    };
    EXPECT_EQ(explored(store, "1")["rows"]["computed"], 2);
    (void)explored("two-" + store, "2");
    const std::vector<StoredRow> rows = rows_of(at(store));
    expect_same_rows(rows, rows_of(at("two-" + store)));
    EXPECT_EQ(done({"explore", store, "--resume", "--quiet"})["rows"]["known"], 2);

    ASSERT_EQ(here.run({"explore", store, "--point", "1", "--out", "point.toml", "--quiet"}).status, 0);
    std::vector<std::string> verb{asked.study, "point.toml", "--quiet", "--json", "-"};
    verb.insert(verb.end(), asked.as_verb.begin(), asked.as_verb.end());
    const json record = json::parse(here.run(verb).out);
    ASSERT_TRUE(record.contains(json::json_pointer(asked.key))) << record.dump(1);
    const std::vector<StoredColumn> columns = StudyReader(at(store)).plan().columns;
    std::size_t compared = 0;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (columns[k].kind != ColumnKind::figure) continue;
      std::string path = "/" + columns[k].name, unit = columns[k].unit;
      std::ranges::replace(path, '.', '/');
      std::ranges::replace(unit, '/', '_');
      if (!unit.empty()) path += "_" + unit;
      const json::json_pointer at_key(path);
      if (!record.contains(at_key) || !record[at_key].is_number()) continue;
      EXPECT_EQ(rows[1].values[k], record[at_key].get<double>()) << path;
      ++compared;
    }
    EXPECT_GE(compared, asked.study == "effects" ? 3U : 5U);
  }
  const auto refused = [&](const std::vector<std::string>& words) {
    std::vector<std::string> asked = explore({"--vary", levels + "3", "--out", "no.sqlite"});
    asked.insert(asked.end(), words.begin(), words.end());
    const Outcome bad = here.run(asked);
    EXPECT_EQ(bad.status, 2);
    return bad.err;
  };
  EXPECT_NE(refused({"--study", "limits"})
                .find("--study limits: must be simulate, pull-in, robustness, optimize, check, effects, limit or release"),
            std::string::npos);
  EXPECT_NE(refused({"--study", "limit", "--option", "speed=1"}).find("--option speed=1: study limit has no option 'speed'"),
            std::string::npos);
  EXPECT_NE(refused({"--study", "limit", "--samples", "3"}).find("--samples 3: study limit has no option 'samples'"),
            std::string::npos);
  EXPECT_NE(refused({"--study", "limit", "--option", "impact-velocity=0 m/s"}).find("must be a velocity above 0 m/s"),
            std::string::npos);
  EXPECT_NE(refused({"--option", "certify"}).find("--option certify: must be NAME=VALUE"), std::string::npos);
}

TEST_F(Explore, TakesPointsOfACoarserGridAndASmallerSampleOver_optimized) {
  (void)done(explore({"--vary", levels + "3", "--out", "grid.sqlite"}));
  const json finer = done(explore({"--vary", levels + "5", "--out", "grid.sqlite", "--resume"}));
  EXPECT_EQ(finer["rows"], (json{{"known", 0}, {"computed", 2}, {"reused", 3}, {"remaining", 0}}));
  (void)done(explore({"--vary", levels + "5", "--out", "fresh.sqlite"}));
  expect_same_rows(rows_of(at("grid.sqlite")), rows_of(at("fresh.sqlite")));

  const std::string box = "waveform.main.level=20 V:24 V";
  (void)done(explore({"--vary", box, "--sample", "sobol:3", "--out", "sample.sqlite"}));
  const json larger = done(explore({"--vary", box, "--sample", "sobol:5", "--out", "sample.sqlite", "--resume"}));
  EXPECT_EQ(larger["rows"]["reused"], 3);
  EXPECT_EQ(larger["rows"]["computed"], 2);
}

TEST_F(Explore, GoesOnWithAStoreByItself) {
  (void)done(explore({"--vary", levels + "3", "--out", "map.sqlite"}));
  const json again = done({"explore", "map.sqlite", "--resume", "--quiet"});
  EXPECT_EQ(again["rows"]["known"], 3);
  EXPECT_EQ(again["rows"]["computed"], 0);
}

TEST_F(Explore, TakesPlansAndLists_optimized) {
  write(at("points.csv"), "waveform.main.level [V],gap.contact [um]\n20,2\n22,1.9\n");
  const json of_list = done(explore({"--list", "points.csv", "--out", "list.sqlite"}));
  EXPECT_EQ(of_list["points"], 2);
  EXPECT_EQ(rows_of(at("list.sqlite"))[1].values[1], 1.9e-6);
  write(at("map.toml"), R"([plan]
scene = "gold.toml"
set = ["structure.modes=2", "simulate.accuracy=1e-3", "simulate.duration=80 us", "driver.main.max_voltage=40 V"]
vary = ["waveform.main.level=20 V:24 V:3"]
)");
  const json of_file = done({"explore", "map.toml", "--quiet", "--out", "plan.sqlite"});
  (void)done(explore({"--vary", levels + "3", "--out", "same.sqlite"}));
  EXPECT_EQ(StudyReader(at("plan.sqlite")).plan().text, StudyReader(at("same.sqlite")).plan().text);
  expect_same_rows(rows_of(at("plan.sqlite")), rows_of(at("same.sqlite")));
  EXPECT_EQ(of_file["points"], 3);
}

TEST_F(Explore, ThatIsInterruptedLeavesWhatThereIsAndGoesOn_optimized) {
  const std::vector<std::string> words = explore({"--vary", levels + "5000", "--out", "map.sqlite", "--jobs", "1"});
  const pid_t child = here.start(words);
  wait_until_it_computes(child);
  kill(child, SIGINT);
  const Outcome o = here.finish(child);
  EXPECT_EQ(o.status, 130) << o.err;
  const std::size_t there = rows_of(at("map.sqlite")).size();
  EXPECT_GT(there, 0U);
  EXPECT_LT(there, 5000U);
  EXPECT_NE(o.out.find("of 5"), std::string::npos) << o.out;
  EXPECT_FALSE(fs::exists(at("map.sqlite-wal")));
}

TEST_F(Explore, ThatIsKilledAgainAndAgainEndsWithTheSameBits_slow) {
  const std::vector<std::string> plan{"--vary", levels + "20", "--vary", "gap.contact=1.8um:2.2um:16", "--jobs", "2"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), plan.begin(), plan.end());
    return explore(more);
  };
  (void)done(with({"--out", "whole.sqlite"}));
  std::mt19937 random(1);
  constexpr int kills = 6;
  int hits = 0;
  for (int i = 0; i < kills; ++i) {
    const pid_t child = here.start(with({"--out", "killed.sqlite", "--resume"}));
    // The first run is killed while it makes the store, the others later.
    for (int waited = 0; i == 0 && waited < 60'000 && !fs::exists(at("killed.sqlite")); ++waited)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(20 + random() % 1500));
    if (process_state(child).state != 'Z') ++hits;
    kill(child, SIGKILL);
    (void)here.finish(child);
  }
  const json last = done(with({"--out", "killed.sqlite", "--resume"}));
  EXPECT_GT(hits, 0);
  EXPECT_EQ(last["rows"]["remaining"], 0);
  expect_same_rows(rows_of(at("whole.sqlite")), rows_of(at("killed.sqlite")));
}

TEST_F(Explore, RefusesWhatItCannotExplore) {
  (void)done(explore({"--vary", levels + "2", "--out", "there.sqlite"}));
  const std::string vary = levels + "2";
  write(at("bad.toml"), "[plan]\nscene = \"gold.toml\"\nstudy = \"optimise\"\n");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"explore", "gold.toml"}, "no key varies"},
      {{"explore", "gold.toml", "--vary", "gap.contact=1 um:2 um"}, "--vary gap.contact=1 um:2 um: must be KEY=LOW:HIGH:N"},
      {{"explore", "gold.toml", "--vary", vary, "--study", "fly"}, "--study fly: must be simulate"},
      {{"explore", "gold.toml", "--vary", vary, "--samples", "3"}, "--samples 3: belongs to study robustness"},
      {{"explore", "gold.toml", "--vary", vary, "--shard", "3/2"}, "--shard"},
      {{"explore", "gold.toml", "--vary", vary, "--jobs", "0"}, "--jobs 0"},
      {{"explore", "gold.toml", "--vary", vary, "--seed", "x"}, "--seed x"},
      {{"explore", "gold.toml", "--list", "none.csv"}, "none.csv"},
      {{"explore", "gold.toml", "--list", "none.csv", "--vary", vary}, "gives all points: omit --vary, --sample and --pareto"},
      {{"explore", "gold.toml", "--vary", vary, "--out", "there.sqlite"}, "there.sqlite: exists already"},
      {{"explore", "gold.toml", "--vary", "gap.contact=1 um,2 um", "--out", "there.sqlite", "--resume"}, "with other columns"},
      {{"explore", "there.sqlite"}, "give --resume to continue it"},
      {{"explore", "gold.toml", "--vary", vary, "--out", "new.sqlite", "--json", "new.sqlite"},
       "is the store itself; name another"},
      {{"explore", "there.sqlite", "--resume", "--vary", vary}, "holds a complete plan: omit --vary"},
      {{"explore", "there.sqlite", "--point", "2"}, "--point 2: must be below 2"},
      {{"explore", "there.sqlite", "--point", "1", "--out", "there.sqlite"}, "is a store and is not replaced"},
      {{"explore", "gold.toml", "--vary", vary, "--out", "gold.toml", "--resume"}, "gold.toml"},
      {{"explore", "bad.toml"}, "bad.toml:3: plan.study = \"optimise\": must be simulate"},
  };
  const std::string scene = read(at("gold.toml"));
  for (const auto& [words, reason] : cases) {
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 2) << reason << ": " << o.err;
    EXPECT_NE(o.err.find(reason), std::string::npos) << o.err;
  }
  EXPECT_EQ(read(at("gold.toml")), scene);
  EXPECT_EQ(rows_of(at("there.sqlite")).size(), 2U);
}

}  // namespace
}  // namespace softland
