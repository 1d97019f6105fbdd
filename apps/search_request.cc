#include "apps/search_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "apps/scenes.h"
#include "apps/values.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/shortened.h"
#include "config/aim.h"
#include "config/criterion.h"
#include "config/units.h"
#include "studies/prepared.h"
#include "studies/search_setting.h"

namespace softland::apps {
namespace {

using nlohmann::json;

constexpr const char* kind = "search";
constexpr const char* raced_families_key = "raced_waveform";  // as it was given

// What `parse` gives; its complaints name the option.
template <class Parse>
auto read(const std::string& option, const Parse& parse) {
  try {
    return parse();
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("{}: {}", option, error.what()));
  }
}

std::vector<Criterion> read_conditions(const OptimizeRequest& request, std::span<const Figure> figures) {
  std::vector<Criterion> all;
  for (const std::string& text : request.conditions)
    all.push_back(read("--constrain", [&] { return parse_criterion(text, figures); }));
  return all;
}

// "2500" evaluations or "90 s".
void read_budget(const std::string& text, OptimizeOptions& options) {
  const auto rule = [&](bool ok) {
    require(ok, fmt::format("--budget {}: must be a whole number of evaluations such as 2500, or a time such as \"90 s\"",
                            shown(text)));
  };
  Quantity q;
  try {
    q = parse_quantity(text);
  } catch (const InvalidInput&) {
    rule(false);
  }
  if (q.dimension == dimension::time) {
    rule(q.value > 0);
    options.max_seconds = q.value;
    options.max_evaluations = 1'000'000'000;
  } else {
    rule(q.dimension == dimension::none && q.value >= 1 && q.value <= 1e9 && q.value == std::floor(q.value));
    options.max_evaluations = static_cast<long>(q.value);
  }
}

// A word of the plan that is gone on with, or `otherwise`.
std::string word_of(const json& known, const char* key, const std::string& otherwise) {
  const auto found = known.find(key);
  return known.is_object() && found != known.end() && found->is_string() ? found->get<std::string>() : otherwise;
}

constexpr const char *by_race = "auto", *nominal_alone = "none";

// Whether devices are searched by a measure of the user's.
bool is_by_measure(const OptimizeRequest& r) { return r.robust != by_race && r.robust != nominal_alone; }

// The families that do best where none is given. Devices that differ want one that is slow and free, or, where each is driven in
// its own units, a quick one that holds fast.
std::string waveform_of(const OptimizeRequest& r, const SceneFile& scene) {
  if (is_by_measure(r))
    return std::string(r.calibration.empty() || r.calibration == "none" ? default_robust_family : default_calibrated_family);
  const Named<Actuator>* actuator = find_named(actuators, r.actuator);
  return actuator == nullptr ? std::string() : std::string(default_families(shaped_drives(scene, actuator->value)));
}

// The request with the words of the plan where none were given.
OptimizeRequest with_known(OptimizeRequest r, const json& known, const SceneFile& scene) {
  const auto fill = [&](std::string& value, const char* key, const std::string& otherwise) {
    if (value.empty()) value = word_of(known, key, otherwise);
  };
  fill(r.target, "target", "bounce");
  fill(r.actuator, "actuator", "electrostatic");
  fill(r.optimizer, "optimizer", "auto");
  // A plan that says nothing of devices is of the nominal one.
  fill(r.robust, "robust", known.is_object() || r.seeds ? nominal_alone : by_race);
  fill(r.calibration, "calibrate", "");
  fill(r.waveform, "waveform", waveform_of(r, scene));
  if (!known.is_object()) return r;
  if (r.conditions.empty() && known.contains("constrain")) known.at("constrain").get_to(r.conditions);
  const auto fill_given = [&](std::optional<std::string>& value, const char* key) {
    if (const std::string word = word_of(known, key, ""); !value && !word.empty()) value = word;
  };
  fill_given(r.samples, "samples");
  fill_given(r.budget, "budget");
  fill_given(r.seed, "seed");
  fill_given(r.seeds, "seeds");
  return r;
}

OptimizeOptions read_options(const Common& c, const OptimizeRequest& request, const SceneFile& scene) {
  const Named<Actuator>* actuator = find_named(actuators, request.actuator);
  require(actuator != nullptr, [&] { return fmt::format("--actuator {}: must be {}", request.actuator, listed(actuators)); });
  const Aim target = read("--target " + request.target, [&] { return parse_aim(request.target); });
  OptimizeOptions options = usual_options(scene, target, actuator->value);
  options.family = request.waveform;
  options.optimizer = request.optimizer;
  options.stop = c.stop;
  options.jobs = job_count(request.jobs);
  options.seed = seed_of(request.seed, options.seed);
  if (is_by_measure(request)) options.max_evaluations = default_closings;
  if (is_by_measure(request) || request.budget) options.more_evaluations = 0;
  if (request.robust == nominal_alone) options.conditions = read_conditions(request, conditioned_figures);
  if (request.budget) read_budget(*request.budget, options);
  // Other methods go on where they were; the plan of a search of one seed holds that number.
  const bool has_one_seed = !request.seeds || *request.seeds == "1";
  options.begins_with_half = request.robust == nominal_alone && request.budget && has_one_seed && request.optimizer == "auto";
  return options;
}

// Conditions that name figures of both are for the drawing and for the devices.
void read_shared_conditions(const OptimizeRequest& request, std::vector<Criterion>& drawing, std::vector<Criterion>& devices) {
  for (const std::string& text : request.conditions) {
    read("--constrain", [&] {
      devices.push_back(parse_criterion(text, device_figures));
      return true;
    });
    try {
      drawing.push_back(parse_criterion(text, conditioned_figures));
    } catch (const InvalidInput&) {
      continue;  // a figure of devices alone
    }
  }
}

ForDevicesOptions read_race_options(const OptimizeRequest& request, OptimizeOptions& options) {
  ForDevicesOptions race;
  read_shared_conditions(request, options.conditions, race.conditions);
  race.verdict = sample_count(request.samples, race.verdict, 100, most_searched);
  if (!request.budget) return race;
  if (std::isfinite(options.max_seconds)) {
    constexpr double usual_seconds = 60, most_lengths = 10;
    race.closings = static_cast<long>(static_cast<double>(race_closings) *
                                      std::clamp(options.max_seconds / usual_seconds, 0.25, most_lengths));
    return race;
  }
  share_budget(options, race);
  return race;
}

RobustOptions read_robust_options(const OptimizeRequest& request) {
  const std::span<const Figure> figures = device_figures;
  RobustOptions robust;
  robust.aim.measure = read("--robust " + request.robust, [&] { return parse_robust_measure(request.robust, figures); });
  robust.aim.conditions = read_conditions(request, figures);
  robust.samples = sample_count(request.samples, robust.samples, 8, most_searched);
  require(request.optimizer == "auto",
          [&] { return fmt::format("--optimizer {}: a robust search has a method of its own", request.optimizer); });
  return robust;
}

std::uint64_t seed_count(const OptimizeRequest& request, const OptimizeOptions& options) {
  if (!request.seeds) return 1;
  const auto count = whole_number<std::uint64_t>("--seeds", *request.seeds, 1);
  require(count <= most_seeds, [&] { return fmt::format("--seeds {}: must be at most {}", count, most_seeds); });
  require(count - 1 <= std::numeric_limits<std::uint64_t>::max() - options.seed,
          [&] { return fmt::format("--seeds {}: from --seed {} on there are not so many", count, options.seed); });
  require(count == 1 || request.robust != by_race,
          "--seeds: is for searches on the nominal device, or over devices by one measure such as --robust cvar:0.9");
  require(count == 1 || !std::isfinite(options.max_seconds), [&] {
    return fmt::format(
        "--budget {}: searches from several seeds are compared at equal effort, so their budget is a number of evaluations",
        request.budget.value_or(""));
  });
  return count;
}

// The scenes that --start names, or those of the plan that is gone on with.
std::vector<StartingScene> starting_scenes(const OptimizeRequest& request, const json& known) {
  std::vector<StartingScene> all;
  for (const std::string& name : request.starts) {
    require(!name.empty(), "--start: must not be empty");
    all.push_back({.name = name, .scene = canonical(scene_of_result(name), name)});
  }
  if (!all.empty() || !known.is_object() || !known.contains("start")) return all;
  for (const json& one : known.at("start")) {
    const std::string name = one.at("name").get<std::string>();
    all.push_back({.name = name, .scene = SceneFile::parse(one.at("scene_toml").get<std::string>(), name)});
  }
  return all;
}

// The scene as it was given, with what its name and its lines are in messages, or as the plan has it that is gone on with.
json given_scene(const Common& c, const json& known) {
  json given;
  if (c.scene.empty()) {
    given = known.at("given");
  } else {
    // Read before the braces: what throws within them leaves GCC 12 destroying elements that were never made.
    const std::string text = read_file(c.scene);
    given = {{"file", c.scene},
             {"folder", std::filesystem::absolute(c.scene).parent_path().string()},
             {"text", text},
             {"set", json::array()}};
  }
  for (const std::string& assignment : c.set) given.at("set").push_back(assignment);
  return given;
}

SceneFile scene_of(const json& given) {
  SceneFile scene = SceneFile::parse(given.at("text").get<std::string>(), given.at("file").get<std::string>(),
                                     given.at("folder").get<std::string>());
  for (const json& assignment : given.at("set")) scene.set(assignment.get<std::string>());
  return scene;
}

json plan_of(const PlannedSearch& search, const OptimizeRequest& request, const json& given) {
  json starts = json::array();
  for (const StartingScene& start : search.starts) starts.push_back({{"name", start.name}, {"scene_toml", start.scene.text()}});
  json plan{{"kind", kind},
            {"given", given},
            {"scene_toml", canonical(search.scene, "scene").text()},
            {"target", request.target},
            {"actuator", request.actuator},
            {"waveform", request.waveform},
            {"optimizer", request.optimizer},
            {"start", starts},
            {"budget", request.budget.value_or("")},
            {"seed", std::to_string(search.options.seed)},
            {"seeds", std::to_string(search.seeds)}};
  if (!request.conditions.empty()) plan["constrain"] = request.conditions;
  if (request.robust == nominal_alone) return plan;
  plan["robust"] = request.robust;
  plan["calibrate"] = request.calibration;
  if (search.for_devices) plan[raced_families_key] = search.for_devices->families;
  plan["samples"] = std::to_string(search.robust ? search.robust->samples : search.for_devices->verdict);
  return plan;
}

// The first key that two scenes do not share, with what each says.
std::string scene_difference(const std::string& there, const std::string& asked) {
  const auto keys = [](const std::string& text) { return SceneFile::parse(text, "scene").json().flatten(); };
  const json before = keys(there), now = keys(asked);
  const auto value = [](const json& scene, const std::string& key) {
    return scene.contains(key) ? scene.at(key).dump() : std::string("none");
  };
  for (const json& scene : {before, now}) {
    for (const auto& [key, ignored] : scene.items()) {
      if (value(before, key) == value(now, key)) continue;
      std::string path = key.substr(1);
      std::replace(path.begin(), path.end(), '/', '.');
      return fmt::format("its scene has {} = {}, not {}", path, shortened(value(before, key)), shortened(value(now, key)));
    }
  }
  return "its scene is another";
}

std::string start_names(const json& plan) {
  std::string names;
  for (const json& one : plan.at("start")) names += (names.empty() ? "" : ", ") + one.at("name").get<std::string>();
  return names.empty() ? "none" : names;
}

}  // namespace

PlannedSearch planned(const Common& c, const OptimizeRequest& given, const json& known) {
  const json as_given = given_scene(c, known);
  SceneFile scene = c.scene.empty() ? scene_of(as_given) : load_scene(c);
  const OptimizeRequest request = with_known(given, known, scene);
  const bool is_robust = request.robust != nominal_alone;
  for (const bool of_devices : {!request.calibration.empty(), request.samples.has_value()})
    require(is_robust || !of_devices,
            "--calibrate and --samples are for a search over devices: they say nothing with --robust none");
  OptimizeOptions options = read_options(c, request, scene);
  std::optional<RobustOptions> robust;
  if (is_by_measure(request)) robust = read_robust_options(request);
  std::optional<ForDevicesOptions> for_devices;
  if (request.robust == by_race) {
    for_devices = read_race_options(request, options);
    for_devices->families = given.waveform.empty() ? word_of(known, raced_families_key, "") : given.waveform;
  }
  const std::uint64_t seeds = seed_count(request, options);
  if (is_robust) set_calibration(scene, request.calibration);
  PlannedSearch search{.scene = std::move(scene),
                       .options = std::move(options),
                       .robust = std::move(robust),
                       .for_devices = std::move(for_devices),
                       .conditions = request.conditions,
                       .starts = starting_scenes(request, known),
                       .seeds = seeds,
                       .plan = {}};
  search.plan = plan_of(search, request, as_given);
  for (const StartingScene& start : search.starts) {
    Drives drives = prepare(start.scene, false, {.stop = c.stop}).drives;
    search.options.starts.push_back(
        {.name = "--start " + start.name, .waveforms = std::move(drives.waveforms), .before = std::move(drives.before)});
  }
  return search;
}

std::string difference(const json& there, const json& asked) {
  if (there.value("kind", "") != kind) return "it holds no search";
  if (there.at("scene_toml") != asked.at("scene_toml"))
    return scene_difference(there.at("scene_toml").get<std::string>(), asked.at("scene_toml").get<std::string>());
  for (const char* key : {"target", "actuator", "waveform", "optimizer", "robust", "constrain", "samples", "seed"}) {
    const json before = there.value(key, json()), now = asked.value(key, json());
    const auto words = [](const json& value) {
      return value.is_null() ? std::string("none") : value.is_string() ? value.get<std::string>() : value.dump();
    };
    if (before != now) return fmt::format("it is for --{} {}, not {}", key, words(before), words(now));
  }
  if (there.at("start") != asked.at("start"))
    return fmt::format("it began with --start {}, not {}", start_names(there), start_names(asked));
  const auto seeds = [](const json& plan) { return std::stoull(plan.at("seeds").get<std::string>()); };
  return seeds(asked) < seeds(there) ? fmt::format("it has {} seeds, not {}", seeds(there), seeds(asked)) : std::string();
}

json plan_of_seed(const json& plan, std::uint64_t seed) {
  json one = plan;
  one["seed"] = std::to_string(seed);
  for (const char* key : {"seeds", "given"}) one.erase(key);  // neither decides what is found
  return one;
}

}  // namespace softland::apps
