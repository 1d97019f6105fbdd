// The output of the programs in examples/, which tests/install builds against an installed softland.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#define main close_program
#include "examples/01_close.cc"
#undef main
#define main pull_in_map_program
#include "examples/02_pull_in_map.cc"
#undef main
#define main search_program
#include "examples/03_search.cc"
#undef main
#define main own_objective_program
#include "examples/04_own_objective.cc"
#undef main
#define main own_waveform_program
#include "examples/05_own_waveform.cc"
#undef main
#define main own_contact_program
#include "examples/06_own_contact_law.cc"
#undef main

namespace softland {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

std::string scene(const std::string& name) { return std::string(SOFTLAND_SOURCE_DIR) + "/scenes/" + name + ".toml"; }

struct Said {
  int status = 0;
  std::string text;
  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> all;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }
};

Said run(int (*program)(int, char**), std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "example");
  std::vector<char*> words;
  for (std::string& one : arguments) words.push_back(one.data());
  testing::internal::CaptureStdout();
  Said said{.status = program(static_cast<int>(words.size()), words.data())};
  std::fflush(stdout);
  said.text = testing::internal::GetCapturedStdout();
  return said;
}

// Returns the cells of the tables in a page of results/, by the first cell of each row.
std::map<std::string, std::vector<std::string>> rows_of(const std::string& page) {
  std::ifstream in(std::string(SOFTLAND_SOURCE_DIR) + "/results/" + page);
  std::map<std::string, std::vector<std::string>> all;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| ")) continue;
    std::vector<std::string> cells;
    std::istringstream row(line.substr(2));
    for (std::string cell; std::getline(row, cell, '|');) {
      while (!cell.empty() && cell.back() == ' ') cell.pop_back();
      cells.push_back(cell.substr(std::min(cell.size(), cell.find_first_not_of(' '))));
    }
    const std::string name = cells.front();
    all.emplace(name, std::move(cells));
  }
  return all;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

// Compares lines of 03_search with those of results/release.md.
void expect_rows_of_release(const std::vector<std::string>& scenes) {
  std::vector<std::string> files;
  for (const std::string& one : scenes) files.push_back(scene(one));
  const Said said = run(search_program, files);
  EXPECT_EQ(said.status, 0);
  const std::vector<std::string> lines = said.lines();
  ASSERT_EQ(lines.size(), scenes.size() + 1);
  const auto kept = rows_of("release.md");
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const std::vector<std::string>& row = kept.at(scenes[k] + ", electrostatic");
    // Takes one of "28 us to 28 us": five seeds found the same time.
    const auto of_all_seeds = [](const std::string& range) { return range.substr(0, range.find(" to ")); };
    const std::string due = row[1] + " " + row[2] + " " + of_all_seeds(row[3]) + " " + of_all_seeds(row[4]) + " yes";
    std::vector<std::string> found = words_of(lines[k + 1]);
    ASSERT_FALSE(found.empty());
    found.erase(found.begin());
    EXPECT_EQ(found, words_of(due)) << lines[k + 1];
  }
}

TEST(Examples, CloseASwitchAndTellItsFigures) {
  const Said said = run(close_program, {scene("mem-gold")});
  EXPECT_EQ(said.status, 0);
  const Closing closing = simulate(prepare_and_choose(SceneFile::load(scene("mem-gold"))), true);
  std::size_t found = 0;
  for (const std::string& line : said.lines()) {
    if (!line.starts_with("First contact")) continue;
    ++found;
    const std::vector<std::string> words = words_of(line);
    EXPECT_NEAR(std::stod(words[2]), closing.metrics.initial_contact_time, 1e-4 * closing.metrics.initial_contact_time);
  }
  EXPECT_EQ(found, 1u);
  EXPECT_THAT(said.lines().size(), 1 + asked_among(all_figures, {}).size() + 10);
}

TEST(Examples, MapThePullInVoltagesThatResultsHold) {
  const Said said = run([](int, char**) { return pull_in_map_program(); }, {});
  EXPECT_EQ(said.status, 0);
  const std::vector<std::string> lines = said.lines();
  ASSERT_EQ(lines.size(), 11u);
  const auto kept = rows_of("measured-actuators.md");
  const std::vector<std::string> widths = words_of(lines[1]);
  for (std::size_t k = 2; k < lines.size(); ++k) {
    const std::vector<std::string> row = words_of(lines[k]);
    EXPECT_EQ(row.at(3), kept.at(row.at(0)).at(2)) << "springs of 3 um, overlap " << row[0];
  }
  const std::vector<std::string> of_widths = words_of(lines.back());
  for (std::size_t k = 0; k < widths.size(); ++k)
    EXPECT_EQ(of_widths.at(k + 1), kept.at(widths[k]).at(2)) << "overlap 76.5 um, springs of " << widths[k];
}

TEST(Examples, FindTheOpeningsThatResultsHold) { expect_rows_of_release({"two-electrodes", "mem-gold"}); }
TEST(Examples, FindTheOpeningsThatResultsHold_slow) {
  expect_rows_of_release({"mem-gold", "mem-gold-pzt", "nem-tin", "two-electrodes"});
}

TEST(Examples, SearchByAnObjectiveOfTheirOwn) {
  const Said said = run(own_objective_program, {scene("mem-gold")});
  EXPECT_EQ(said.status, 0);
  const std::vector<std::string> lines = said.lines();
  ASSERT_GE(lines.size(), 4u);
  EXPECT_THAT(lines[1], MatchesRegex("plain step .* V .* uN .* us .* nm +1"));
  const std::vector<std::string> found = words_of(lines[2]);
  EXPECT_LT(std::stod(found.back()), 0.7) << lines[2];
  EXPECT_LE(std::stod(found[7]), 1) << lines[2] << ": no significant rebound";
  EXPECT_EQ(lines.back(), "without a rebound, and better than the plain step");
}

TEST(Examples, CloseASwitchByAWaveformOfTheirOwn) {
  const Said said = run(own_waveform_program, {scene("mem-gold")});
  EXPECT_EQ(said.status, 0);
  const std::vector<std::string> lines = said.lines();
  ASSERT_EQ(lines.size(), 9u);
  const auto speed = [&](const std::string& line) { return std::stod(line.substr(line.find("with ") + 5)); };
  EXPECT_THAT(lines[0], testing::StartsWith("as it stands   touches at "));
  EXPECT_LT(speed(lines[1]), speed(lines[0]) / 2);
  EXPECT_THAT(lines[1], testing::EndsWith("highest rebound 0 nm"));
  EXPECT_THAT(said.text, HasSubstr("main.down_s"));
  EXPECT_THAT(lines[8], testing::StartsWith("swell          95 % of 200 devices touch"));
}

TEST(Examples, CloseASwitchOnAContactLawOfTheirOwn) {
  const Said said = run(own_contact_program, {scene("mem-gold")});
  EXPECT_EQ(said.status, 0);
  const std::vector<std::string> lines = said.lines();
  ASSERT_EQ(lines.size(), 3u);
  const auto figures = [](const std::string& line) { return line.substr(line.find("touches")); };
  EXPECT_EQ(figures(lines[0]), figures(lines[1]));
  EXPECT_THAT(lines[2], testing::StartsWith("200 devices touch with 88.61 +- 8.9 mm/s"));
}

TEST(Examples, SayWhatIsWrongWithTheirScene) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(run(close_program, {"no-such.toml"}).status, 2);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("no-such.toml"));
}

}  // namespace
}  // namespace softland
