// Tests `softland report` on the JSON of verbs without a common runner. tests/verbs/shown_again_test.cc has the others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.h"

namespace softland {
namespace {

struct Run {
  const char* what;  ///< verb that wrote the JSON
  std::vector<std::string> words;
  std::vector<std::string> pages = {};  ///< files of `out` that are made again
};

std::ostream& operator<<(std::ostream& out, const Run& run) { return out << run.what; }

const std::vector<std::string> coarse{"--quiet", "--set", "simulate.accuracy=1e-3", "--set", "structure.modes=1"};

std::vector<Run> runs() {
  const std::string device = std::string(SOFTLAND_PROGRAM) + " device gold.toml --set simulate.accuracy=1e-3";
  const std::vector<std::string> result{"report.html", "gap.svg", "trajectory.csv"};
  return {
      {"simulate", {"simulate", "gold.toml", "--out", "out"}, result},
      {"search", {"optimize", "pzt.toml", "--robust", "none", "--budget", "40", "--out", "out"}, result},
      {"seeds", {"optimize", "pzt.toml", "--robust", "none", "--budget", "40", "--seeds", "2", "--out", "out"}, result},
      {"measure", {"optimize", "pzt.toml", "--robust", "cvar:0.9", "--budget", "400", "--out", "out"}, result},
      {"devices", {"optimize", "pzt.toml", "--budget", "400", "--out", "out"}, {"report.html", "devices.svg"}},
      {"grid", {"explore", "gold.toml", "--vary", "gap.contact=1.6 um:2.4 um:3", "--out", "out.sqlite"}},
      {"front",
       {"explore", "gold.toml", "--vary", "gap.contact=1.6 um:2.4 um", "--pareto", "initial_contact_time,impact_velocity",
        "--sample", "nsga2:8", "--out", "out.sqlite"}},
      {"tuning", {"tune", "gold.toml", "--device", device, "--closings", "1", "--effort", "0.05", "--out", "out"}, {"tune.html"}},
      {"modes", {"modes", "gold.toml"}}};
}

class EveryJson : public testing::TestWithParam<Run> {
 protected:
  [[nodiscard]] Outcome run(std::vector<std::string> words, const std::vector<std::string>& more) const {
    words.insert(words.end(), more.begin(), more.end());
    return here.run(words);
  }
  Workplace here;
};

// Returns the text before the list of files.
std::string findings(const std::string& text) { return text.substr(0, text.find("\nIn ")); }

TEST_P(EveryJson, IsShownAgainWithItsPages_long) {
  std::vector<std::string> more = coarse;
  more.insert(more.end(), {"--json", "run.json"});
  const Outcome first = run(GetParam().words, more);
  ASSERT_TRUE(first.status == 0 || first.status == 4) << first.err;
  std::vector<std::string> pages;
  for (const std::string& page : GetParam().pages) pages.push_back(read(here.path() / "out" / page));
  const Outcome again = here.run({"report", "run.json", "--out", "again"});
  EXPECT_EQ(again.status, 0) << again.err;
  if (GetParam().words[0] == "explore") {
    const Outcome of_store = here.run({"report", "out.sqlite"});
    EXPECT_EQ(findings(again.out), findings(of_store.out));
    EXPECT_EQ(read(here.path() / "again/report.html"), read(here.path() / "out-report/report.html"));
    EXPECT_EQ(findings(here.run({"report", "out-report/exploration.json"}).out), findings(of_store.out));
    fs::remove(here.path() / "out.sqlite");
    EXPECT_THAT(here.run({"report", "run.json"}).err, testing::HasSubstr("\"store\" must name the store of the exploration"));
    return;
  }
  // The first run prints the statements on devices in parts; they are the beginning of the whole text.
  EXPECT_TRUE(first.out.starts_with(findings(again.out).substr(0, again.out.size() - 1))) << first.out << "\nagain:\n"
                                                                                          << again.out;
  if (pages.empty()) return;
  EXPECT_EQ(here.run({"report", "out"}).status, 0);
  for (std::size_t k = 0; k < pages.size(); ++k)
    EXPECT_EQ(read(here.path() / "out" / GetParam().pages[k]), pages[k]) << GetParam().pages[k];
}

INSTANTIATE_TEST_SUITE_P(Verbs, EveryJson, testing::ValuesIn(runs()), [](const auto& given) { return given.param.what; });

}  // namespace
}  // namespace softland
