#include "studies/search/stored_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/require.h"
#include "base/shortened.h"
#include "store/study_store.h"
#include "studies/closing/prepared.h"

namespace softland {
namespace {

using nlohmann::json;

constexpr const char* kind = "search";
// Key of the stored request (plan) with the waveform families that the user gave for a tournament.
constexpr const char* tournament_families_key = "raced_waveform";

// Reads the request of a search from its stored plan. A plan without the member `robust` is of a search on the nominal device.
SearchRequest request_in(const json& plan) {
  SearchRequest request{.robust = std::string(nominal_alone)};
  const auto take = [&](std::string_view name, auto& word) {
    const auto found = plan.find(std::string(name));
    if (found != plan.end() && found->is_string() && *found != "") word = found->template get<std::string>();
  };
  visit_prose(take, request);
  if (plan.contains("constrain")) plan.at("constrain").get_to(request.constrain);
  return request;
}

// Returns the scenes whose waveforms the search starts with: those of the request, otherwise those in `known`, the stored
// request of the earlier search that is continued.
std::vector<StartingScene> starting_scenes(const AskedSearch& asked, const json& known) {
  std::vector<StartingScene> all;
  for (const StartingScene& one : asked.starts) {
    require_request(!one.name.empty(), [] { return requested("start") + ": must not be empty"; });
    all.push_back({.name = one.name, .scene = canonical(one.scene, one.name)});
  }
  if (!all.empty() || !known.is_object() || !known.contains("start")) return all;
  for (const json& one : known.at("start")) {
    const std::string name = one.at("name").get<std::string>();
    all.push_back({.name = name, .scene = SceneFile::parse(one.at("scene_toml").get<std::string>(), name)});
  }
  return all;
}

// Returns the scene of the request, otherwise that in `known`, the stored request of the earlier search that is continued, as
// text with the requested assignments added.
json given_scene(const AskedSearch& asked, const json& known) {
  json given;
  if (asked.given) {
    given = {{"file", asked.given->file}, {"folder", asked.given->folder}, {"text", asked.given->text}, {"set", json::array()}};
  } else {
    given = known.at("given");
  }
  for (const std::string& assignment : asked.set) given.at("set").push_back(assignment);
  return given;
}

SceneFile scene_of(const json& given) {
  SceneFile scene = SceneFile::parse(given.at("text").get<std::string>(), given.at("file").get<std::string>(),
                                     given.at("folder").get<std::string>());
  for (const json& assignment : given.at("set")) scene.set(assignment.get<std::string>());
  return scene;
}

// Returns the stored request (plan) of a search: the texts of the request, completed by the seeds and the number of devices.
json plan_of(SearchRequest request, const PlannedSearch& search, const std::vector<StartingScene>& starts, const json& given) {
  request.seed = std::to_string(search.options.seed);
  request.seeds = std::to_string(search.seeds);
  if (search.devices() > 0) request.samples = std::to_string(search.devices());
  json plan{{"kind", kind}, {"given", given}, {"scene_toml", canonical(search.scene, "scene").text()}, {"start", json::array()}};
  for (const StartingScene& start : starts) plan["start"].push_back({{"name", start.name}, {"scene_toml", start.scene.text()}});
  const auto put = [&](std::string_view name, const auto& word) {
    if constexpr (std::is_same_v<std::decay_t<decltype(word)>, std::string>) {
      plan[std::string(name)] = word;
    } else {
      plan[std::string(name)] = word.value_or("");
    }
  };
  visit_prose(put, request);
  if (request.hold_step.empty() || request.robust != by_tournament) plan.erase("hold-step");
  if (!request.constrain.empty()) plan["constrain"] = request.constrain;
  if (search.for_devices) plan[tournament_families_key] = search.for_devices->families;
  if (search.devices() > 0) return plan;
  for (const char* of_devices : {"robust", "calibrate", "samples"}) plan.erase(of_devices);
  return plan;
}

// Returns, as text, the first key at which two scenes differ, with both values.
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
  return "its scene differs";
}

std::string start_names(const json& plan) {
  std::string names;
  for (const json& one : plan.at("start")) names += (names.empty() ? "" : ", ") + one.at("name").get<std::string>();
  return names.empty() ? "none" : names;
}

}  // namespace

StoredSearch stored_search(const AskedSearch& asked, const json& known) {
  const json as_given = given_scene(asked, known);
  SceneFile scene = asked.scene ? *asked.scene : scene_of(as_given);
  SearchRequest request = asked.request;
  if (known.is_object()) request = or_else(std::move(request), request_in(known));
  request = completed(std::move(request), scene);
  if (asked.request.hold_step.empty() && known.is_object() && !known.contains("hold-step")) request.hold_step.clear();
  const std::string& waveform = asked.request.waveform;
  const std::string families = waveform.empty() && known.is_object() ? known.value(tournament_families_key, "") : waveform;
  StoredSearch search{planned(request, std::move(scene), families), {}};
  search.options.stop = asked.stop;
  search.options.jobs = asked.jobs;
  const std::vector<StartingScene> starts = starting_scenes(asked, known);
  search.plan = plan_of(request, search, starts, as_given);
  for (const StartingScene& start : starts) {
    const Drives drives = prepare(start.scene, false, {.stop = asked.stop}).drives;
    search.options.starts.push_back(
        {.name = requested("start") + " " + start.name, .waveforms = drives.waveforms(), .before = drives.before()});
  }
  return search;
}

StoredSearch stored_search(const AskedSearch& asked, const std::vector<std::filesystem::path>& stores,
                           std::optional<KnownSearch>& known) {
  const auto refuse = [](const std::string& why) { throw InvalidRequest(requested("resume") + ": " + why); };
  std::string refusal;
  for (const std::filesystem::path& store : stores) {
    const StudyReader reader(store);
    const json plan = json::parse(reader.plan().text, nullptr, false);
    require(plan.is_object() && plan.contains("kind"), fmt::format("{}: must hold a search", store.string()));
    try {
      StoredSearch search = stored_search(asked, plan);
      const std::string other = difference(plan, search.plan);
      if (other.empty()) {
        known = KnownSearch{.place = store.parent_path(), .plan = plan, .command = reader.sessions().front().command};
        return search;
      }
      if (refusal.empty()) refusal = fmt::format("{} holds another search: {}", store.string(), other);
    } catch (const json::exception&) {
      throw InvalidInput(fmt::format("{}: holds a search of another version of softland", store.string()));
    }
  }
  if (!refusal.empty()) refuse(refusal);
  return stored_search(asked);
}

std::string difference(const json& there, const json& asked) {
  if (there.value("kind", "") != kind) return "it does not hold a search";
  if (there.at("scene_toml") != asked.at("scene_toml"))
    return scene_difference(there.at("scene_toml").get<std::string>(), asked.at("scene_toml").get<std::string>());
  for (const char* key : {"target", "actuator", "waveform", "optimizer", "robust", "hold-step", "constrain", "samples", "seed"}) {
    const json before = there.value(key, json()), now = asked.value(key, json());
    const auto words = [](const json& value) {
      return value.is_null() ? std::string("none") : value.is_string() ? value.get<std::string>() : value.dump();
    };
    if (before != now) return fmt::format("it is for {} {}, not {}", requested(key), words(before), words(now));
  }
  if (there.at("start") != asked.at("start"))
    return fmt::format("it began with {} {}, not {}", requested("start"), start_names(there), start_names(asked));
  const auto seeds = [](const json& plan) { return std::stoull(plan.at("seeds").get<std::string>()); };
  return seeds(asked) < seeds(there) ? fmt::format("it has {} seeds, not {}", seeds(there), seeds(asked)) : std::string();
}

json plan_of_seed(const json& plan, std::uint64_t seed) {
  json one = plan;
  one["seed"] = std::to_string(seed);
  // The members "seeds" and "given" do not change the result of the search.
  for (const char* key : {"seeds", "given"}) one.erase(key);
  return one;
}

std::int64_t evaluations_at_most(const PlannedSearch& search) {
  constexpr std::int64_t most = std::int64_t{1} << 24, scouting = 4096;
  const std::int64_t budget = std::min<std::int64_t>(search.options.max_evaluations + search.options.more_evaluations, most);
  const std::int64_t of_tournament = search.for_devices ? std::min<std::int64_t>(2 * search.for_devices->closings / 8, most) : 0;
  const std::int64_t each = search.robust ? budget / 8 + scouting : budget + of_tournament;
  const auto seeds = static_cast<std::int64_t>(search.seeds);
  return each > most / seeds ? most : each * seeds;
}

}  // namespace softland
