// Searches from several seeds as one study.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

#include "searches.h"

namespace softland {
namespace {

using nlohmann::json;
using test::expect_same_rows;
using test::expect_same_search;
using test::optimize;
using test::rows_of;
using testing::HasSubstr;

class Seeds : public test::Searches {};

std::vector<std::string> seeds(const std::string& count, std::vector<std::string> more) {
  more.insert(more.begin(), {"--seeds", count, "--budget", "150"});
  return optimize(more);
}

TEST_F(Seeds, AreOneSearchEachAndTheBestIsReported_optimized) {
  done(seeds("3", {"--out", "one", "--jobs", "1"}));
  const std::vector<StoredRow> rows = rows_of(at("one/seeds.sqlite"));
  ASSERT_EQ(rows.size(), 3U);
  const json j = test::result_in(at("one"));
  const json& study = j["seeds"];
  EXPECT_EQ(study["planned"], 3);
  ASSERT_EQ(study["searches"].size(), 3U);
  std::vector<double> costs;
  for (int seed = 1; seed <= 3; ++seed) {
    const std::string out = fmt::format("alone{}", seed);
    done(optimize({"--budget", "150", "--seed", std::to_string(seed), "--out", out}));
    const json alone = test::result_in(at(out));
    const json& search = study["searches"][static_cast<std::size_t>(seed - 1)];
    EXPECT_EQ(search["seed"], seed);
    EXPECT_EQ(search["cost"], alone["best"]["cost"]);
    EXPECT_EQ(search["goal_met"], alone["goal_met"]);
    EXPECT_EQ(search["termination"], alone["termination"]);
    EXPECT_EQ(search["evaluations"], alone["evaluations"]);
    EXPECT_EQ(search["metrics"]["initial_contact_time_s"], alone["metrics"]["initial_contact_time_s"]);
    costs.push_back(search["cost"]);
    if (study["best_seed"] == seed) {
      for (const char* name : {"best.toml", "best.csv", "evaluations.csv"})
        EXPECT_EQ(read(at("one") / name), read(at(out) / name)) << name;
    }
  }
  std::sort(costs.begin(), costs.end());
  EXPECT_EQ(study["cost"]["least"], costs[0]);
  EXPECT_EQ(study["cost"]["median"], costs[1]);
  EXPECT_EQ(study["cost"]["most"], costs[2]);
  EXPECT_EQ(j["seed"], study["best_seed"]);
  // The page that is made again from the result has the table as well.
  const std::string page = read(at("one/report.html"));
  EXPECT_THAT(page, HasSubstr("Searches with other seeds"));
  done({"report", "one", "--out", "again"});
  EXPECT_EQ(read(at("again/report.html")), page);
}

TEST_F(Seeds, HaveTheSameBitsWhateverTheNumberOfJobs_optimized) {
  done(seeds("3", {"--out", "one", "--jobs", "1"}));
  for (const char* jobs : {"2", "5"}) {
    const std::string out = std::string("jobs") + jobs;
    done(seeds("3", {"--out", out, "--jobs", jobs}));
    expect_same_search(at("one"), at(out));
    expect_same_rows(rows_of(at("one/seeds.sqlite")), rows_of(at(out) / "seeds.sqlite"));
  }
}

TEST_F(Seeds, AfterKillsAtRandomMomentsEndWithTheSameBits_slow) {
  const auto with = [](const char* out, std::vector<std::string> more) {
    more.insert(more.end(), test::slower.begin(), test::slower.end());
    more.insert(more.end(), {"--seeds", "4", "--budget", "400", "--jobs", "2", "--out", out});
    return optimize(more);
  };
  done(with("whole", {}));
  std::mt19937 random(5);
  constexpr int kills = 4;
  for (int i = 0; i < kills; ++i) {
    const pid_t child = here.start(with("killed", {"--resume"}));
    std::this_thread::sleep_for(std::chrono::milliseconds(1200 + random() % 1200));
    kill(child, SIGKILL);
    (void)here.finish(child);
  }
  done(with("killed", {"--resume"}));
  expect_same_search(at("whole"), at("killed"));
  expect_same_rows(rows_of(at("whole/seeds.sqlite")), rows_of(at("killed/seeds.sqlite")));
}

TEST_F(Seeds, ThatAreThereAreNotRepeatedWhenMoreAreAsked_slow) {
  done(seeds("2", {"--out", "out"}));
  done(optimize({"--resume", "--out", "out", "--seeds", "3"}));
  const std::vector<StoredSession> sessions = StudyReader(at("out/seeds.sqlite")).sessions();
  ASSERT_EQ(sessions.size(), 2U);
  done(seeds("3", {"--out", "whole"}));
  expect_same_search(at("whole"), at("out"));
  refused(optimize({"--resume", "--out", "out", "--seeds", "2"}),
          "--resume: out/evaluations.sqlite holds another search: it has 3 seeds, not 2");
}

TEST_F(Seeds, GoOnFromASingleSearch_slow) {
  done(optimize({"--out", "out", "--budget", "150"}));
  done(optimize({"--resume", "--out", "out", "--seeds", "2"}));
  done(seeds("2", {"--out", "whole"}));
  expect_same_search(at("whole"), at("out"));
}

TEST_F(Seeds, ThatAreInterruptedTellWhatIsDoneAndGoOn) {
  const pid_t child =
      here.start(optimize({"--seeds", "400", "--budget", "60", "--jobs", "1", "--out", "out", "--json", "out.json"}));
  const fs::path store = at("out/unfinished/seeds.sqlite");
  for (int i = 0; i < 1200 && !(is_store(store) && !rows_of(store).empty()); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  kill(child, SIGINT);
  const Outcome o = here.finish(child);
  EXPECT_EQ(o.status, 130) << o.err;
  EXPECT_THAT(o.out, HasSubstr("--resume continues"));
  const json j = json::parse(read(at("out.json")), nullptr, false);
  EXPECT_EQ(j["status"], "interrupted");
  EXPECT_EQ(j["seeds"]["planned"], 400);
  const std::size_t there = rows_of(store).size();
  EXPECT_EQ(j["seeds"]["searches"].size(), there);
  const std::string again = here.run({"report", "out.json"}).out;
  EXPECT_THAT(again, HasSubstr("of 400 searches are done"));
  EXPECT_TRUE(o.out.starts_with(again)) << o.out << again;
  EXPECT_TRUE(fs::exists(at("out/unfinished/best.toml")));
  EXPECT_FALSE(fs::exists(at("out/result.json")));
}

TEST_F(Seeds, ThatFailAreNamed) {
  done(seeds("2", {"--out", "out", "--waveform", "step"}));
  const json missed = test::result_in(at("out"))["seeds"];
  EXPECT_EQ(missed["goal_met"], 0);
  EXPECT_EQ(missed["failed"], (json{{{"reason", "goal not met"}, {"seed", 1}}, {{"reason", "goal not met"}, {"seed", 2}}}));
  // No waveform can close this switch.
  const Outcome o = here.run({"optimize", "gold.toml", "--quiet", "--budget", "20", "--seeds", "2", "--out", "open", "--set",
                              "waveform.main.level=5 V", "--set", "driver.main.max_voltage=6 V"});
  EXPECT_EQ(o.status, 4) << o.err;
  EXPECT_THAT(o.out, HasSubstr("2 searches, each with its own seed. None of them found a feasible waveform."));
  const json study = test::result_in(at("open"))["seeds"];
  EXPECT_EQ(study["failed"].size(), 2U);
  EXPECT_TRUE(study["cost"]["median"].is_null());
}

TEST_F(Seeds, OfARobustSearchEndWithTheSameBits_slow) {
  const auto with = [](const char* out, std::vector<std::string> more) {
    more.insert(more.end(),
                {"--robust", "cvar:0.9", "--samples", "8", "--seeds", "2", "--budget", "900", "--jobs", "2", "--out", out});
    return optimize(more);
  };
  const pid_t child = here.start(with("killed", {}));
  const fs::path store = at("killed/unfinished/evaluations.sqlite");
  for (int i = 0; i < 1200 && !(is_store(store) && rows_of(store).size() > 60); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  kill(child, SIGKILL);
  (void)here.finish(child);
  const Outcome resumed = here.run(with("killed", {"--resume"})), whole = here.run(with("whole", {}));
  EXPECT_EQ(resumed.status, whole.status) << resumed.err;
  expect_same_search(at("whole"), at("killed"));
  EXPECT_EQ(read(at("whole/devices.csv")), read(at("killed/devices.csv")));
  expect_same_rows(rows_of(at("whole/seeds.sqlite")), rows_of(at("killed/seeds.sqlite")));
}

}  // namespace
}  // namespace softland
