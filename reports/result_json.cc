#include "reports/result_json.h"

#include "reports/result_words.h"
#include "reports/study_members.h"

namespace softland {

using nlohmann::json;

json internal::rebounds_json(const std::vector<Rebound>& rebounds) {
  json rows = json::array();
  for (const Rebound& r : rebounds) rows.push_back({r.begin, json_number(r.end), r.height, r.time_of_height});
  return rows;
}

// [x, y] with x a whole number.
json internal::counted_json(const Points& points) {
  json all = json::array();
  for (const auto& [index, value] : points) all.push_back({std::llround(index), json_number(value)});
  return all;
}

// One electrode is the usual case; several are told apart by name.
json internal::pull_in_json(const std::map<std::string, ResultPullIn>& pull_in) {
  if (pull_in.empty()) return nullptr;
  if (pull_in.size() == 1) return record_json(pull_in.begin()->second);
  json all = json::object();
  for (const auto& [name, voltages] : pull_in) all[name] = record_json(voltages);
  return all;
}

// Of an ill-conditioned figure the cloud it is a property of.
json internal::certified_json(const std::vector<IllConditioned>& figures) {
  json all = json::object();
  for (const IllConditioned& f : figures) all[std::string(f.figure.key)] = record_json(f.spread);
  return all;
}

json internal::by_modes_json(const ByModes& found) {
  json all{{"converged", json_number(found.converged)}};
  for (const auto& [modes, value] : found.values) all[std::to_string(modes)] = json_number(value);
  return all;
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

json internal::voltages_json(const std::map<std::string, ByModes>& of_electrodes) {
  if (of_electrodes.empty()) return nullptr;
  json all = json::object();
  for (const auto& [electrode, found] : of_electrodes) all[electrode] = by_modes_json(found);
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

// What the checks come to.
void add_verdict(json& j, const Result& r) {
  if (!r.best.figures || r.checks.empty()) return;
  j["confirmed"] = internal::all_checks_land(r);
  const ResultCheck* worst = internal::worst_check(r.checks);
  if (!worst) return;
  const std::string figure(internal::worst_figure(*worst));
  j["worst"] = {{"name", worst->name}, {"figure", figure}, {"value", internal::record_json(*worst)["metrics"][figure]}};
}

}  // namespace

std::string json_text(const json& data, int indent) {
  return data.dump(indent, ' ', false, json::error_handler_t::replace) + "\n";
}

json result_json(const Result& r) {
  json j = internal::record_json(r);
  if (r.is_search()) {
    add_verdict(j, r);
    return j;
  }
  j["collapse_time_s"] = internal::json_number(r.best.collapse_time);
  for (const char* key : {"static_deflection_m", "capacitance_F"})
    if (j.contains("metrics")) j[key] = j["metrics"][key];
  return j;
}

json without_curves(json record) {
  record.erase("curves");
  return record;
}

json summary_json(json result) {
  for (const char* key : {"curves", "scene_toml", "search"}) result.erase(key);
  if (!result.contains("baseline")) result.erase("best");  // a single run: its figures stand above
  return result;
}

}  // namespace softland
