#include "reports/result_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include "base/printable.h"
#include "base/require.h"
#include "base/shortened.h"
#include "config/units.h"
#include "reports/result_members.h"
#include "version.h"

namespace softland {
namespace {

using nlohmann::json;

// The value at this path of keys; a null value when any of them is missing.
const json& at(const json& value, std::initializer_list<std::string_view> path) {
  static const json nothing;
  const json* here = &value;
  for (const std::string_view key : path) {
    if (!here->is_object()) return nothing;
    const auto found = here->find(key);
    if (found == here->end()) return nothing;
    here = &*found;
  }
  return *here;
}

double number(const json& value) { return value.is_number() ? value.get<double>() : Metrics::unset; }

std::string text(const json& value) { return value.is_string() ? value.get<std::string>() : std::string(); }
std::string text(const json& value, std::initializer_list<std::string_view> path) { return text(at(value, path)); }

// A quantity as a resolved scene writes it, "2 um", in SI units; a plain number as it is.
double quantity(const json& value) {
  if (!value.is_string()) return number(value);
  try {
    return parse_quantity(value.get<std::string>()).value;
  } catch (const InvalidInput&) {
    return Metrics::unset;
  }
}

std::vector<double> quantities(const json& list) {
  std::vector<double> all;
  for (const json& one : list.is_array() ? list : json::array()) all.push_back(quantity(one));
  return all;
}

// The members of an object, by name.
template <class Read>
auto members_of(const json& object, const Read& read) {
  std::map<std::string, decltype(read(object))> all;
  if (!object.is_object()) return all;
  for (const auto& [name, value] : object.items()) all.emplace(name, read(value));
  return all;
}

bool is_search(const json& result) {
  const std::string kind = text(result, {"kind"});
  return kind == "optimize" || (kind.empty() && !at(result, {"baseline"}).is_null());
}

}  // namespace

json parse_record(std::string_view content, const std::string& name) {
  // A result of ours is 6 deep; reports walk through what they show by recursion.
  constexpr int deepest = 64;
  const auto watch_depth = [&](int around, json::parse_event_t event, const json&) {
    const bool opens = event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (opens && around >= deepest) throw InvalidInput(fmt::format("{}: is nested more than {} deep", name, deepest));
    return true;
  };
  json record = json::parse(content, watch_depth, false);
  require(!text(record, {"kind"}).empty(), [&] { return fmt::format("{}: is not a result of softland", name); });
  return record;
}

json parse_result(std::string_view content, const std::string& name) {
  json result = parse_record(content, name);
  require(result["kind"] == "simulate" || result["kind"] == "optimize",
          fmt::format("{}: is not a result of simulate or optimize", name));
  return result;
}

void require_version(const json& record, const std::string& name) {
  const std::string made_by = text(record, {"version"});
  require(!made_by.empty(), fmt::format("{}: does not say of which version of softland it is: \"version\" is missing", name));
  require(made_by == version,
          fmt::format("{}: is a result of softland {}, of which softland {} makes no report", name, shortened(made_by), version));
}

void require_reportable(const json& result) {
  for (const char* part : {is_search(result) ? "baseline" : "metrics", "scene"}) {
    require(at(result, {part}).is_object(), fmt::format("\"{}\" is missing", part));
  }
}

std::vector<Rebound> internal::read_rebounds(const json& rows) {
  std::vector<Rebound> all;
  for (const json& row : rows.is_array() ? rows : json::array()) {
    if (row.is_array() && row.size() >= 4)
      all.push_back({.begin = number(row[0]), .end = number(row[1]), .height = number(row[2]), .time_of_height = number(row[3])});
  }
  return all;
}

Points internal::read_points(const json& points) { return JsonReader::read<Points>(points); }

// Of one electrode without its name.
std::map<std::string, ResultPullIn> internal::read_pull_in(const json& volts) {
  if (!volts.is_object()) return {};
  if (volts.contains("static_V") || volts.contains("dynamic_V")) return {{"", JsonReader::read<ResultPullIn>(volts)}};
  return JsonReader::read<std::map<std::string, ResultPullIn>>(volts);
}

std::vector<IllConditioned> internal::read_certified(const json& certified) {
  std::vector<IllConditioned> all;
  for (const Figure& figure : all_figures) {
    const json& cloud = at(certified, {figure.key});
    if (cloud.is_object()) all.push_back({figure, JsonReader::read<Spread>(cloud)});
  }
  return all;
}

Integrator internal::read_integrator(const json& name) {
  const auto found = std::ranges::find(all_integrators, text(name), [](Integrator one) { return to_string(one); });
  return found == all_integrators.end() ? Integrator::automatic : *found;
}

std::optional<ByModes> internal::read_by_modes(const json& found) {
  if (!found.is_object()) return std::nullopt;
  ByModes all;
  for (const auto& [modes, value] : found.items()) {
    if (modes == "converged") {
      all.converged = number(value);
    } else {
      int count = 0;
      const auto [end, error] = std::from_chars(modes.data(), modes.data() + modes.size(), count);
      if (error == std::errc() && end == modes.data() + modes.size()) all.values[count] = number(value);
    }
  }
  return all.values.empty() ? std::nullopt : std::optional(std::move(all));
}

std::optional<ByModes> internal::read_static_by_modes(const json& found) { return read_by_modes(at(found, {"static_V"})); }

std::map<std::string, ByModes> internal::read_voltages(const json& of_electrodes) {
  std::map<std::string, ByModes> all;
  if (!of_electrodes.is_object()) return all;
  for (const auto& [electrode, found] : of_electrodes.items()) {
    if (std::optional<ByModes> one = read_by_modes(found)) all[electrode] = std::move(*one);
  }
  return all;
}

HoldWindows internal::read_windows(const json& ends) {
  HoldWindows all;
  if (!ends.is_object()) return all;
  for (const auto& [electrode, window] : ends.items()) {
    HoldWindow& one = all.of_electrodes[electrode];
    if (window.is_array() && window.size() == 2)
      one = {.lower = number(window[0]),
             .upper = window[1].is_null() ? std::numeric_limits<double>::infinity() : number(window[1])};
  }
  return all;
}

Result read_result(const json& result) {
  require(result.is_object(), "the result is not a JSON object");
  Result r = internal::JsonReader::read<Result>(result);
  r.origin.kind = is_search(result) ? "optimize" : "simulate";
  if (r.origin.scene_toml.empty() && r.origin.scene.is_object())
    r.origin.scene_toml = r.origin.scene.dump(2, ' ', false, json::error_handler_t::replace);
  if (r.best.status.empty()) r.best.status = r.status;
  r.scene = read_result_scene(r.origin.scene);
  return r;
}

// A length, a percentage of a beam's length, or its tip.
double place_on(double length, const json& place) {
  const std::string written = text(place);
  if (written == "tip") return length;
  return written.ends_with('%') ? quantity(place) * length : quantity(place);
}

std::optional<std::array<double, 2>> span_on(double length, const json& span) {
  if (!span.is_array() || span.size() != 2) return std::nullopt;
  const std::array<double, 2> ends{place_on(length, span[0]), place_on(length, span[1])};
  return std::isfinite(ends[0]) && std::isfinite(ends[1]) ? std::optional(ends) : std::nullopt;
}

ResultScene read_result_scene(const json& scene) {
  ResultScene s{.structure = text(scene, {"structure", "kind"}),
                .length = quantity(at(scene, {"structure", "length"})),
                .electrode_gap = quantity(at(scene, {"gap", "electrode"})),
                .contact_gap = quantity(at(scene, {"gap", "contact"})),
                .pad_length = quantity(at(scene, {"contact", "pad_length"}))};
  if (at(scene, {"piezo"}).is_object()) s.piezo = ResultScene::Piezo{span_on(s.length, at(scene, {"piezo", "span"}))};
  for (const auto& [name, electrode] : members_of(at(scene, {"electrode"}), [](const json& one) { return &one; })) {
    const json& spans = at(*electrode, {"span"});
    const bool is_nested = spans.is_array() && !spans.empty() && spans[0].is_array();
    for (const json& span : is_nested ? spans : json::array({spans}))
      s.electrodes.push_back({.name = name,
                              .span = span_on(s.length, span),
                              .far_side = text(*electrode, {"side"}) == "far",
                              .gap = quantity(at(*electrode, {"gap"}))});
  }
  for (const auto& [name, contact] : members_of(at(scene, {"contact"}), [](const json& one) { return &one; })) {
    if (!contact->is_object()) continue;
    s.contacts.push_back({.name = name,
                          .at = place_on(s.length, at(*contact, {"at"})),
                          .gap = quantity(at(*contact, {"gap"})),
                          .far_side = text(*contact, {"side"}) == "far"});
  }
  s.waveforms = members_of(at(scene, {"waveform"}), [](const json& one) {
    return ResultScene::Waveform{.family = text(one, {"family"}),
                                 .times = quantities(at(one, {"times"})),
                                 .edge = quantity(at(one, {"edge"})),
                                 .start = quantity(at(one, {"start"})),
                                 .end = quantity(at(one, {"end"}))};
  });
  s.drivers = members_of(at(scene, {"driver"}), [](const json& one) {
    return DriveLimits{.lowest = quantity(at(one, {"min_voltage"})),
                       .highest = quantity(at(one, {"max_voltage"})),
                       .slew = quantity(at(one, {"max_slew"}))};
  });
  if (const double height = quantity(at(scene, {"metrics", "significant_rebound"})); height > 0) s.significant_rebound = height;
  return s;
}

}  // namespace softland
