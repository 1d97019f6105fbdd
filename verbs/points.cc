#include "verbs/points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "studies/closing/auto_settings.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

using nlohmann::json;

// Members of a verb's JSON that are no results of a point, so that an exploration does not store them as columns: scene and
// waveforms, program and settings, computing times, and tables by number of modes.
constexpr std::array<std::string_view, 12> left_out{
    "scene",      "made_with",         "waveforms", "by_modes",  "pulled_through_by_modes_V", "seed", "tolerance",
    "duration_s", "dynamic_precision", "rhs_s",     "has_start", "band_of_contact_gap"};
constexpr std::size_t longest_list = 16;

using Numbers = std::vector<std::pair<std::string, double>>;

std::string text(const json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

void add_numbers(Numbers& numbers, const std::string& key, const json& value) {
  if (value.is_boolean()) return numbers.emplace_back(key, value.get<bool>() ? 1 : 0), void();
  if (value.is_number()) return numbers.emplace_back(key, value.get<double>()), void();
  if (value.is_object()) {
    for (const auto& [name, inner] : value.items()) {
      if (std::ranges::find(left_out, name) == left_out.end()) add_numbers(numbers, key.empty() ? name : key + "." + name, inner);
    }
  }
  if (!value.is_array() || value.size() > longest_list) return;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const json& one = value[i];
    // The description of an omitted or chosen physical effect is stored under the name of the effect, not under its position.
    const bool is_choice = one.is_object() && one.contains("section") && one.contains("choice");
    if (one.is_number() || is_choice)
      add_numbers(numbers, key + "." + (is_choice ? text(one["section"]) + "." + text(one["choice"]) : std::to_string(i + 1)),
                  one);
  }
}

bool has(const Study& study, std::string_view option) {
  return std::ranges::find(study.options, option, &OptionRow::name) != study.options.end();
}

Arguments arguments_of(const Study& study, const OtherStudy::Options& options) {
  Arguments arguments;
  for (const auto& [name, value] : options) {
    const auto option = std::ranges::find(study.options, name, &OptionRow::name);
    require(option != study.options.end() && name != "seed" && name != "jobs",
            [&] { return fmt::format("study {} has no option '{}'", study.name, name); });
    const bool is_flag = option->kind == OptionRow::Kind::flag;
    require(!is_flag || value == "true" || value == "false",
            [&] { return fmt::format("{}={}: must be true or false", name, value); });
    if (!is_flag || value == "true") arguments[name] = {is_flag ? "" : value};
  }
  return arguments;
}

OtherStudy::Record record_of(const Study& study, const SceneFile& scene, const OtherStudy::Options& options, std::uint64_t seed,
                             int jobs, const Progress& progress) {
  Arguments arguments = arguments_of(study, options);
  if (has(study, "seed")) arguments["seed"] = {std::to_string(seed)};
  if (has(study, "jobs")) arguments["jobs"] = {std::to_string(jobs)};
  const Progress silent{.stop = progress.stop};
  const Outcome found =
      study.ask(arguments)({.scene = scene,
                            .name = scene.name(),
                            .command = {},
                            .progress = silent,
                            .prepared =
                                [&](bool default_limits) {
                                  return std::make_shared<const PreparedScene>(prepare_and_choose(scene, default_limits, silent));
                                },
                            .load = [](const std::string& path) { return SceneFile::load(path); },
                            .waveforms_of = {},
                            .text = [&] { return scene.text(); }});
  if (found.ending == Ending::interrupted) throw Interrupted();
  OtherStudy::Record record{.status = found.json.value("status", std::string("done")), .numbers = {}};
  add_numbers(record.numbers, "", found.json);
  return record;
}

}  // namespace

const OtherStudies& studies_of_points() {
  static const OtherStudies all = [] {
    OtherStudies others;
    for (const Study& study : scene_studies()) {
      if (!study.is_explorable) continue;
      others.push_back(
          {.name = study.name,
           .check = [&study](const OtherStudy::Options& options) { static_cast<void>(study.ask(arguments_of(study, options))); },
           .record = [&study](const SceneFile& scene, const OtherStudy::Options& options, std::uint64_t seed, int jobs,
                              const Progress& progress) { return record_of(study, scene, options, seed, jobs, progress); }});
    }
    return others;
  }();
  return all;
}

}  // namespace softland::verbs
