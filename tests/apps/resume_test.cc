// A search that continues after any interruption, and a search that starts from earlier results.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

#include "searches.h"

namespace softland {
namespace {

using nlohmann::json;
using test::expect_same_search;
using test::optimize;
using test::rows_of;
using testing::HasSubstr;

using namespace std::chrono_literals;

class Resume : public test::Searches {
 protected:
  /// Kills a search after it has evaluated for a while.
  void killed(const std::vector<std::string>& words, std::chrono::milliseconds after) const {
    const pid_t child = here.start(words);
    std::this_thread::sleep_for(after);
    kill(child, SIGKILL);
    (void)here.finish(child);
  }
  /// Kills a search that has evaluations in its store.
  void killed_once(const std::string& out, std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--budget", "100000000", "--out", out});
    const pid_t child = here.start(optimize(more));
    const fs::path store = at(out) / "unfinished/evaluations.sqlite";
    for (int i = 0; i < 600 && !(is_store(store) && rows_of(store).size() > 100); ++i) std::this_thread::sleep_for(50ms);
    kill(child, SIGKILL);
    (void)here.finish(child);
  }
};

TEST_F(Resume, AfterKillsAtRandomMomentsEndsWithTheSameBits_slow) {
  const auto with = [](std::vector<std::string> more) {
    more.insert(more.end(), test::slower.begin(), test::slower.end());
    more.insert(more.end(), {"--budget", "1500", "--jobs", "2"});
    return optimize(more);
  };
  done(with({"--out", "whole"}));
  std::mt19937 random(3);
  constexpr int kills = 4;  // number of kills later than the first second, in which rows may be lost
  for (int i = 0; i < kills; ++i)
    killed(with({"--out", "killed", "--resume"}), std::chrono::milliseconds(1200 + random() % 1200));
  done(with({"--out", "killed", "--resume"}));
  expect_same_search(at("whole"), at("killed"));
  const StudyReader store(at("killed/evaluations.sqlite"));
  EXPECT_GT(store.sessions().size(), 1U);
  EXPECT_LT(store.sessions().back().rows, static_cast<std::int64_t>(rows_of(at("whole/evaluations.sqlite")).size()))
      << "what was there is not simulated again";
  EXPECT_EQ(rows_of(at("killed/evaluations.sqlite")).size(), rows_of(at("whole/evaluations.sqlite")).size());
  EXPECT_FALSE(fs::exists(at("killed/unfinished")));
}

TEST_F(Resume, WithALargerBudgetIsTheSearchThatBeganWithIt_optimized) {
  done(optimize({"--out", "out", "--budget", "200", "--optimizer", "cma-es"}));
  done({"optimize", "--resume", "--quiet", "--out", "out", "--budget", "500"});
  const json commands = json::parse(read(at("out/result.json")))["reproduce"];
  ASSERT_EQ(commands.size(), 3U) << commands;
  EXPECT_THAT(commands[0].get<std::string>(), testing::StartsWith("softland optimize gold.toml"));
  EXPECT_EQ(commands[1], "softland optimize --resume --quiet --out out --budget 500");
  done(optimize({"--out", "whole", "--budget", "500", "--optimizer", "cma-es"}));
  expect_same_search(at("whole"), at("out"));
  EXPECT_EQ(rows_of(at("out/evaluations.sqlite")).size(), rows_of(at("whole/evaluations.sqlite")).size());
  // A repeated run reads every evaluation from the store.
  done({"optimize", "--resume", "--quiet", "--out", "out"});
  expect_same_search(at("whole"), at("out"));
  EXPECT_EQ(StudyReader(at("out/evaluations.sqlite")).sessions().back().rows, 0);
}

TEST_F(Resume, OfATargetWithACostOfItsOwnEndsWithTheSameBits_slow) {
  const std::vector<std::string> settling{"--target", "settling", "--budget", "600"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), settling.begin(), settling.end());
    return optimize(more);
  };
  killed_once("out", {"--target", "settling"});
  done(with({"--out", "out", "--resume"}));
  done(with({"--out", "whole"}));
  expect_same_search(at("whole"), at("out"));
}

TEST_F(Resume, AfterCtrlCGoesOn_optimized) {
  const pid_t child = here.start(optimize({"--budget", "100000000", "--out", "out"}));
  for (int i = 0; i < 600 && !fs::exists(at("out/unfinished/best.toml")); ++i) std::this_thread::sleep_for(50ms);
  std::this_thread::sleep_for(500ms);
  kill(child, SIGINT);
  EXPECT_EQ(here.finish(child).status, 130);
  EXPECT_GT(rows_of(at("out/evaluations.sqlite")).size(), 0U);
  EXPECT_FALSE(fs::exists(at("out/evaluations.sqlite-wal")));
  done({"optimize", "--resume", "--quiet", "--out", "out", "--budget", "300"});
  done(optimize({"--out", "whole", "--budget", "300"}));
  expect_same_search(at("whole"), at("out"));
}

TEST_F(Resume, RefusesAnotherSearchAndSaysWhatDiffers) {
  killed_once("out");
  const std::string before = "--resume: out/unfinished/evaluations.sqlite holds another search: ";
  const auto with = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"--resume", "--out", "out"});
    return optimize(more);
  };
  refused(with({"--target", "impact"}), before + "it is for --target bounce, not impact");
  refused(with({"--actuator", "both"}), before + "it is for --actuator electrostatic, not both");
  refused(with({"--waveform", "ramp"}), before + "it is for --waveform knots+dual-pulse+staircase:5+knots:8, not ramp");
  refused(with({"--optimizer", "bobyqa"}), before + "it is for --optimizer auto, not bobyqa");
  refused(with({"--seed", "2"}), before + "it is for --seed 1, not 2");
  refused(with({"--robust", "worst"}), before + "it is for --robust none, not worst");
  refused(with({"--set", "gap.contact=1.9 um"}), before + "its scene has gap.contact = \"2e-06 m\", not \"1.9e-06 m\"");
  refused({"optimize", "--resume", "--quiet", "--out", "out", "--set", "gap.contact=1.9 um"},
          before + "its scene has gap.contact = \"2e-06 m\", not \"1.9e-06 m\"");
  write(at("thrown.toml"),
        edited(edited(shipped("mem-gold.toml"), "family = \"step\"\nlevel = \"1.25 Vdp\"",
                      "family = \"pulse\"\nlevels = [\"20 V\", \"5 V\", \"18 V\"]\ntimes = [\"20 us\", \"32 us\"]"),
               "1.5 Vdp", "40 V"));
  refused(with({"--start", "thrown.toml"}), before + "it began with --start none, not thrown.toml");
  EXPECT_FALSE(fs::exists(at("out/best.toml")));
}

TEST_F(Resume, WithoutASearchNeedsAScene) {
  refused({"optimize", "--resume", "--out", "none"},
          "--resume: none holds no search to continue; name its folder by --out, or omit --resume");
  done(optimize({"--resume", "--out", "out", "--budget", "20"}));
  EXPECT_TRUE(fs::exists(at("out/result.json")));
}

TEST_F(Resume, NamesWhoHoldsTheFolder_optimized) {
  const pid_t child = here.start(optimize({"--budget", "100000000", "--out", "out"}));
  for (int i = 0; i < 600 && !fs::exists(at("out/unfinished/best.toml")); ++i) std::this_thread::sleep_for(50ms);
  const Workplace elsewhere;
  const Outcome o = elsewhere.run({"optimize", "--resume", "--quiet", "--out", at("out").string()});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr(fmt::format("another run works in this folder (process {} on ", child)));
  EXPECT_THAT(o.err, HasSubstr("softland optimize gold.toml"));
  kill(child, SIGKILL);
  (void)here.finish(child);
}

TEST_F(Resume, LeavesADamagedStoreAsItIs) {
  killed_once("out");
  const fs::path store = at("out/unfinished/evaluations.sqlite");
  for (const char* companion : {"-wal", "-shm"}) fs::remove(store.string() + companion);
  std::string damaged = read(store);
  ASSERT_GT(damaged.size(), 200U);
  for (std::size_t i = 100; i < damaged.size(); ++i) damaged[i] = static_cast<char>(i * 7);
  write(store, damaged);
  const Outcome o = here.run({"optimize", "--resume", "--quiet", "--out", "out"});
  EXPECT_EQ(o.status, 2) << o.err;
  EXPECT_THAT(o.err, HasSubstr("out/unfinished/evaluations.sqlite: "));
  EXPECT_EQ(read(store), damaged);
}

TEST_F(Resume, IsNotMadeOfAnExploration) {
  done(optimize({"--out", "out", "--budget", "20"}));
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"explore", "out/evaluations.sqlite", "--resume"},
                                             {"report", "out/evaluations.sqlite"},
                                             {"slurm", "out/evaluations.sqlite", "--tasks", "2"}})
    refused(words, "out/evaluations.sqlite: holds a search and no exploration; softland table shows its rows");
  const Outcome table = here.run({"table", "out/evaluations.sqlite", "--csv", "--select", "knots_main_level_1_V,cost"});
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.out, testing::StartsWith("knots_main_level_1_V,cost\n"));
}

class Start : public test::Searches {};

TEST_F(Start, FromTheWinnerOfAnotherSearchNeverEndsWorse_slow) {
  done(optimize({"--out", "one", "--budget", "400"}));
  const json found = test::result_in(at("one"));
  done(optimize({"--out", "two", "--budget", "12", "--start", "one/best.toml"}));
  const json refined = test::result_in(at("two"));
  EXPECT_LE(refined["best"]["cost"].get<double>(), found["best"]["cost"].get<double>() * (1 + 1e-9));
  EXPECT_EQ(refined["scene"]["title"], found["scene"]["title"]);
  // The folder and its result.json give the same start.
  done(optimize({"--out", "folder", "--budget", "12", "--start", "one"}));
  EXPECT_EQ(read(at("folder/best.toml")), read(at("two/best.toml")));
  // A further, worse start does no harm.
  done(optimize({"--out", "more", "--budget", "12", "--start", "one/best.toml", "--start", "two/best.toml"}));
  EXPECT_LE(test::result_in(at("more"))["best"]["cost"].get<double>(), refined["best"]["cost"].get<double>() * (1 + 1e-9));
}

TEST_F(Start, FromAnotherFamilyKeepsTheLandingUnlessItFindsABetterOne) {
  done(optimize({"--out", "one", "--budget", "200"}));
  const json found = test::result_in(at("one"));
  done(optimize({"--out", "two", "--budget", "2", "--waveform", "knots", "--start", "one"}));
  const json kept = test::result_in(at("two"));
  EXPECT_LE(kept["best"]["cost"].get<double>(), found["best"]["cost"].get<double>() * (1 + 1e-9));
  EXPECT_TRUE(kept["best"]["parameters"].empty()) << "of the winner, which is no broken line";
  // With the starts, a few more evaluations give a better result than without.
  done(optimize({"--out", "with", "--budget", "30", "--waveform", "knots:12", "--start", "one"}));
  done(optimize({"--out", "without", "--budget", "30", "--waveform", "knots:12"}));
  const auto least = [&](const char* out) {
    const Outcome o = here.run({"table", std::string(out) + "/evaluations.sqlite", "--csv", "--select", "cost"});
    double lowest = 1e9;
    std::istringstream in(o.out);
    for (std::string line; std::getline(in, line);) {
      if (!line.empty() && line != "cost") lowest = std::min(lowest, std::stod(line));
    }
    return lowest;
  };
  EXPECT_LT(least("with"), least("without"));
}

TEST_F(Start, RefusesWhatTheSearchCannotBeginWith) {
  const std::string gold = shipped("mem-gold.toml");
  const auto scene = [&](const char* name, const std::string& waveform) {
    write(at(name), edited(edited(gold, "family = \"step\"\nlevel = \"1.25 Vdp\"", waveform), "1.5 Vdp", "60 V"));
  };
  scene("held.toml", "family = \"pulse\"\nlevels = [\"20 V\", \"5 V\", \"17 V\"]\ntimes = [\"20 us\", \"32 us\"]");
  scene("high.toml",
        "family = \"pulse\"\nlevels = [\"50 V\", \"5 V\", \"18 V\"]\ntimes = [\"20 us\", \"32 us\"]\nedge = \"1 us\"");
  write(at("other.toml"),
        edited(edited(edited(edited(gold, "[waveform.main]", "[waveform.far]"), "[electrode.main]", "[electrode.far]"),
                      "[driver.main]", "[driver.far]"),
               "level = \"1.25 Vdp\"", "level = \"18 V\""));
  const auto with = [](const std::string& file) { return optimize({"--start", file, "--out", "out"}); };
  refused(with("held.toml"), "--start held.toml: drive 'main' ends on 17 V, and the scene holds 18 V, which no search changes");
  refused(with("high.toml"), "--start high.toml: drive 'main': the voltage reaches 50 V, above the driver's max_voltage of 40 V");
  refused(with("other.toml"), "--start other.toml: there is no waveform of the searched drive 'main'");
  refused(with("none.toml"), "none.toml: cannot be read: No such file or directory");
  refused(with(""), "--start: must not be empty");
  fs::create_directory(at("folder"));
  refused(
      with("folder"),
      "folder: is a folder without result.json, best.toml or release.toml; give a scene file, such as folder/NAME.toml, or the folder of --out");
  EXPECT_FALSE(fs::exists(at("out"))) << "nothing is begun";
}

TEST_F(Start, BelongsToTheSearchThatGoesOn) {
  done(optimize({"--out", "one", "--budget", "100"}));
  done(optimize({"--out", "two", "--budget", "30", "--start", "one/best.toml"}));
  fs::remove(at("one/best.toml"));  // the plan contains the scene
  done({"optimize", "--resume", "--quiet", "--out", "two"});
  EXPECT_LE(test::result_in(at("two"))["best"]["cost"].get<double>(),
            test::result_in(at("one"))["best"]["cost"].get<double>() * (1 + 1e-9));
}

}  // namespace
}  // namespace softland
