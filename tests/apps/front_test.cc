// Tests fronts and pages of explorations as a user does.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "explorations.h"

namespace softland {
namespace {

using nlohmann::json;
using test::expect_same_rows;
using test::Explore;
using test::explore;
using test::rows_of;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string aims = "initial_contact_time,impact_velocity,peak_voltage";

std::vector<std::string> search(const std::string& store, int points, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = explore({"--vary", "waveform.main.level=18 V:30 V", "--vary", "gap.contact=1.6 um:2.2 um",
                                            "--pareto", aims, "--sample", fmt::format("nsga2:{}", points), "--out", store});
  words.insert(words.end(), {"--set", "simulate.duration=600 us"});  // a window in which the closings settle
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class Front : public Explore {};

TEST_F(Front, HoldsNoPointThatAnotherOneBeatsAndEachRunsAsItIs_optimized) {
  const json j = done(search("front.sqlite", 150, {"--jobs", "2"}));
  EXPECT_EQ(j["rows"]["computed"], 150);
  const json& members = j["pareto"]["front"];
  ASSERT_GE(members.size(), 10U);
  EXPECT_GT(j["pareto"]["hypervolume"].get<double>(), 0);
  const auto values = [](const json& member) {
    return std::vector<double>{member["values"]["initial_contact_time_s"], member["values"]["impact_velocity_m_s"],
                               member["values"]["peak_voltage_V"]};
  };
  for (const json& a : members) {
    for (const json& b : members) {
      if (a == b) continue;
      const std::vector<double> x = values(a), y = values(b);
      EXPECT_FALSE(x[0] <= y[0] && x[1] <= y[1] && x[2] <= y[2]) << a << b;
    }
  }
  expect_simulated("front.sqlite", members.front()["point"]);
  expect_simulated("front.sqlite", members.back()["point"]);
}

TEST_F(Front, HasTheSameRowsForAnyJobsAndAfterAnInterruption_slow) {
  static_cast<void>(done(search("whole.sqlite", 180, {"--jobs", "1"})));
  static_cast<void>(done(search("threads.sqlite", 180, {"--jobs", "3"})));
  expect_same_rows(rows_of(at("whole.sqlite")), rows_of(at("threads.sqlite")));
  // A shorter search finds the first points of a longer one.
  static_cast<void>(done(search("parts.sqlite", 70)));
  const json j = done(search("parts.sqlite", 180, {"--resume"}));
  EXPECT_EQ(j["rows"]["known"], 70);
  EXPECT_EQ(j["rows"]["computed"], 110);
  expect_same_rows(rows_of(at("whole.sqlite")), rows_of(at("parts.sqlite")));
  EXPECT_EQ(done({"explore", "parts.sqlite", "--resume", "--quiet"})["rows"]["computed"], 0);
}

TEST_F(Front, IsRefusedWithTheRule) {
  const auto refused = [&](std::vector<std::string> words) {
    const Outcome o = here.run(explore(std::move(words)));
    EXPECT_EQ(o.status, 2);
    return o.err;
  };
  const std::string box = "waveform.main.level=18 V:30 V";
  EXPECT_THAT(refused({"--vary", box, "--pareto", "impact_velocity,beauty"}), HasSubstr("\"beauty\" is not among the figures"));
  EXPECT_THAT(refused({"--vary", box, "--pareto", "impact_velocity"}), HasSubstr("at least two"));
  EXPECT_THAT(refused({"--vary", box, "--pareto", aims, "--sample", "sobol:8"}), HasSubstr("nsga2:N"));
  EXPECT_THAT(refused({"--vary", box, "--sample", "nsga2:80"}), HasSubstr("needs both its figures"));
  EXPECT_THAT(refused({"--vary", box, "--pareto", aims, "--shard", "1/2"}), HasSubstr("cannot be divided"));
  EXPECT_FALSE(fs::exists(at("softland-out.sqlite")));
}

TEST_F(Front, HasAPageWithTheWaveformsOfItsPoints_optimized) {
  static_cast<void>(done(search("front.sqlite", 80)));
  const Outcome o = here.run({"report", "front.sqlite", "--quiet"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("Pareto front: "));
  EXPECT_THAT(o.out, HasSubstr("* is the knee"));
  const std::string page = read(here.path() / "front-report/report.html");
  EXPECT_THAT(page, HasSubstr("id=\"front\""));
  EXPECT_THAT(page, HasSubstr("\"waveforms\":{"));
  EXPECT_EQ(json::parse(read(here.path() / "front-report/exploration.json"))["pareto"]["aims"].size(), 3U);
}

TEST_F(Front, OfAGridIsMarkedInItsReportBesideAMap) {
  static_cast<void>(done(
      explore({"--vary", "waveform.main.level=18 V:30 V:5", "--vary", "gap.contact=1.6 um:2.2 um:4", "--out", "map.sqlite"})));
  const Outcome o = here.run({"report", "map.sqlite", "--out", "page", "--map", "impact_velocity", "--pareto",
                              "initial_contact_time,impact_velocity", "--quiet"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(read(here.path() / "page/report.html"), HasSubstr("id=\"map\""));
  EXPECT_THAT(read(here.path() / "page/map.svg"), HasSubstr("Impact velocity over waveform.main.level and gap.contact"));
  const Outcome bad = here.run({"report", "map.sqlite", "--map", "beauty"});
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, HasSubstr("--map beauty: must be a figure of this exploration: "));
  EXPECT_EQ(here.run({"report", "map.sqlite", "--pareto", "impact_velocity,beauty"}).status, 2);
}

}  // namespace
}  // namespace softland
