#include "reports/robustness_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "reports/box_and_chaos_report.h"
#include "reports/derivatives_report.h"
#include "reports/estimates.h"
#include "reports/json_number.h"
#include "reports/origin.h"
#include "reports/result_json.h"
#include "reports/robustness_words.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/simulate.h"
#include "studies/closing/summits_at_hold.h"
#include "studies/devices/box_and_chaos.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using internal::interval_json;
using internal::json_number;
using internal::shown_values;
using internal::yield_json;
using nlohmann::json;

json statistics_json(const FigureStatistics& s) {
  json quantiles = json::array();
  for (std::size_t i = 0; i < robustness_quantiles.size(); ++i) {
    quantiles.push_back({{"probability", robustness_quantiles[i]},
                         {"value", json_number(s.quantiles[i].value)},
                         {"interval", interval_json(s.quantiles[i].interval)}});
  }
  return {{"mean", json_number(s.mean)},
          {"standard_deviation", json_number(s.standard_deviation)},
          {"skewness", json_number(s.skewness)},
          {"devices", s.devices},
          {"quantiles", std::move(quantiles)}};
}

json figures_json(const DeviceOutcome& outcome) {
  json all = json::object();
  for (const Figure& f : device_figures) all[std::string(f.key)] = json_number(outcome.of(f));
  return all;
}

json device_json(const Ensemble& ensemble, const DriveRobustness& drive, std::size_t k) {
  json values = json::object();
  const std::vector<double> of_device = shown_values(ensemble, k);
  const std::vector<SpreadVariable>& variables = ensemble.nominal().scene.spread.variables;
  for (std::size_t i = 0; i < variables.size(); ++i) values[variables[i].name] = of_device[i];
  json one{{"device", k},
           {"values", std::move(values)},
           {"status", to_string(drive.outcomes[k].metrics.status)},
           {"figures", figures_json(drive.outcomes[k])}};
  if (!drive.outcomes[k].failure.empty()) one["failure"] = drive.outcomes[k].failure;
  return one;
}

json waveforms_json(const PreparedScene& nominal, const DriveRobustness& drive, double duration) {
  json all = json::object();
  const std::vector<std::string> names = nominal.drive_names();
  for (const auto& [name, waveform] : drive.waveforms) {
    const auto k = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    const Signal s = nominal.driven(k, nominal.told(k, waveform));
    const bool is_factor = name == dispersion_drive;
    json points = json::array();
    for (const auto& [t, v] : polyline(s, duration, 1e-3 * (s.maximum(duration) - s.minimum(duration)), 0))
      points.push_back({t, is_factor ? 1 + v : v});
    all[name] = std::move(points);
  }
  return all;
}

json spread_json(const DeviceSpread& spread) {
  json all = json::array();
  for (const SpreadVariable& v : spread.variables) {
    json keys = json::array();
    for (const VariedKey& key : v.keys) keys.push_back(key.name());
    all.push_back({{"name", v.name},
                   {"keys", std::move(keys)},
                   {"distribution", name_of(distribution_kinds, v.distribution.kind())},
                   {"is_factor", v.is_factor},
                   {"mean", v.distribution.mean()},
                   {"standard_deviation", v.distribution.standard_deviation()}});
  }
  return all;
}

json calibration_json(const Calibration& c) {
  const auto error = [](const std::optional<double>& of) { return of ? json(*of) : json(nullptr); };
  return {{"Vdp_error", error(c.pull_in_error)},
          {"frequency_error", error(c.frequency_error)},
          {"piezo_error", error(c.piezo_error)},
          {"time_error_s", error(c.time_error)},
          {"classes", c.classes ? json(*c.classes) : json(nullptr)}};
}

json classes_json(const std::vector<KnownUnits::Class>& classes) {
  json all = json::array();
  for (const KnownUnits::Class& c : classes)
    all.push_back(
        {{"volts_factor", c.centre.volts}, {"time_factor", c.centre.time}, {"piezo_factor", c.centre.piezo}, {"share", c.share}});
  return all;
}

json index_json(const SobolIndex& index) {
  return {{"value", json_number(index.value)}, {"interval", interval_json(index.interval)}, {"above_zero", index.above_zero}};
}

json sensitivity_json(const Sensitivity& sensitivity) {
  json figures = json::object();
  for (const FigureSensitivity& f : sensitivity.figures) {
    json variables = json::object();
    for (std::size_t i = 0; i < sensitivity.variables.size() && f.estimate.indices; ++i)
      variables[sensitivity.variables[i]] = {{"first_order", index_json(f.estimate.indices->first_order[i])},
                                             {"total", index_json(f.estimate.indices->total[i])}};
    figures[std::string(f.key)] = {
        {"rows", f.estimate.rows}, {"failed_rows", f.estimate.failed_rows}, {"variables", std::move(variables)}};
  }
  json j{{"figures", std::move(figures)}};
  if (!sensitivity.why_none.empty()) j["why_none"] = sensitivity.why_none;
  return j;
}

}  // namespace

json internal::windows_json(const HoldWindows& windows) {
  json all = json::object();
  for (const auto& [electrode, window] : windows.of_electrodes)
    all[electrode] = std::isfinite(window.lower) ? json::array({window.lower, json_number(window.upper)}) : json();
  return all;
}

void add_details(RobustnessReport& report, bool other_ways_too, const Watch& watch) {
  if (report.found.interrupted || report.found.devices == 0) return;
  constexpr std::uint64_t devices_per_row = 4, most_rows = 1024;
  const DriveRobustness& last = report.found.drives.back();
  report.sensitivity =
      sensitivity(report.nominal, last, std::clamp<std::uint64_t>(report.options.samples / devices_per_row, 8, most_rows),
                  report.options, watch);
  report.derivatives = derivatives(report.nominal, internal::exactly_measured(report.nominal, last), {}, watch);
  report.windows = hold_windows(report.nominal, report.options, watch);
  if (report.nominal.model.has_contact()) {
    const std::vector<Signal> signals = report.nominal.driven(report.nominal.in_drive_order(last.waveforms));
    report.unheld = hold_warning(report.nominal.model, signals, closed_state(report.nominal, signals));
  }
  report.courses = device_courses(report.nominal, last, report.found, report.options);
  if (other_ways_too) report.box_and_chaos = box_and_chaos(report.nominal, last, report.options, {}, watch);
  report.interrupted = watch.stopped();
}

std::vector<std::string> warnings(const RobustnessReport& report) {
  std::vector<std::string> all = report.nominal.scene.warnings;
  if (!report.unheld.empty()) all.push_back(report.unheld);
  if (!report.found.drives.empty()) {
    const DriveRobustness& last = report.found.drives.back();
    const std::vector<Signal> signals = report.nominal.driven(report.nominal.in_drive_order(last.waveforms));
    if (std::string few = few_summits_warning(report.nominal.model, signals); !few.empty()) all.push_back(std::move(few));
  }
  return all;
}

json robustness_json(const RobustnessReport& report) {
  const auto& [nominal, found, options, command, spread_assumed, sensitivity, derivatives, courses, ways, windows, unheld,
               interrupted] = report;
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  const auto drive_json = [&](const DriveRobustness& d) {
    json figures = json::object(), worst = json::array(), failures = json::object();
    for (const Figure& f : device_figures) figures[std::string(f.key)] = statistics_json(d.figures[f]);
    for (const std::size_t k : d.worst) worst.push_back(device_json(ensemble, d, k));
    std::map<std::string, std::size_t> reasons;
    for (const DeviceOutcome& o : d.outcomes) {
      if (!o.closed()) ++reasons[o.failure.empty() ? std::string(to_string(o.metrics.status)) : o.failure];
    }
    for (const auto& [why, count] : reasons) failures[why] = count;
    const bool has_contact = nominal.model.has_contact();
    return json{
        {"name", d.name},
        {"closed_state",
         has_contact ? closed_state_json(closed_state(nominal, nominal.driven(nominal.in_drive_order(d.waveforms)))) : json()},
        {"calibration", calibration_json(d.known.calibration())},
        {"classes", classes_json(d.known.classes())},
        {"waveforms", waveforms_json(nominal, d, found.duration)},
        {"closing", yield_json(d.closing)},
        {"collapsed_onto_electrode", yield_json(d.collapsed)},
        {"bounce_free", yield_json(d.bounce_free)},
        {"figures", std::move(figures)},
        {"failures", std::move(failures)},
        {"worst", std::move(worst)}};
  };
  json drives = json::array(), by_knowledge = json::array();
  for (const DriveRobustness& d : found.drives) drives.push_back(drive_json(d));
  for (const DriveRobustness& d : found.by_knowledge) by_knowledge.push_back(drive_json(d));
  return with_origin({{"kind", "robustness"},
                      {"status", interrupted ? "interrupted" : "done"},
                      {"devices", found.devices},
                      {"seed", options.seed},
                      {"points", name_of(point_sets, options.points)},
                      {"duration_s", found.duration},
                      {"tolerance", found.tolerance},
                      {"spread", spread_json(nominal.scene.spread)},
                      {"spread_assumed", spread_assumed},
                      {"hold_window_V", internal::windows_json(windows)},
                      {"hold_window_devices", windows.devices},
                      {"drives", std::move(drives)},
                      {"by_knowledge", std::move(by_knowledge)},
                      {"sensitivity", sensitivity_json(sensitivity)},
                      {"derivatives", internal::derivatives_json(derivatives, found.drives.back())},
                      {"other_ways", ways ? internal::other_ways_json(*ways, found.drives.back(), nominal) : json(nullptr)},
                      {"warnings", warnings(report)},
                      {"scene_toml", nominal.resolved().text()}},
                     nominal, command);
}

std::string robustness_csv(const RobustnessReport& report) {
  const auto& [nominal, found, options, command, spread_assumed, sensitivity, derivatives, courses, ways, windows, unheld,
               interrupted] = report;
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  std::string text = "device";
  // Names may hold commas and quotes.
  const auto cell = [](const std::string& name) {
    std::string quoted = "\"";
    for (const char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return name.find_first_of(",\"\n") == std::string::npos ? name : quoted + "\"";
  };
  for (const SpreadVariable& v : nominal.scene.spread.variables) text += "," + cell(v.name);
  for (const DriveRobustness& d : found.drives) {
    text += "," + cell(d.name + ": status");
    for (const Figure& f : device_figures) text += "," + cell(fmt::format("{}: {}", d.name, f.key));
  }
  text += "\n";
  for (std::size_t k = 0; k < found.devices; ++k) {
    text += std::to_string(k);
    for (const double value : shown_values(ensemble, k)) text += fmt::format(",{}", value);
    for (const DriveRobustness& d : found.drives) {
      const DeviceOutcome& o = d.outcomes[k];
      text += fmt::format(",{}", o.failure.empty() ? std::string(to_string(o.metrics.status)) : cell(o.failure));
      for (const Figure& f : device_figures) {
        const double value = o.of(f);
        text += std::isfinite(value) ? fmt::format(",{}", value) : std::string(",");
      }
    }
    text += "\n";
  }
  return text;
}

}  // namespace softland
