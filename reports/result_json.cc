#include "reports/result_json.h"

#include <cmath>

#include "reports/devices_report.h"
#include "reports/findings.h"
#include "reports/json_number.h"
#include "reports/made_with.h"
#include "reports/seeds_report.h"

namespace softland {
namespace {

using internal::json_number;
using nlohmann::json;

json figure_json(const Figure& figure, double value) {
  if (!std::isfinite(value)) return nullptr;
  if (figure.is_yes_or_no()) return value != 0;
  return figure.is_count() ? json(std::llround(value)) : json(value);
}

// Of the figures that are asked for.
template <class Asked>
json figures_json(const FigureValues& values, const Asked& asked) {
  json all = json::object();
  for (const Figure& figure : all_figures) {
    if (asked(figure)) all[std::string(figure.key)] = figure_json(figure, values[figure]);
  }
  return all;
}

bool every(const Figure&) { return true; }
bool of_no_drive(const Figure& figure) { return figure.conditioning != Conditioning::drives; }
bool of_number(const Figure& figure) { return !figure.is_yes_or_no(); }

json with_status(json figures, std::string_view status) {
  figures["status"] = status;
  return figures;
}

// [x, y] with x a whole number.
json counted_json(const Points& points) {
  json all = json::array();
  for (const auto& [index, value] : points) all.push_back({std::llround(index), json_number(value)});
  return all;
}

json run_json(const ResultRun& run) {
  json waveforms = json::object();
  for (const auto& [drive, points] : run.waveforms) waveforms[drive] = points;
  return {{"metrics", with_status(figures_json(*run.figures, every), run.status)},
          {"collapse_time_s", json_number(run.collapse_time)},
          {"waveforms", std::move(waveforms)}};
}

json curve_json(const ResultCurve& c) {
  json bounces = json::array();
  for (const Rebound& r : c.rebounds) bounces.push_back({r.begin, json_number(r.end), r.height, r.time_of_height});
  return {{"time_s", c.time},
          {"tip_gap_m", c.gap},
          {"tip_velocity_m_s", c.velocity},
          {"contact_force_N", c.force},
          {"rebounds", std::move(bounces)}};
}

json pull_in_json(const std::map<std::string, PullInVoltages>& pull_in) {
  if (pull_in.empty()) return nullptr;
  const auto one = [](const PullInVoltages& v) {
    return json{{"static_V", json_number(v.static_pull_in)}, {"dynamic_V", json_number(v.dynamic_pull_in)}};
  };
  // One electrode is the usual case; several are told apart by name.
  if (pull_in.size() == 1) return one(pull_in.begin()->second);
  json all = json::object();
  for (const auto& [name, voltages] : pull_in) all[name] = one(voltages);
  return all;
}

// Of an ill-conditioned figure the cloud it is a property of.
json certified_json(const Certificate& certificate) {
  json all = json::object();
  for (const IllConditioned& f : certificate.ill_conditioned) {
    all[std::string(f.figure.key)] = {{"median", json_number(f.spread.median)},
                                      {"low", json_number(f.spread.low)},
                                      {"high", json_number(f.spread.high)},
                                      {"runs", f.spread.runs}};
  }
  return all;
}

json grazing_json(const std::optional<GrazingRebound>& r) {
  if (!r) return nullptr;
  return {{"rebound", r->number},
          {"time_s", r->time},
          {"height_m", r->height},
          {"impact_velocity_m_s", json_number(r->impact_velocity)},
          {"at_significant_height", r->at_threshold}};
}

json work_json(const Work& w) {
  return {
      {"integrator", to_string(w.integrator)}, {"steps", w.steps}, {"rhs_evaluations", w.rhs_evaluations}, {"wall_s", w.wall}};
}

json effects_json(const ResultEffects& effects) {
  json left_out = json::array();
  for (const auto& [effect, influence] : effects.left_out)
    left_out.push_back({{"effect", effect}, {"influence", json_number(influence)}});
  return {{"left_out", std::move(left_out)}, {"influence", json_number(effects.influence)}};
}

json robust_json(const ResultRobust& robust) {
  const auto condition = [](const ResultRobust::Condition& c) {
    return json{{"condition", c.text},
                {"share", json_number(c.share)},
                {"interval", {json_number(c.low), json_number(c.high)}},
                {"holds", c.holds}};
  };
  json conditions = json::array();
  for (const ResultRobust::Condition& c : robust.conditions) conditions.push_back(condition(c));
  json j{{"measure", robust.measure},
         {"devices", json_number(robust.devices)},
         {"fresh_devices", json_number(robust.fresh_devices)},
         {"closings", json_number(robust.closings)},
         {"cost_on_searched_devices", json_number(robust.cost_on_searched)},
         {"failing_share", json_number(robust.failing)},
         {"measure_tells", robust.is_told},
         {"conditions", std::move(conditions)}};
  if (robust.yield) j["yield"] = condition(*robust.yield);
  return j;
}

void add_search(json& j, const Result& r) {
  j["target"] = r.target;
  j["actuator"] = r.actuator;
  j["waveform"] = r.waveform;
  for (const ResultFamily& one : r.families)
    j["families"].push_back(
        {{"family", one.family}, {"evaluations", std::llround(one.evaluations)}, {"cost", json_number(one.cost)}});
  if (r.seed) j["seed"] = *r.seed;
  j["optimizer"] = r.optimizer;
  j["evaluations"] = std::llround(r.evaluations);
  j["termination"] = r.termination;
  j["termination_message"] = r.termination_message;
  if (r.goal_met) j["goal_met"] = *r.goal_met;
  if (r.better_than_baseline) j["better_than_baseline"] = *r.better_than_baseline;
  j["baseline"] = run_json(r.baseline);
  j["baseline"]["errors"] = figures_json(r.baseline.errors, of_number);
  j["baseline"]["cost"] = json_number(r.baseline.cost);
  j["curves"]["baseline"] = curve_json(r.baseline.curve);
  j["search"] = {{"best_so_far", counted_json(r.search.best_so_far)}, {"value_name", r.search.value_name}};
  if (!r.search.evaluations.empty()) j["search"]["evaluations"] = counted_json(r.search.evaluations);
  j["reproduce"] = r.reproduce;
  if (r.robust) j["robust"] = robust_json(*r.robust);
  if (r.devices) {
    j["devices"] = internal::devices_json(*r.devices);
    j["drawing"] = {{"metrics", with_status(figures_json(r.devices->drawing, every), r.devices->drawing_status)},
                    {"goal_met", r.devices->drawing_goal_met}};
  }
  if (r.seeds) j["seeds"] = seeds_json(*r.seeds);
  if (r.limit) {
    j["limit"] = {{"least_time_s", json_number(r.limit->least_time)},
                  {"impact_velocity_m_s", json_number(r.limit->impact_velocity)}};
  }
  if (!r.best.figures) return;
  j["best"]["parameters"] = r.parameters;
  j["best"]["bounds"] = r.bounds;
  j["best"]["cost"] = json_number(r.best.cost);
  json checks = json::array();
  for (const ResultCheck& c : r.checks)
    checks.push_back({{"name", c.name}, {"metrics", with_status(figures_json(*c.figures, of_no_drive), c.status)}});
  j["checks"] = std::move(checks);
  if (r.checks.empty()) return;
  j["confirmed"] = internal::all_checks_land(r);
  if (const ResultCheck* worst = internal::worst_check(r.checks)) {
    const std::string_view figure = internal::worst_figure(*worst);
    const json figures = figures_json(*worst->figures, of_no_drive);
    j["worst"] = {{"name", worst->name}, {"figure", figure}, {"value", figures[std::string(figure)]}};
  }
  if (r.evaluations_of_modes) j["evaluations_with_more_modes"] = std::llround(*r.evaluations_of_modes);
}

}  // namespace

json closed_state_json(const ClosedState& state) {
  json pulled_through = json::object();
  for (const auto& [electrode, volts] : state.pulled_through) pulled_through[electrode] = json_number(volts);
  return {{"exists", state.exists},
          {"stable", state.stable ? json(*state.stable) : json()},
          {"smallest_eigenvalue_rad2_s2", json_number(state.smallest_eigenvalue)},
          {"pulled_through_V", std::move(pulled_through)}};
}

json metrics_json(const Metrics& m) { return with_status(figures_json(FigureValues(m), of_no_drive), to_string(m.status)); }

std::string json_text(const json& data, int indent) {
  return data.dump(indent, ' ', false, json::error_handler_t::replace) + "\n";
}

json result_json(const Result& r) {
  json j{{"kind", r.is_search ? "optimize" : "simulate"},
         {"version", r.version},
         {"command", r.command},
         {"made_with", made_with_json(r.made_with)},
         {"status", r.status},
         {"pull_in", pull_in_json(r.pull_in)},
         {"warnings", r.warnings},
         {"title", r.title},
         {"scene", r.scene.tree},
         {"scene_toml", r.scene.text},
         {"natural_frequencies_rad_s", r.natural_frequencies},
         {"tolerance", r.tolerance},
         {"curves", json::object()}};
  if (!r.message.empty()) j["message"] = r.message;
  if (r.effects) j["effects"] = effects_json(*r.effects);
  if (r.best.figures) {
    j["metrics"] = figures_json(*r.best.figures, every);
    j["errors"] = figures_json(r.best.errors, of_number);
    j["best"] = run_json(r.best);
    j["curves"]["best"] = curve_json(r.best.curve);
  }
  if (r.closed_state) j["closed_state"] = closed_state_json(*r.closed_state);
  if (!r.is_search) {
    j["collapse_time_s"] = json_number(r.best.collapse_time);
    for (const char* key : {"static_deflection_m", "capacitance_F"})
      if (j.contains("metrics")) j[key] = j["metrics"][key];
  }
  if (r.work) j["work"] = work_json(*r.work);
  if (r.certificate) {
    j["certified"] = certified_json(*r.certificate);
    j["cloud"] = {{"runs", r.certificate->runs}, {"grazing_rebound", grazing_json(r.certificate->grazing)}};
  }
  if (r.is_search) add_search(j, r);
  return j;
}

json summary_json(json result) {
  for (const char* key : {"curves", "scene_toml", "search"}) result.erase(key);
  if (result.contains("baseline")) {
    result["baseline"].erase("waveforms");
  } else {
    result.erase("best");  // a single run: its figures stand above
  }
  return result;
}

}  // namespace softland
