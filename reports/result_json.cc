#include "reports/result_json.h"

#include <cmath>

#include "integrators/quintic.h"
#include "reports/json_number.h"
#include "reports/made_with.h"
#include "studies/certify.h"
#include "studies/omissions.h"
#include "version.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using internal::json_number;
using nlohmann::json;

json figure_json(const Figure& figure, double value) {
  if (!std::isfinite(value)) return nullptr;
  if (figure.is_yes_or_no()) return value != 0;
  return figure.is_count() ? json(std::llround(value)) : json(value);
}

// With what only the drives tell, which not every run is asked for.
json all_metrics_json(const Metrics& m) {
  json all = metrics_json(m);
  for (const Figure& figure : all_figures) {
    if (figure.conditioning == Conditioning::drives) all[std::string(figure.key)] = figure_json(figure, figure.value(m));
  }
  return all;
}

json pull_in_json(const Prepared& p) {
  if (p.pull_in.empty()) return nullptr;
  const auto one = [](const ElectrodePullIn& e) {
    return json{{"static_V", json_number(e.statically.voltage)}, {"dynamic_V", json_number(e.dynamically.voltage)}};
  };
  // One electrode is the usual case; several are told apart by name.
  if (p.pull_in.size() == 1) return one(p.pull_in.begin()->second);
  json all = json::object();
  for (const auto& [name, e] : p.pull_in) all[name] = one(e);
  return all;
}

json frequencies_json(const Prepared& p) {
  json list = json::array();
  for (const double omega : p.device.angular_frequencies()) list.push_back(omega);
  return list;
}

// Straight pieces that a reader can draw: exact for steps, pulses and tables, a thousandth of the swing for sines.
json waveforms_json(const Prepared& p, double end) {
  json all = json::object();
  const std::vector<std::string> names = p.drive_names();
  const std::vector<Signal> signals = p.signals();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const double swing = signals[k].maximum(end) - signals[k].minimum(end);
    const bool is_factor = names[k] == dispersion_drive;
    if (is_factor && signals[k].is_zero()) continue;  // nominal
    json points = json::array();
    for (const auto& [t, v] : polyline(signals[k], end, 1e-3 * swing, 0)) points.push_back({t, is_factor ? 1 + v : v});
    all[names[k]] = std::move(points);
  }
  return all;
}

// Knots, and points of the interpolant where knots are far apart.
json curves_json(const Trajectory& t, const MetricsOptions& options) {
  json time = json::array(), gap = json::array(), speed = json::array(), force = json::array(), bounces = json::array();
  const auto add = [&](double at, double position, double velocity, double contact) {
    time.push_back(at);
    gap.push_back(t.contact_gap - position);
    speed.push_back(velocity);
    force.push_back(contact);
  };
  const double longest = t.points.empty() ? 0 : t.points.back().time / 2000;
  for (std::size_t i = 0; i < t.points.size(); ++i) {
    const TrajectoryPoint& a = t.points[i];
    add(a.time, a.position, a.velocity, a.contact_force);
    if (i + 1 == t.points.size()) break;
    const TrajectoryPoint& b = t.points[i + 1];
    const double h = b.time - a.time;
    if (!(h > longest)) continue;
    const Quintic between(a.time, a.position, a.velocity, a.acceleration, b.time, b.position, b.velocity, b.acceleration);
    const int parts = static_cast<int>(std::ceil(h / longest));
    for (int k = 1; k < parts; ++k) {
      const double at = a.time + h * k / parts;
      add(at, between.position(at), between.velocity(at), a.contact_force + (b.contact_force - a.contact_force) * k / parts);
    }
  }
  for (const Rebound& r : rebounds(t)) {
    if (r.height > options.significant_rebound) bounces.push_back({r.begin, json_number(r.end), r.height, r.time_of_height});
  }
  return {{"time_s", std::move(time)},
          {"tip_gap_m", std::move(gap)},
          {"tip_velocity_m_s", std::move(speed)},
          {"contact_force_N", std::move(force)},
          {"rebounds", std::move(bounces)}};
}

json errors_json(const FigureValues& errors) {
  json e = json::object();
  for (const Figure& figure : all_figures) {
    if (!figure.is_yes_or_no()) e[std::string(figure.key)] = figure_json(figure, errors[figure]);
  }
  return e;
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

void add_scene(json& j, const Prepared& p) {
  if (p.effects) {
    json left_out = json::array();
    for (const Omission& o : p.effects->choice.left_out)
      left_out.push_back({{"effect", o.what.effect}, {"influence", json_number(o.influence)}});
    j["effects"] = {{"left_out", left_out}, {"influence", json_number(p.effects->choice.influence)}};
  }
  const SceneFile file = resolved(p.scene, p.voltage_units());
  j["title"] = p.scene.title;
  j["scene"] = file.json();
  j["scene_toml"] = file.text();
  j["natural_frequencies_rad_s"] = frequencies_json(p);
  j["tolerance"] = p.tolerance;
}

// The box that every parameter was searched in.
json bounds_json(const OptimizeResult& r) {
  json all = json::object();
  for (const Variable& v : r.variables) all[v.name] = {v.lower, v.upper};
  return all;
}

json started(std::string_view kind, const Provenance& provenance) {
  return {{"kind", kind}, {"version", version}, {"command", provenance.command}, {"made_with", made_with_json()}};
}

}  // namespace

std::string_view to_string(Actuator actuator) {
  switch (actuator) {
    case Actuator::electrostatic:
      return "electrostatic";
    case Actuator::pzt:
      return "pzt";
    case Actuator::both:
      return "both";
  }
  return "unknown";
}

json metrics_json(const Metrics& m) {
  json all{{"status", to_string(m.status)}};
  for (const Figure& figure : all_figures) {
    if (figure.conditioning != Conditioning::drives) all[std::string(figure.key)] = figure_json(figure, figure.value(m));
  }
  return all;
}

json result_json(const Prepared& prepared, const Closing& closing, const Provenance& provenance) {
  json j = started("simulate", provenance);
  j["status"] = to_string(closing.metrics.status);
  if (!closing.trajectory.message.empty()) j["message"] = closing.trajectory.message;
  j["metrics"] = all_metrics_json(closing.metrics);
  j["metrics"].erase("status");
  j["errors"] = errors_json(closing.errors);
  if (closing.certificate) {
    j["certified"] = certified_json(*closing.certificate);
    j["cloud"] = {{"runs", closing.certificate->runs}, {"grazing_rebound", grazing_json(closing.certificate->grazing)}};
  }
  j["pull_in"] = pull_in_json(prepared);
  j["work"] = work_json(closing.trajectory.work);
  j["warnings"] = closing.warnings;
  j["best"] = {{"metrics", all_metrics_json(closing.metrics)}, {"waveforms", waveforms_json(prepared, prepared.duration)}};
  j["curves"] = {{"best", curves_json(closing.trajectory, prepared.scene.metrics)}};
  add_scene(j, prepared);
  j["tolerance"] = closing.tolerance;
  return j;
}

json result_json(const OptimizeResult& r, const OptimizeOptions& options, const Provenance& provenance) {
  json j = started("optimize", provenance);
  const bool interrupted = r.search.termination == Termination::interrupted;
  j["status"] = interrupted ? std::string_view("interrupted")
                : r.best    ? to_string(r.best->metrics.status)
                            : to_string(Status::no_contact);
  j["target"] = to_string(options.target);
  j["actuator"] = to_string(options.actuator);
  j["waveform"] = options.family;
  j["seed"] = options.seed;
  j["optimizer"] = options.optimizer;
  j["evaluations"] = r.search.evaluations;
  j["termination"] = to_string(r.search.termination);
  j["termination_message"] = r.search.message;
  j["goal_met"] = r.goal_met;
  j["better_than_baseline"] = r.better_than_baseline;
  j["pull_in"] = pull_in_json(r.scene);
  j["baseline"] = {{"metrics", all_metrics_json(r.baseline.metrics)},
                   {"errors", errors_json(r.baseline.errors)},
                   {"waveforms", waveforms_json(r.baseline_scene, r.baseline_scene.duration)},
                   {"cost", json_number(r.baseline_cost)}};
  j["curves"] = {{"baseline", curves_json(r.baseline.trajectory, r.scene.scene.metrics)}};
  json history = json::array();
  for (const Evaluation& e : r.search.improvements) history.push_back({e.index, json_number(e.value)});
  j["search"] = {{"best_so_far", std::move(history)}, {"value_name", "cost"}};
  // Warnings of the scene come with every closing: once is enough.
  std::vector<std::string> warnings = r.best ? r.best->warnings : r.baseline.warnings;
  j["warnings"] = warnings;
  if (!r.best) {
    add_scene(j, r.scene);
    return j;
  }
  j["metrics"] = all_metrics_json(r.best->metrics);
  j["metrics"].erase("status");
  j["errors"] = errors_json(r.best->errors);
  j["work"] = work_json(r.best->trajectory.work);
  j["best"] = {{"parameters", r.parameters},
               {"bounds", bounds_json(r)},
               {"metrics", all_metrics_json(r.best->metrics)},
               {"waveforms", waveforms_json(*r.best_scene, r.best_scene->duration)},
               {"cost", json_number(r.best_cost)}};
  j["curves"]["best"] = curves_json(r.best->trajectory, r.scene.scene.metrics);
  json checks = json::array();
  for (const ConfirmingRun& c : r.checks) checks.push_back({{"name", c.name}, {"metrics", metrics_json(c.metrics)}});
  j["checks"] = std::move(checks);
  add_scene(j, *r.best_scene);
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
