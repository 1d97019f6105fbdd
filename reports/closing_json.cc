#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "base/require.h"
#include "reports/closing_captions.h"
#include "reports/closing_members.h"
#include "reports/record_file.h"
#include "reports/study_members.h"

namespace softland {

using nlohmann::json;

bool internal::is_of_search(const json& result) {
  const std::string kind = read_json<std::string>(value_at(result, "kind"));
  return kind == "optimize" || (kind.empty() && !value_at(result, "baseline").is_null());
}

json internal::rebounds_json(const std::vector<Rebound>& rebounds) {
  json rows = json::array();
  for (const Rebound& r : rebounds) rows.push_back({r.begin, json_number(r.end), r.height, r.time_of_height});
  return rows;
}

std::vector<Rebound> internal::read_rebounds(const json& rows) {
  std::vector<Rebound> all;
  for (const json& row : rows.is_array() ? rows : json::array()) {
    if (row.is_array() && row.size() >= 4)
      all.push_back({.begin = read_json<double>(row[0]),
                     .end = read_json<double>(row[1]),
                     .height = read_json<double>(row[2]),
                     .time_of_height = read_json<double>(row[3])});
  }
  return all;
}

// Each row of JSON is [begin, end, touches]: an interval in which the contact is closed [s], and its number of touches.
json internal::closed_json(const std::optional<std::vector<ClosedStretch>>& closed) {
  json rows = json::array();
  for (const ClosedStretch& one : *closed) rows.push_back({one.begin, json_number(one.end), one.touches});
  return rows;
}

std::optional<std::vector<ClosedStretch>> internal::read_closed(const json& rows) {
  if (!rows.is_array()) return std::nullopt;
  std::vector<ClosedStretch> all;
  for (const json& row : rows) {
    if (row.is_array() && row.size() == 3)
      all.push_back(
          {.begin = read_json<double>(row[0]), .end = read_json<double>(row[1]), .touches = read_json<std::uint64_t>(row[2])});
  }
  return all;
}

json internal::closed_contacts_json(const std::map<std::string, std::vector<ClosedStretch>>& closed) {
  json all = json::object();
  for (const auto& [name, stretches] : closed) all[name] = closed_json(stretches);
  return all;
}

std::map<std::string, std::vector<ClosedStretch>> internal::read_closed_contacts(const json& closed) {
  std::map<std::string, std::vector<ClosedStretch>> all;
  for (const auto& [name, rows] : read_json<std::map<std::string, json>>(closed)) {
    if (auto stretches = read_closed(rows)) all[name] = std::move(*stretches);
  }
  return all;
}

// Writes points of a search as rows [index of an evaluation, minimised value] of JSON, with a whole number as the index.
json internal::counted_json(const Points& points) {
  json all = json::array();
  for (const auto& [index, value] : points) all.push_back({std::llround(index), json_number(value)});
  return all;
}

Points internal::read_points(const json& points) { return read_json<Points>(points); }

// Writes pull-in voltages. A single electrode has no name in JSON; several electrodes are distinguished by name.
json internal::pull_in_json(const std::map<std::string, PullInOfElectrode>& pull_in) {
  if (pull_in.empty()) return nullptr;
  if (pull_in.size() == 1) return record_json(pull_in.begin()->second);
  json all = json::object();
  for (const auto& [name, voltages] : pull_in) all[name] = record_json(voltages);
  return all;
}

// Reads pull-in voltages. A single electrode has no name in JSON.
std::map<std::string, PullInOfElectrode> internal::read_pull_in(const json& volts) {
  if (!volts.is_object()) return {};
  if (volts.contains("static_V") || volts.contains("dynamic_V")) return {{"", read_json<PullInOfElectrode>(volts)}};
  return read_json<std::map<std::string, PullInOfElectrode>>(volts);
}

// Writes the spread of each ill-conditioned figure of merit over repeated runs with slightly changed settings.
json internal::certified_json(const std::vector<IllConditioned>& figures) {
  json all = json::object();
  for (const IllConditioned& f : figures) all[std::string(f.figure.key)] = record_json(f.spread);
  return all;
}

std::vector<IllConditioned> internal::read_certified(const json& certified) {
  std::vector<IllConditioned> all;
  for (const Figure& figure : all_figures) {
    const json& cloud = value_at(certified, figure.key);
    if (cloud.is_object()) all.push_back({figure, read_json<Spread>(cloud)});
  }
  return all;
}

Integrator internal::read_integrator(const json& name) {
  const auto found =
      std::ranges::find(all_integrators, read_json<std::string>(name), [](Integrator one) { return to_string(one); });
  return found == all_integrators.end() ? Integrator::automatic : *found;
}

json internal::by_modes_json(const ByModes& found) {
  json all{{"converged", json_number(found.converged)}};
  for (const auto& [modes, value] : found.values) all[std::to_string(modes)] = json_number(value);
  return all;
}

std::optional<ByModes> internal::read_by_modes(const json& found) {
  if (!found.is_object()) return std::nullopt;
  ByModes all;
  for (const auto& [modes, value] : found.items()) {
    if (modes == "converged") {
      all.converged = read_json<double>(value);
    } else {
      int count = 0;
      const auto [end, error] = std::from_chars(modes.data(), modes.data() + modes.size(), count);
      if (error == std::errc() && end == modes.data() + modes.size()) all.values[count] = read_json<double>(value);
    }
  }
  return all.values.empty() ? std::nullopt : std::optional(std::move(all));
}

json internal::eigenvalues_json(const std::optional<ByModes>& found) {
  if (!found) return nullptr;
  json all = by_modes_json(*found);
  all.erase("converged");
  return all;
}

json internal::static_by_modes_json(const std::optional<ByModes>& found) {
  return found ? json{{"static_V", by_modes_json(*found)}} : json();
}

std::optional<ByModes> internal::read_static_by_modes(const json& found) { return read_by_modes(value_at(found, "static_V")); }

json internal::voltages_json(const std::map<std::string, ByModes>& of_electrodes) {
  if (of_electrodes.empty()) return nullptr;
  json all = json::object();
  for (const auto& [electrode, found] : of_electrodes) all[electrode] = by_modes_json(found);
  return all;
}

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
      one = {.lower = read_json<double>(window[0]),
             .upper = window[1].is_null() ? std::numeric_limits<double>::infinity() : read_json<double>(window[1])};
  }
  return all;
}

json internal::choices_json(const DevicesFindings& devices) {
  json all = json::array();
  for (const DevicesFindings::Choice& one : devices.choices) {
    json& choice = all.emplace_back(record_json(one));
    const DevicesFindings::Row* const row = devices.row(one.row());
    const json figures = row == nullptr ? json::object() : record_json(*row);
    for (const char* key : {"quantile_95", "quantile_99"}) choice[key] = figures.value(key, json::object());
  }
  return all;
}

json metrics_json(const Metrics& m) { return internal::record_json(m); }

namespace {

// Adds whether the confirmations agree with the best waveform of the search.
void add_verdict(json& j, const ClosingRecord& r) {
  if (!r.best.figures || r.search->checks.empty()) return;
  j["confirmed"] = internal::all_checks_land(*r.search);
  const ConfirmationRecord* worst = internal::worst_check(r.search->checks);
  if (!worst) return;
  const std::string figure(internal::worst_figure(*worst));
  j["worst"] = {{"name", worst->name}, {"figure", figure}, {"value", internal::record_json(*worst)["metrics"][figure]}};
}

}  // namespace

json json_of(const ClosingRecord& r) {
  json j = internal::record_json(r);
  if (r.search) {
    add_verdict(j, r);
    return j;
  }
  j["collapse_time_s"] = internal::json_number(r.best.collapse_time);
  for (const char* key : {"static_deflection_m", "capacitance_F"})
    if (j.contains("metrics")) j[key] = j["metrics"][key];
  return j;
}

json summary_json(json result) {
  for (const char* key : {"curves", "scene_toml", "search"}) result.erase(key);
  // The figures of a single run are at the top level of the JSON: leave out the object `best`, which repeats them.
  if (!result.contains("baseline")) result.erase("best");
  return result;
}

json parse_closing(std::string_view content, const std::string& name) {
  json result = parse_record(content, name);
  require(result["kind"] == "simulate" || result["kind"] == "optimize",
          fmt::format("{}: is not a result of simulate or optimize", name));
  return result;
}

void require_reportable(const json& result) {
  for (const char* part : {internal::is_of_search(result) ? "baseline" : "metrics", "scene"}) {
    require(internal::value_at(result, part).is_object(), fmt::format("\"{}\" is missing", part));
  }
}

ClosingRecord read_closing(const json& result) {
  require(result.is_object(), "the result is not a JSON object");
  ClosingRecord r = internal::read_json<ClosingRecord>(result);
  r.origin.kind = r.search ? "optimize" : "simulate";
  if (r.origin.scene_toml.empty() && r.origin.scene.is_object())
    r.origin.scene_toml = r.origin.scene.dump(2, ' ', false, json::error_handler_t::replace);
  if (r.best.status.empty()) r.best.status = r.status;
  r.scene = read_drawn_scene(r.origin.scene);
  return r;
}

}  // namespace softland
