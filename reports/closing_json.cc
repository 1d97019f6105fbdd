// The JSON of the results of a closing; search_json.cc has the members of its search.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "base/require.h"
#include "reports/closing_captions.h"
#include "reports/closing_record.h"
#include "reports/record.h"
#include "reports/record_file.h"
#include "reports/study_members.h"

namespace softland {

using nlohmann::json;

void members(internal::Archive& a, PullInOfElectrode& volts);

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

namespace internal {
namespace {

bool is_of_search(const json& result) {
  const std::string kind = read_json<std::string>(value_at(result, "kind"));
  return kind == "optimize" || (kind.empty() && !value_at(result, "baseline").is_null());
}

json rebounds_json(const std::vector<Rebound>& rebounds) {
  json rows = json::array();
  for (const Rebound& r : rebounds) rows.push_back({r.begin, json_number(r.end), r.height, r.time_of_height});
  return rows;
}

std::vector<Rebound> read_rebounds(const json& rows) {
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

json closed_contacts_json(const std::map<std::string, std::vector<ClosedStretch>>& closed) {
  json all = json::object();
  for (const auto& [name, stretches] : closed) all[name] = closed_json(stretches);
  return all;
}

std::map<std::string, std::vector<ClosedStretch>> read_closed_contacts(const json& closed) {
  std::map<std::string, std::vector<ClosedStretch>> all;
  for (const auto& [name, rows] : read_json<std::map<std::string, json>>(closed)) {
    if (auto stretches = read_closed(rows)) all[name] = std::move(*stretches);
  }
  return all;
}

// Writes pull-in voltages. A single electrode has no name in JSON; several electrodes are distinguished by name.
json pull_in_json(const std::map<std::string, PullInOfElectrode>& pull_in) {
  if (pull_in.empty()) return nullptr;
  if (pull_in.size() == 1) return record_json(pull_in.begin()->second);
  json all = json::object();
  for (const auto& [name, voltages] : pull_in) all[name] = record_json(voltages);
  return all;
}

// Reads pull-in voltages. A single electrode has no name in JSON.
std::map<std::string, PullInOfElectrode> read_pull_in(const json& volts) {
  if (!volts.is_object()) return {};
  if (volts.contains("static_V") || volts.contains("dynamic_V")) return {{"", read_json<PullInOfElectrode>(volts)}};
  return read_json<std::map<std::string, PullInOfElectrode>>(volts);
}

// Writes the spread of each ill-conditioned figure of merit over repeated runs with slightly changed settings.
json certified_json(const std::vector<IllConditioned>& figures) {
  json all = json::object();
  for (const IllConditioned& f : figures) all[std::string(f.figure.key)] = record_json(f.spread);
  return all;
}

std::vector<IllConditioned> read_certified(const json& certified) {
  std::vector<IllConditioned> all;
  for (const Figure& figure : all_figures) {
    const json& cloud = value_at(certified, figure.key);
    if (cloud.is_object()) all.push_back({figure, read_json<Spread>(cloud)});
  }
  return all;
}

json eigenvalues_json(const std::optional<ByModes>& found) {
  if (!found) return nullptr;
  json all = by_modes_json(*found);
  all.erase("converged");
  return all;
}

json static_by_modes_json(const std::optional<ByModes>& found) {
  return found ? json{{"static_V", by_modes_json(*found)}} : json();
}

std::optional<ByModes> read_static_by_modes(const json& found) { return read_by_modes(value_at(found, "static_V")); }

json voltages_json(const std::map<std::string, ByModes>& of_electrodes) {
  if (of_electrodes.empty()) return nullptr;
  json all = json::object();
  for (const auto& [electrode, found] : of_electrodes) all[electrode] = by_modes_json(found);
  return all;
}

std::map<std::string, ByModes> read_voltages(const json& of_electrodes) {
  std::map<std::string, ByModes> all;
  if (!of_electrodes.is_object()) return all;
  for (const auto& [electrode, found] : of_electrodes.items()) {
    if (std::optional<ByModes> one = read_by_modes(found)) all[electrode] = std::move(*one);
  }
  return all;
}

}  // namespace
}  // namespace internal

void members(internal::Archive& a, ShownMotion::Contact& contact) {
  a("name", contact.name, "name of the contact; may be empty if there is one");
  a("at_m", contact.at, "position along the structure");
  a("gap_m", contact.gap, "rest distance to its contact plane");
  a("far_side", contact.far_side, "whether the contact is on the far side");
}
void members(internal::Archive& a, ShownMotion::Pad& pad) {
  a("electrode", pad.electrode, "name of the electrode");
  a("begin_m", pad.begin, "begin along the structure");
  a("end_m", pad.end, "end along the structure");
  a("gap_m", pad.gap, "rest distance of its face to a straight structure");
  a("far_side", pad.far_side, "whether the electrode is on the far side");
}
void members(internal::Archive& a, ShownMotion& motion) {
  a("time_s", motion.time, "instants");
  a("amplitudes_m", motion.amplitudes, "largest deflection of each mode at each instant");
  a("x_m", motion.places, "positions along the structure");
  a("rest_m", motion.rest, "height of the lower face at rest at each position");
  a("shapes", motion.shapes, "shape of each mode at the positions, scaled to a largest size of 1");
  a("contacts", motion.contacts, "contacts of the structure");
  a("electrodes", motion.electrodes, "electrodes of the structure");
}

void members(internal::Archive& a, CurveRecord& curve) {
  a("time_s", curve.time, "time since the start of the run");
  a("tip_gap_m", curve.gap, "distance of the contact point to the contact plane");
  a("tip_velocity_m_s", curve.velocity, "velocity of the contact point towards the contact");
  a("contact_force_N", curve.force, "contact force");
  if (a.has(!curve.resistance.empty()))
    a("contact_resistance_ohm", curve.resistance,
      "resistance of the connection, null while it is open; for contacts with a resistivity");
  a.custom(
      "rebounds", curve.rebounds, internal::rebounds_json, internal::read_rebounds,
      internal::Like<std::vector<std::array<double, 4>>>{"rebounds: begin [s], end [s], height [m], time of that height [s]"});
  if (a.has(curve.closed.has_value()))
    a.custom("closed", curve.closed, internal::closed_json, internal::read_closed,
             internal::Like<std::vector<std::array<double, 3>>>{
                 "times in which the contact is closed: begin [s], end [s] (null: to the end of the run), touches"});
  if (a.has(!curve.closed_contacts.empty()))
    a.custom("closed_contacts", curve.closed_contacts, internal::closed_contacts_json, internal::read_closed_contacts,
             internal::Like<std::map<std::string, std::vector<std::array<double, 3>>>>{"the same for each of several contacts"});
  a("motion", curve.motion, "motion of the whole structure; none if the run stopped early");
}

void members(internal::Archive& a, RunRecord& run) {
  internal::figures_and_status(a, run.figures, run.status, internal::every_figure);
  a("collapse_time_s", run.collapse_time, "time at which the beam touched the electrode");
  a("waveforms", run.waveforms, "waveform of each drive: time [s], level [V]; of a dispersion force its factor");
}

void members(internal::Archive& a, ContactFigures& contact) {
  a("gap_m", contact.gap, "rest distance to its contact plane");
  a.figures(contact.figures, internal::figure_of_contact);
}

void members(internal::Archive& a, EffectsLeftOut::LeftOut& one) {
  a("effect", one.effect, "name of the effect");
  a("influence", one.influence, "estimated relative influence on the figures");
}
void members(internal::Archive& a, EffectsLeftOut& effects) {
  a("left_out", effects.left_out, "effects that were left out");
  a("influence", effects.influence, "estimated relative influence of all of them together");
}

void members(internal::Archive& a, Spread& spread) {
  a("median", spread.median, "median over the perturbed runs");
  a("low", spread.low, "smallest value");
  a("high", spread.high, "largest value");
  a("runs", spread.runs, "number of runs");
}

void members(internal::Archive& a, GrazingRebound& rebound) {
  a("rebound", rebound.number, "number of the rebound, from 1");
  a("time_s", rebound.time, "begin of the rebound");
  a("height_m", rebound.height, "its height");
  a(key_of(&Metrics::impact_velocity), rebound.impact_velocity, "impact velocity of the touch before it");
  a("at_significant_height", rebound.at_threshold,
    "true: significant in some runs only; false: the touch before it is the slowest so far");
}

void members(internal::Archive& a, ClosedState& state) {
  a("exists", state.exists, "whether there is an equilibrium with a contact force");
  a("stable", internal::OrNull{state.stable}, "whether it is stable");
  a("smallest_eigenvalue_rad2_s2", state.smallest_eigenvalue, "smallest eigenvalue of the stiffness relative to the mass");
  a("pulled_through_V", state.pulled_through, "by electrode, voltage above which the closed beam collapses onto it");
  a.custom("by_modes", state.by_modes, internal::eigenvalues_json, internal::read_by_modes,
           internal::Like<std::map<std::string, double>>{"smallest eigenvalue by number of modes"});
  a.custom("pulled_through_by_modes_V", state.pulled_through_by_modes, internal::voltages_json, internal::read_voltages,
           internal::Like<std::map<std::string, std::map<std::string, double>>>{
               "by electrode, collapse voltage by number of modes; `converged`: extrapolated"});
}

void members(internal::Archive& a, PullInOfElectrode& volts) {
  a("static_V", volts.static_pull_in, "static pull-in voltage");
  a("dynamic_V", volts.dynamic_pull_in, "dynamic pull-in voltage");
  a.custom("by_modes", volts.static_by_modes, internal::static_by_modes_json, internal::read_static_by_modes,
           internal::Like<std::map<std::string, std::map<std::string, double>>>{
               "`static_V` by number of modes; `converged`: extrapolated"});
}

void members(internal::Archive& a, Work& work) {
  a.custom("integrator", work.integrator, internal::integrator_name, internal::read_integrator,
           internal::Like<std::string>{"integrator of the run"});
  a("steps", work.steps, "number of steps");
  a("rhs_evaluations", work.rhs_evaluations, "number of evaluations of the right-hand side");
  a("wall_s", work.wall, "elapsed time");
}

// json_of() adds the members that are computed from other members.
void members(internal::Archive& a, ClosingRecord& record) {
  members(a, record.origin);
  a("status", record.status, "outcome of the run, or `interrupted`");
  a.custom("pull_in", record.pull_in, internal::pull_in_json, internal::read_pull_in,
           internal::OneOrMore<PullInOfElectrode>{"pull-in voltages of the electrode"});
  a("warnings", record.warnings, "warnings");
  a("title", record.title, "title of the scene");
  a("natural_frequencies_rad_s", record.natural_frequencies, "natural angular frequencies");
  a("tolerance", record.tolerance, "relative tolerance of the integrator");
  if (a.has(!record.message.empty())) a("message", record.message, "why the run is not done");
  a("effects", record.effects, "effects that a coarse search left out");
  a.object(
      "curves",
      [&](auto& curves) {
        if (curves.has(record.best.figures.has_value()))
          curves("best", record.best.curve, "run under the best waveform, or the single run");
      },
      "curves of the runs, in files only");
  if (a.has(record.best.figures.has_value())) {
    a.object(
        "metrics",
        [&](auto& metrics) {
          if (metrics.reads() || !record.best.figures) record.best.figures.emplace();
          metrics.figures(*record.best.figures, internal::every_figure);
        },
        "figures of the run under the best waveform, or of the single run");
    a.object(
        "best", [&](auto& best) { members(best, record.best); }, "run under the best waveform, or the single run");
    internal::figure_errors(a, record.best.errors);
  }
  if (a.has(!record.contacts.empty())) a("contacts", record.contacts, "figures of each of several contacts");
  a("closed_state", record.closed_state, "closed equilibrium under the hold levels");
  a("work", record.work, "cost of the simulation");
  if (a.reads()) {
    if (internal::is_of_search(a.from())) record.search.emplace();
    a.object(
        "certified", [&](auto&) { record.certificate.emplace(); },
        "ill-conditioned figures over perturbed runs, with `--certify`");
  }
  if (record.search) members_of_search(a, *record.search, record);
  if (!record.certificate) return;
  a.custom("certified", record.certificate->ill_conditioned, internal::certified_json, internal::read_certified,
           internal::Like<std::map<std::string, Spread>>{"ill-conditioned figures over perturbed runs, with `--certify`"});
  a.object(
      "cloud",
      [&](auto& cloud) {
        cloud("runs", record.certificate->runs, "number of runs");
        cloud("grazing_rebound", internal::OrNull{record.certificate->grazing}, "rebound that makes the figures ill-conditioned");
      },
      "perturbed runs of `--certify`");
}

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

json metrics_json(const Metrics& m) { return internal::record_json(m); }

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
