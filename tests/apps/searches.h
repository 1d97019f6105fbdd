// Fixture for quick searches and the files that they leave.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "explorations.h"
#include "program.h"

namespace softland::test {

using nlohmann::json;

/// Options for quick closings: few modes, a loose accuracy, voltages that need no pull-in voltage, and a window that contains
/// every landing that a search may choose.
inline const std::vector<std::string> quick_closings{"--set", "structure.modes=2",           "--set", "simulate.accuracy=1e-3",
                                                     "--set", "simulate.duration=150 us",    "--set", "waveform.main.level=18 V",
                                                     "--set", "driver.main.max_voltage=40 V"};

/// Options that replace some of `quick_closings` for a search that is slow enough to be killed.
inline const std::vector<std::string> slower{"--set", "structure.modes=8"};

/// Returns the words of a search for the nominal device, unless `more` requests others.
inline std::vector<std::string> optimize(std::vector<std::string> more) {
  std::vector<std::string> words{"optimize", "gold.toml", "--quiet"};
  words.insert(words.end(), quick_closings.begin(), quick_closings.end());
  if (std::find(more.begin(), more.end(), "--robust") == more.end()) words.insert(words.end(), {"--robust", "none"});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Removes everything that may differ between two runs of one search: times and command lines.
inline void forget_circumstances(json& j) {
  if (j.is_object()) {
    for (const char* key : {"wall_s", "command", "reproduce"}) j.erase(key);
  }
  if (j.is_structured()) {
    for (json& inner : j) forget_circumstances(inner);
  }
}

inline json result_in(const fs::path& folder) {
  json result = json::parse(read(folder / "result.json"), nullptr, false);
  forget_circumstances(result);
  return result;
}

/// Expects two folders to have bit for bit the same search.
inline void expect_same_search(const fs::path& a, const fs::path& b) {
  EXPECT_FALSE(read(a / "best.toml").empty());
  for (const char* name : {"best.toml", "best.csv", "evaluations.csv", "trajectory.csv"})
    EXPECT_EQ(read(a / name), read(b / name)) << name;
  const json one = result_in(a), other = result_in(b);
  EXPECT_TRUE(one.is_object());
  EXPECT_TRUE(one == other) << json::diff(one, other).dump().substr(0, 2000);
}

class Searches : public testing::Test {
 protected:
  [[nodiscard]] fs::path at(const std::string& name) const { return here.path() / name; }
  void done(const std::vector<std::string>& words) const {
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 0) << o.err;
  }
  void refused(const std::vector<std::string>& words, const std::string& message) const {
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 2) << o.err;
    EXPECT_EQ(o.err, "softland: " + message + "\n");
    EXPECT_EQ(o.out, "");
  }
  const Workplace here;
};

}  // namespace softland::test
