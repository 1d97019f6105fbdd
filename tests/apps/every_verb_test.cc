// Every verb on every shipped scene ends with a documented status and readable output.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "program.h"

namespace softland {
namespace {

using nlohmann::json;

struct Shipped {
  std::string name, text;
  [[nodiscard]] bool has(const std::string& what) const { return std::regex_search(text, std::regex("\n" + what)); }
  /// Few modes, a coarse accuracy and no compressible film: what is asked here is not how exact the figures are.
  [[nodiscard]] bool has_contact() const { return has("\\[contact[.\\]]") || has("[^\n]*landing = "); }
  [[nodiscard]] std::vector<std::string> quickly(std::vector<std::string> words) const {
    words.insert(words.end(), {"--set", "simulate.accuracy=1e-3"});
    if (!has("kind = \"plate\"")) words.insert(words.end(), {"--set", "structure.modes=2"});
    if (has("model = \"reynolds\"")) words.insert(words.end(), {"--set", "gas.model=strip"});
    return words;
  }
};

std::ostream& operator<<(std::ostream& out, const Shipped& scene) { return out << scene.name; }

std::vector<Shipped> shipped_scenes() {
  std::vector<Shipped> all;
  for (const auto& entry : fs::directory_iterator(fs::path(SOFTLAND_SOURCE_DIR) / "scenes")) {
    if (entry.path().extension() == ".toml") all.push_back({entry.path().filename().string(), read(entry.path())});
  }
  return all;
}

/// Expects the text that a verb printed to be readable: every number is finite, and there is no internal error.
void expect_readable(const std::string& text, const std::string& place) {
  static const std::regex odd("\\b(nan|inf|internal error)\\b", std::regex::icase);
  std::smatch found;
  EXPECT_FALSE(std::regex_search(text, found, odd)) << place << " says " << found.str() << " in\n" << text;
}

class EveryVerb : public testing::TestWithParam<Shipped> {
 protected:
  void SetUp() override {
    write(here.path() / scene().name, scene().text);
    // Copy the files that scenes name.
    for (const auto& entry : fs::directory_iterator(fs::path(SOFTLAND_SOURCE_DIR) / "scenes")) {
      if (entry.path().extension() == ".csv") write(here.path() / entry.path().filename(), read(entry.path()));
    }
  }
  static const Shipped& scene() { return GetParam(); }

  /// Runs a command that must succeed, or end without success.
  Outcome done(const std::vector<std::string>& words) const {
    const Outcome o = finished(words);
    EXPECT_TRUE(o.status == 0 || o.status == 4) << place(words) << ": status " << o.status << ", " << o.err;
    EXPECT_FALSE(o.out.empty()) << place(words);
    return o;
  }
  /// Runs a command that must be refused for this reason.
  void refused(const std::vector<std::string>& words, const std::string& reason) const {
    const Outcome o = finished(words);
    EXPECT_EQ(o.status, 2) << place(words);
    EXPECT_EQ(o.out, "") << place(words);
    EXPECT_NE(o.err.find(reason), std::string::npos) << place(words) << ": " << o.err;
  }
  /// Expects voltages to be exported; the factor of a dispersion force is not a voltage.
  void exports(const std::vector<std::string>& words) const {
    if (scene().has("\\[electrode")) {
      (void)done(words);
    } else {
      refused(words, "there is no waveform to export");
    }
  }
  /// Compares the voltages of each electrode in `check` and `pull-in`, under the same keys.
  static void expect_same_pull_in(const json& checked, const json& pull_in, bool contact) {
    const json& by_name = pull_in["electrodes"];
    const bool is_one = by_name.size() == 1;
    EXPECT_EQ(pull_in["status"], "done");
    std::size_t windows = 0;
    for (const auto& [name, one] : by_name.items()) {
      EXPECT_EQ(is_one ? pull_in["pull_in"] : pull_in["pull_in"][name], one["pull_in"]) << name;
      EXPECT_FALSE(one.contains("scene")) << "as README.md says";
      const json& voltages = one["pull_in"];
      EXPECT_EQ(voltages["static_V"].is_null(), voltages["static_kind"].is_null());
      if (voltages["static_V"].is_null()) continue;  // the electrode is on the far side
      const json& own = is_one || !checked["pull_in"].contains(name) ? checked["pull_in"] : checked["pull_in"][name];
      EXPECT_EQ(own, voltages) << name;
      windows += contact ? 1 : 0;
    }
    EXPECT_EQ(checked["hold_window_V"].size(), windows);
    for (const auto& [name, window] : checked["hold_window_V"].items())
      EXPECT_TRUE(window[1].is_null() || window[0] < window[1]) << name;
  }
  [[nodiscard]] json data(const std::vector<std::string>& words) const {
    const json j = json::parse(done(words).out, nullptr, false);
    EXPECT_TRUE(j.is_object()) << place(words);
    return j;
  }
  Workplace here;

 private:
  static std::string place(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) line += word + " ";
    return line;
  }
  [[nodiscard]] Outcome finished(const std::vector<std::string>& words) const {
    const Outcome o = here.run(words);
    expect_readable(o.out, place(words));
    expect_readable(o.err, place(words));
    return o;
  }
};

TEST_P(EveryVerb, Describes_optimized) {
  const std::string& name = scene().name;
  const bool contact = scene().has_contact();
  const std::string check = done(scene().quickly({"check", name})).out;
  for (const char* figure : {"release", "in-contact period"}) {
    EXPECT_TRUE(contact || check.find(figure) == std::string::npos) << figure << " without contact in\n" << check;
  }
  (void)done(scene().quickly({"modes", name}));
  const json modes = data(scene().quickly({"modes", name, "--json", "-"}));
  EXPECT_FALSE(modes["natural_frequencies_rad_s"].empty());
  EXPECT_FALSE(modes.contains("scene")) << "as README.md says";
  const json checked = data(scene().quickly({"check", name, "--quiet", "--json", "-"}));
  EXPECT_EQ(keys(checked),
            (std::set<std::string>{"kind", "file", "lines", "status", "title", "natural_frequencies_rad_s", "pull_in",
                                   "dynamic_precision", "hold_window_V", "closed_state", "duration_s", "tolerance", "stable_path",
                                   "warnings", "scene", "version", "made_with", "command"}));
  EXPECT_EQ(checked["stable_path"].is_null() && check.find("through stable equilibria;") != std::string::npos, false) << check;
  EXPECT_EQ(checked["natural_frequencies_rad_s"], modes["natural_frequencies_rad_s"]);
  EXPECT_EQ(checked["closed_state"].is_object(), contact);
  EXPECT_EQ(checked["scene"]["structure"]["kind"].is_string(), true);
  if (scene().has("\\[electrode")) {
    const std::string text = done(scene().quickly({"pull-in", name})).out;
    EXPECT_EQ(text.find("release") != std::string::npos, contact) << text;
    const json pull_in = data(scene().quickly({"pull-in", name, "--json", "-"}));
    expect_same_pull_in(checked, pull_in, contact);
  } else {
    refused(scene().quickly({"pull-in", name}), "the scene has no electrode");
  }
  for (const char* format : {"csv", "spice-pwl"}) exports({"export", name, "--format", format});
}

TEST_P(EveryVerb, Simulates_optimized) {
  const std::string& name = scene().name;
  const bool contact = scene().has_contact();
  const json j = data(scene().quickly({"simulate", name, "--quiet", "--json", "-"}));
  const json& m = j["metrics"];
  EXPECT_TRUE(m["initial_contact_time_s"].is_number());
  for (const char* figure : {"bounce_count", "major_bounce_height_m", "peak_contact_force_N", "settled"}) {
    EXPECT_EQ(!m[figure].is_null(), contact) << figure;
  }
  EXPECT_EQ(!j["errors"]["major_bounce_height_m"].is_null(), contact);
  for (const char* option : {"", "--certify"}) {
    std::vector<std::string> words = scene().quickly({"simulate", name, "--quiet", "--out", "out"});
    if (*option != '\0') words.emplace_back(option);
    const std::string text = done(words).out;
    for (const char* figure : {"Rebounds", "Highest rebound", "Peak contact force", "Settled", "window ends"}) {
      EXPECT_TRUE(contact || text.find(figure) == std::string::npos) << figure << " without contact in\n" << text;
    }
    EXPECT_NE(text.find("First contact"), std::string::npos) << text;
    EXPECT_GT(fs::file_size(here.path() / "out/report.html"), 10'000U);
  }
  (void)done({"report", "out"});
  exports({"export", "out"});
}

TEST_P(EveryVerb, FindsTheLimit_slow) {
  const std::vector<std::string> words = scene().quickly({"limit", scene().name, "--no-curves", "--quiet", "--out", "out"});
  if (!scene().has_contact()) return refused(words, "limit needs a [contact]");
  if (!scene().has("\\[electrode")) return refused(words, "needs an electrode");
  EXPECT_NE(done(words).out.find("least time, impact velocity at most"), std::string::npos);
  const json j = json::parse(read(here.path() / "out/limit.json"), nullptr, false);
  EXPECT_GT(j["touch"]["least_time_s"], 0);
  EXPECT_LE(j["touch"]["impact_velocity_m_s"], 1.0001 * j["permitted_impact_velocity_m_s"].get<double>());
  EXPECT_GT(fs::file_size(here.path() / "out/limit.svg"), 100U);
  if (!fs::exists(here.path() / "out/best.toml")) return;
  const json again = data(scene().quickly({"limit", scene().name, "--no-curves", "--quiet", "--start", "out", "--json", "-"}));
  EXPECT_LE(again["touch"]["least_time_s"], (1 + 1e-4) * j["touch"]["least_time_s"].get<double>());
}

TEST_P(EveryVerb, OpensAgain) {
  const std::vector<std::string> words =
      scene().quickly({"release", scene().name, "--budget", "300", "--samples", "10", "--quiet", "--out", "out"});
  if (!scene().has_contact()) return refused(words, "release needs a [contact]");
  if (!scene().has("\\[electrode")) return refused(words, "needs an electrode");
  EXPECT_NE(done(words).out.find("settling time in the open position"), std::string::npos);
  const json j = json::parse(read(here.path() / "out/release.json"), nullptr, false);
  EXPECT_LT(j["best"]["figures"]["residual_vibration_m"], j["plain"]["figures"]["residual_vibration_m"]);
  EXPECT_GT(fs::file_size(here.path() / "out/release.svg"), 1000U);
  // The drives begin at their hold levels and end at 0 V.
  const std::string csv = read(here.path() / "out/release.csv");
  const json drive = j["best"]["waveforms"].begin().value();
  EXPECT_EQ(drive.front()[1], j["hold_levels"][j["best"]["waveforms"].begin().key()]);
  EXPECT_EQ(csv.rfind("time_s,", 0), 0U);
  EXPECT_NE(csv.find("\n0,"), std::string::npos);
  EXPECT_TRUE(csv.ends_with(",0\n")) << csv;
  EXPECT_LE(j["devices"]["count"], 10);
  EXPECT_EQ(done({"export", "out/release.toml"}).out.rfind("time_s,", 0), 0U);
}

TEST_P(EveryVerb, CyclesAtARate_optimized) {
  const json closed = data(scene().quickly({"simulate", scene().name, "--quiet", "--json", "-"}))["metrics"];
  const json& touch = closed["initial_contact_time_s"];
  constexpr double long_cycle = 40;  // period over the time of the first touch
  const double rate = touch.is_number() ? 1 / (long_cycle * touch.get<double>()) : 1e3;
  const std::vector<std::string> words = scene().quickly(
      {"cycle", scene().name, "--rate", std::to_string(rate) + " Hz", "--no-scan", "--cycles", "2", "--quiet", "--out", "out"});
  if (!scene().has_contact()) return refused(words, "cycle needs a [contact]");
  const std::string text = done(words).out;
  const json j = json::parse(read(here.path() / "out/cycle.json"), nullptr, false);
  EXPECT_TRUE(text.starts_with("At ")) << text;
  const json& drive = j["drives"].back();
  ASSERT_EQ(drive["status"], "done") << drive["message"];
  ASSERT_EQ(drive["cycles"].size(), 2U);
  const bool sticks = text.find("does not open in every cycle") != std::string::npos;
  EXPECT_EQ(sticks, scene().name == "nem-casimir.toml") << "which adhesion holds at 0 V";
  for (const json& cycle : drive["cycles"]) {
    if (sticks) break;
    EXPECT_TRUE(cycle["opening_time_s"].is_number() && cycle["opening_time_s"] >= 0) << cycle;
    EXPECT_GT(cycle["closed_time_s"], 0);
    EXPECT_GT(cycle["largest_impact_velocity_m_s"], 0);
  }
  // With several contacts the first touch of a cycle is that of all contacts.
  if (!j["scene"]["contact"].contains("model")) return;
  EXPECT_NEAR(drive["cycles"][0]["initial_contact_time_s"].get<double>(), touch.get<double>(), 1e-5 * touch.get<double>());
}

TEST_P(EveryVerb, SearchesAPairForARate_slow) {
  constexpr double periods = 12;  // periods of the first mode in a cycle
  const json modes = data(scene().quickly({"modes", scene().name, "--json", "-"}))["natural_frequencies_rad_s"];
  const std::string rate = std::to_string(modes[0].get<double>() / (2 * M_PI * periods)) + " Hz";
  const std::vector<std::string> words =
      scene().quickly({"optimize", scene().name, "--cycle", rate, "--budget", "30", "--quiet", "--out", "out"});
  if (!scene().has_contact()) return refused(words, "optimize needs a [contact]");
  if (!scene().has("\\[electrode")) return refused(words, "needs an electrode, and the scene has none");
  (void)done(words);
  const json j = json::parse(read(here.path() / "out/cycle.json"), nullptr, false);
  ASSERT_EQ(j["drives"].size(), 2U);
  ASSERT_EQ(j["drives"][1]["status"], "done") << j["drives"][1]["message"];
  // The written scene has the same cycles.
  const json again =
      data({"cycle", "out/best.toml", "--rate", rate, "--no-scan", "--cycles", "2", "--quiet", "--json", "-"})["drives"][1];
  for (const char* key : {"initial_contact_time_s", "largest_impact_velocity_m_s", "major_bounce_height_m"})
    EXPECT_EQ(again["cycles"][1][key], j["drives"][1]["cycles"][1][key]) << key;
}

TEST_P(EveryVerb, Compares_optimized) {
  (void)done(scene().quickly({"effects", scene().name, "--quiet", "--json", "effects.json"}));
  const std::string written = read(here.path() / "effects.json");
  EXPECT_TRUE(json::parse(written, nullptr, false).is_object()) << written;
}

TEST_P(EveryVerb, Measures_optimized) {
  // A beam with a contact takes some seconds, and is in tests/apps/command_line_test.cc.
  if (!scene().has("kind = \"plate\"") && scene().has_contact()) return;
  (void)done(scene().quickly({"accuracy", scene().name, "--quiet", "--json", "accuracy.json"}));
  const std::string written = read(here.path() / "accuracy.json");
  EXPECT_TRUE(json::parse(written, nullptr, false).is_object()) << written;
}

TEST_P(EveryVerb, Judges_long) {
  const std::string& name = scene().name;
  const std::vector<std::string> words = scene().quickly({"robustness", name, "--quiet", "--samples", "20", "--jobs", "1"});
  if (!scene().has_contact()) {
    refused(words, "robustness needs a [contact] section");
    return;
  }
  std::vector<std::string> kept = words;
  kept.insert(kept.end(), {"--out", "out"});
  const std::string text = done(kept).out;
  EXPECT_NE(text.find("plain step"), std::string::npos) << text;
  const json j = json::parse(read(here.path() / "out/robustness.json"), nullptr, false);
  EXPECT_EQ(j["devices"], 20);
  EXPECT_EQ(j["drives"][0]["worst"].size(), 10U);
  EXPECT_EQ(j["hold_window_V"].empty(), !scene().has("\\[electrode"));
  for (const auto& [electrode, window] : j["hold_window_V"].items()) {
    EXPECT_TRUE(window[1].is_null() || window[0] < window[1]) << electrode;
    EXPECT_EQ(j["hold_window_devices"], 20);
    EXPECT_NE(text.find("Hold voltages that keep 99 % of 20 devices closed"), std::string::npos) << text;
    EXPECT_NE(read(here.path() / "out/robustness.html").find("Hold voltages that keep"), std::string::npos);
  }
  (void)done({"simulate", "out/worst-1.toml", "--quiet"});
}

// A device answers a shot of the drive `main`, or names the drives that it has.
TEST_P(EveryVerb, IsPractisedOn_optimized) {
  write(here.path() / "stdin.txt",
        "{\"shot\":1,\"hold_s\":1e-05,\"drives\":{\"main\":{\"time_s\":[0,1e-06],\"V\":[0,0.001]}}}\n");
  const std::vector<std::string> words = scene().quickly({"device", scene().name, "--quiet"});
  if (!scene().has_contact()) return refused(words, "needs a [contact] section: a laboratory records");
  const json answer = data(words);
  EXPECT_EQ(answer["shot"], 1);
  EXPECT_NE(answer.contains("edges_s"), answer.contains("error")) << answer;
  EXPECT_EQ(answer.contains("edges_s"), scene().has("\\[electrode\\.main\\]")) << answer;
}

TEST_P(EveryVerb, Searches_long) {
  for (const char* actuator : {"electrostatic", "pzt", "both"}) {
    const std::vector<std::string> words = scene().quickly({"optimize", scene().name, "--quiet", "--robust", "none", "--budget",
                                                            "2", "--jobs", "1", "--actuator", actuator, "--out", actuator});
    const bool has_electrode = scene().has("\\[electrode"), has_piezo = scene().has("\\[piezo\\]");
    if (!scene().has_contact()) {
      refused(words, "optimize needs a [contact] section");
    } else if (!has_electrode && *actuator != 'p') {
      refused(words, "needs an electrode");
    } else if (!has_piezo && *actuator != 'e') {
      refused(words, "needs a [piezo] section");
    } else {
      (void)done(words);
    }
  }
}

TEST(LimitCurves, FallWithTheVoltageAndTheSpeedAndAreDrawn_long) {
  const Workplace here;
  const std::string scene = (fs::path(SOFTLAND_SOURCE_DIR) / "scenes/two-electrodes.toml").string();
  const Outcome o = here.run({"limit", scene, "--quiet", "--out", "out"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_NE(o.out.find("voltage up to"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find(" optima found, "), std::string::npos) << o.out;
  const std::string svg = read(here.path() / "out/limit.svg");
  for (const char* title : {"Least time against the peak voltage", "Least time against the permitted impact velocity"})
    EXPECT_NE(svg.find(title), std::string::npos) << title;
  const json j = json::parse(read(here.path() / "out/limit.json"), nullptr, false);
  const std::string log = read(here.path() / "out/attempts.csv");
  EXPECT_EQ(std::ranges::count(log, '\n'), static_cast<long>(j["attempts"].size()) + 1) << log;
  for (const char* curve : {"over_peak_voltage", "over_impact_velocity"}) {
    double before = std::numeric_limits<double>::infinity();
    int found = 0;
    for (const json& least : j[curve]) {
      if (least["status"] != "done") continue;
      EXPECT_LT(least["least_time_s"], before) << curve;
      before = least["least_time_s"];
      ++found;
    }
    EXPECT_GE(found, 6) << curve;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryVerb, testing::ValuesIn(shipped_scenes()), [](const auto& given) {
  std::string name = fs::path(given.param.name).stem();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

std::vector<std::string> kinds_of_new(const Workplace& here) {
  std::string refusal = here.run({"new", "?"}).err;  // the message lists the kinds
  refusal = refusal.substr(refusal.find("one of ") + 7);
  static const std::regex kind("[a-z-]+");
  std::vector<std::string> kinds;
  for (auto at = std::sregex_iterator(refusal.begin(), refusal.end(), kind); at != std::sregex_iterator(); ++at)
    kinds.push_back(at->str());
  EXPECT_GE(kinds.size(), 7U);
  return kinds;
}

TEST(EveryKind, OfNewSceneIsCheckedAndSaysHowDevicesDiffer_optimized) {
  const Workplace here;
  for (const std::string& kind : kinds_of_new(here)) {
    const Outcome o = here.run({"new", kind});
    EXPECT_EQ(o.status, 0) << kind;
    EXPECT_NE(o.out.find("\n[spread]\n"), std::string::npos) << kind;
    write(here.path() / "my.toml", o.out);
    const Outcome check = here.run({"check", "my.toml", "--quiet"});
    EXPECT_EQ(check.status, 0) << kind << check.err;
    EXPECT_EQ(check.out.find("plate_strain"), std::string::npos) << check.out;
  }
}

// A new scene is used in all the ways that the manual suggests next.
TEST(EveryKind, OfNewSceneIsSimulatedSearchedAndJudged_slow) {
  const Workplace here;
  for (const std::string& kind : kinds_of_new(here)) {
    write(here.path() / "my.toml", here.run({"new", kind}).out);
    for (std::vector<std::string> words : {std::vector<std::string>{"simulate", "my.toml", "--out", "closing"},
                                           {"optimize", "my.toml", "--robust", "none", "--budget", "60", "--out", "found"},
                                           {"robustness", "my.toml", "--samples", "20", "--out", "devices"}}) {
      for (const char* quick : {"--quiet", "--set", "simulate.accuracy=1e-4"}) words.emplace_back(quick);
      const Outcome run = here.run(words);
      EXPECT_TRUE(run.status == 0 || (run.status == 4 && words[0] == "optimize")) << kind << " " << words[0] << run.err;
      expect_readable(run.out + run.err, kind + " " + words[0]);
    }
  }
}

}  // namespace
}  // namespace softland
