#include "apps/explore_request.h"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "apps/scenes.h"
#include "apps/values.h"
#include "base/printable.h"
#include "base/require.h"
#include "base/shortened.h"
#include "studies/exploration/front_search.h"

namespace softland::apps {
namespace {

// The plan in the words of the options.
PlanRequest plan_of_options(const Common& c, const ExploreRequest& r) {
  PlanRequest plan{.scene = load_scene(c), .vary = r.vary, .sample = r.sample, .pareto = r.pareto};
  if (!r.pareto.empty() && r.sample.empty()) plan.sample = usual_front_sample;
  const std::map<std::string, std::string> given = r.of_plan();
  plan.place = [given, vary = r.vary, options = r.options](std::string_view key, std::size_t number) {
    const auto found = given.find(std::string(key));
    const std::string value = key == "vary" && number < vary.size() ? vary[number] : found == given.end() ? "" : found->second;
    if (key == "options") return fmt::format("--option {}", shortened(printable_line(visible(in_words(options, ", ")))));
    return key == "certify" ? std::string("--certify") : fmt::format("--{} {}", key, shortened(printable_line(visible(value))));
  };
  if (!r.study.empty()) plan.study = r.study;
  for (const std::string_view name : plan_options) {
    if (const auto value = given.find(std::string(name)); value != given.end()) plan.options[value->first] = value->second;
  }
  add_options(plan, r.options);
  plan.seed = seed_of(r.seed, plan.seed);
  if (!r.list.empty()) {
    require(r.vary.empty() && plan.sample.empty(), [&] {
      return fmt::format("--list {}: gives the points: --vary and --sample are not for it, nor is --pareto", r.list);
    });
    read_list(plan, r.list);
  }
  require(!plan.vary.empty() || !plan.columns.empty(),
          "nothing varies: give --vary KEY=LOW:HIGH:N, --sample with --vary KEY=LOW:HIGH, --list FILE.csv, or a plan file");
  return plan;
}

}  // namespace

std::map<std::string, std::string> ExploreRequest::of_plan() const {
  std::map<std::string, std::string> given;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) given.emplace(name, value);
  };
  if (!vary.empty()) given.emplace("vary", vary.front());
  add("sample", sample);
  add("pareto", pareto);
  add("list", list);
  add("study", study);
  add("target", target);
  add("actuator", actuator);
  add("waveform", waveform);
  add("optimizer", optimizer);
  if (samples) given.emplace("samples", *samples);
  if (budget) given.emplace("budget", *budget);
  if (seed) given.emplace("seed", *seed);
  if (!options.empty()) given.emplace("option", options.front());
  if (certify) given.emplace("certify", "true");
  return given;
}

PlanRequest plan_request(const Common& c, const ExploreRequest& r) {
  const bool of_store = is_store(c.scene);
  if (!of_store && !is_plan(SceneFile::load(c.scene))) return plan_of_options(c, r);
  const std::map<std::string, std::string> given = r.of_plan();
  require(given.empty() && c.set.empty(), [&] {
    return fmt::format("{}: holds the whole plan: --{} is not for it", c.scene, given.empty() ? "set" : given.begin()->first);
  });
  if (!of_store) return read_plan(SceneFile::load(c.scene));
  return exploration_in(StudyReader(c.scene));
}

Shard shard_of(const ExploreRequest& r, const std::string& store) {
  if (r.shard.empty()) return store.empty() ? Shard{} : StudyReader(store).plan().shard;
  try {
    return shard_from(r.shard);
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("--shard: {}", error.what()));
  }
}

}  // namespace softland::apps
