// Compares the output of `softland report` from a study's JSON with that of the study, for every study in the list: a new study
// needs no test of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/require.h"
#include "reports/report_files.h"
#include "studies/closing/auto_settings.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

using nlohmann::json;

const std::string gold = std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml";

constexpr const char* bench = R"([[measurement]]
quantity = "frequency"
value = "10.5 kHz"
error = "0.5 %"
)";

// Options of small studies; a study without an entry has its defaults.
Arguments arguments_of(const std::string& study) {
  static const std::string measured = testing::TempDir() + "softland_shown_again_bench.toml";
  std::ofstream(measured) << bench;
  const std::map<std::string, Arguments> all{
      {"pull-in", {{"sweep", {"0 V:20 V:9"}}}},
      {"limit", {}},
      {"release", {{"budget", {"60"}}, {"samples", {"8"}}}},
      {"cycle", {{"rate", {"5 kHz"}}, {"samples", {"2"}}, {"cycles", {"2"}}}},
      {"robustness", {{"samples", {"12"}}, {"other-ways", {""}}, {"calibrate", {"Vdp:1 %"}}}},
      {"fit", {{"data", {measured}}, {"starts", {"2"}}, {"unknown", {"structure.youngs_modulus", "structure.thickness"}}}},
      {"calibrate", {{"samples", {"16"}}, {"steps", {"1.2"}}}}};
  const auto found = all.find(study);
  return found == all.end() ? Arguments{} : found->second;
}

// Returns a scene with few modes. The one for `calibrate` has another waveform, since the plain step is no recipe.
SceneFile scene_of(const std::string& study) {
  SceneFile scene = SceneFile::load(gold);
  for (const char* change : {"simulate.accuracy=1e-3", "structure.modes=1", "simulate.duration=100 us"}) scene.set(change);
  if (study == "calibrate")
    scene.set(
        R"(waveform.main={family="table", times=["0 s", "24 us", "24 us", "31 us", "31 us"], voltages=["18 V", "18 V", "0 V", "0 V", "18 V"]})");
  return scene;
}

Outcome outcome_of(const Study& study, const SceneFile& scene) {
  const Progress progress;
  return study.ask(arguments_of(study.name))({.scene = scene,
                                              .name = "gold.toml",
                                              .command = "softland " + std::string(study.name) + " gold.toml",
                                              .progress = progress,
                                              .prepared =
                                                  [&](bool default_limits) {
                                                    return std::make_shared<const PreparedScene>(
                                                        prepare_and_choose(scene, default_limits, progress));
                                                  },
                                              .load = [](const std::string& path) { return SceneFile::load(path); },
                                              .waveforms_of = {},
                                              .text = [&] { return scene.text(); }});
}

class EveryStudy : public testing::TestWithParam<const Study*> {};

// Returns the JSON that the study leaves in a folder, or that of --json, as a file would have it.
json left_by(const Outcome& outcome) {
  for (const Outcome::File& file : outcome.files) {
    if (file.name.ends_with(".json")) return json::parse(file.text());
  }
  return json::parse(outcome.json.dump());
}

// Compares files. Not made again are scenes and tables, which the JSON does not contain, the page of all devices, and the
// sketch of the scene by check.
void expect_same_files(const Outcome& again, const Outcome& found) {
  std::map<std::string, std::string> made;
  for (const Outcome::File& file : again.files) made[file.name] = file.text();
  for (const Outcome::File& file : found.files) {
    const auto one = made.find(file.name);
    EXPECT_TRUE(one != made.end() || file.name.ends_with(".toml") || file.name.ends_with(".csv") ||
                file.name == robustness_files[0] || file.name == "beam.svg")
        << file.name << " is not made again";
    if (one != made.end()) {
      EXPECT_EQ(one->second, file.text()) << file.name;
    }
  }
}

// Returns the reason why the JSON is refused; empty if it is shown.
std::string refusal(const Study& study, const json& record) {
  try {
    for (const Outcome::File& file : study.shown_again(record).files) (void)file.text();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return {};
}

// A missing key is named in the message. A key of another type is named as well, or has no effect.
void expect_refused_where_damaged(const Study& study, const json& whole) {
  EXPECT_EQ(refusal(study, whole), "");
  EXPECT_NE(refusal(study, json::object()), "");
  json more = whole;
  more["beauty"] = 3;
  EXPECT_EQ(refusal(study, more), "\"beauty\" is not known");
  for (const auto& [key, value] : whole.items()) {
    json damaged = whole;
    damaged.erase(key);
    if (key.starts_with("scene")) continue;  // without it a page shows no scene
    EXPECT_NE(refusal(study, damaged), "") << "without " << key;
  }
  const json flat = whole.flatten();
  std::set<std::string> seen;
  for (const auto& [key, value] : flat.items()) {
    // Members with the same name in members with the same name are tested once.
    const std::size_t last = key.rfind('/'), before = last == 0 ? 0 : key.rfind('/', last - 1);
    if (!seen.insert(key.substr(before)).second) continue;
    for (const json& other : {json(), json("x"), json(1e308)}) {
      json damaged = whole;
      damaged[json::json_pointer(key)] = other;
      (void)refusal(study, damaged);
    }
  }
}

TEST_P(EveryStudy, IsShownAgainFromItsJsonAndFromNoOther_long) {
  const Study& study = *GetParam();
  const Outcome found = outcome_of(study, scene_of(study.name));
  const json left = left_by(found), printed = json::parse(found.json.dump());
  EXPECT_EQ(left["kind"], study.name) << "by which report knows the study";
  EXPECT_FALSE(found.text.empty());
  const Outcome again = study.shown_again(left);
  EXPECT_EQ(again.text + again.last, found.text + found.last);
  EXPECT_EQ(again.json, found.json);
  expect_same_files(again, found);
  EXPECT_EQ(study.shown_again(printed).text, found.text) << "curves stand in files alone";
  expect_refused_where_damaged(study, printed);
}

// Returns the studies with a record of their own; tests/apps/shown_again_test.cc has the others.
std::vector<const Study*> every_study() {
  std::vector<const Study*> all;
  for (const Study& study : all_studies()) {
    if (study.ask && study.shown_again && std::string_view(study.name) != "simulate") all.push_back(&study);
  }
  return all;
}

// The record of an exploration is its store, which its JSON names.
TEST(Studies, AllHaveAReaderButAnExploration) {
  for (const Study& study : all_studies()) {
    EXPECT_EQ(static_cast<bool>(study.shown_again), study.takes.json && std::string_view(study.name) != "explore") << study.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Verbs, EveryStudy, testing::ValuesIn(every_study()), [](const auto& study) {
  std::string name = study.param->name;
  std::erase(name, '-');
  return name;
});

}  // namespace
}  // namespace softland::verbs
