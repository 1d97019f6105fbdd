#include "reports/robustness_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "reports/json_number.h"
#include "reports/made_with.h"
#include "reports/quantity.h"
#include "reports/text.h"
#include "version.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using internal::json_number;
using internal::percent;
using internal::quantity;
using nlohmann::json;

json interval_json(const Interval& interval) { return {json_number(interval.low), json_number(interval.high)}; }

json yield_json(const Yield& yield) {
  return {{"devices", yield.devices}, {"share", json_number(yield.value)}, {"interval", interval_json(yield.interval)}};
}

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
  for (const EnsembleFigure& f : ensemble_figures()) all[std::string(f.key)] = json_number(f.value(outcome));
  return all;
}

json device_json(const Ensemble& ensemble, const DriveRobustness& drive, std::size_t k) {
  json values = json::object();
  const std::vector<double> of_device = ensemble.values(k);
  const std::vector<SpreadVariable>& variables = ensemble.nominal().scene.spread.variables;
  for (std::size_t i = 0; i < variables.size(); ++i) values[variables[i].name] = of_device[i];
  json one{{"device", k},
           {"values", std::move(values)},
           {"status", to_string(drive.outcomes[k].metrics.status)},
           {"figures", figures_json(drive.outcomes[k])}};
  if (!drive.outcomes[k].failure.empty()) one["failure"] = drive.outcomes[k].failure;
  return one;
}

json waveforms_json(const DriveRobustness& drive, double duration) {
  json all = json::object();
  for (const auto& [name, waveform] : drive.waveforms) {
    const Signal s = signal(waveform);
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
    for (const VariedKey& key : v.keys) keys.push_back(key.path);
    all.push_back({{"name", v.name},
                   {"keys", std::move(keys)},
                   {"distribution", name_of(distribution_kinds, v.distribution.kind())},
                   {"is_factor", v.is_factor},
                   {"mean", v.distribution.mean()},
                   {"standard_deviation", v.distribution.standard_deviation()}});
  }
  return all;
}

// "3.4 % (2.7 to 4.3)"
std::string yield_text(const Yield& y) {
  return fmt::format("{} ({} to {})", percent(y.value), internal::plain_number(100 * y.interval.low),
                     internal::plain_number(100 * y.interval.high));
}

// "26.9 mm/s (26.6 to 27.1)"
std::string quantile_text(const EstimatedQuantile& q, std::string_view unit) {
  if (std::isinf(q.value)) return "not closed";
  const double factor = unit.empty() ? 1 : internal::prefix_for(q.value).factor;
  const auto bound = [&](double value) {
    return std::isfinite(value) ? internal::plain_number(value / factor) : std::string("?");
  };
  return fmt::format("{} ({} to {})", quantity(q.value, unit), bound(q.interval.low), bound(q.interval.high));
}

std::string spread_words(const DeviceSpread& spread) {
  std::string words;
  for (const SpreadVariable& v : spread.variables) {
    std::string keys;
    for (const VariedKey& key : v.keys) keys += (keys.empty() ? "" : " and ") + key.path;
    const double size = v.distribution.standard_deviation();
    words += fmt::format("{}{} {} ({})", words.empty() ? "" : ", ", keys,
                         v.is_factor ? "± " + percent(size) : "± " + quantity(size, v.keys.front().unit),
                         name_of(distribution_kinds, v.distribution.kind()));
  }
  return words;
}

// "Vdp measured to 1 %, frequency to 0.5 %"
std::string calibration_words(const Calibration& c) {
  std::string words;
  const auto add = [&](std::string_view name, const std::optional<double>& error) {
    if (!error) return;
    words += (words.empty() ? "" : ", ") + std::string(name) + (*error > 0 ? " measured to " + percent(*error) : " known exactly");
  };
  add(measured_pull_in, c.pull_in_error);
  add(measured_frequency, c.frequency_error);
  return words;
}

const EstimatedQuantile& quantile_95(const DriveRobustness& drive, std::string_view key) {
  const auto& all = ensemble_figures();
  const auto figure = std::find_if(all.begin(), all.end(), [&](const EnsembleFigure& f) { return f.key == key; });
  return drive.figures[static_cast<std::size_t>(figure - all.begin())].quantiles[2];
}

// What each measurement is worth: the last drive with more and more known of the devices.
std::string knowledge_text(const Robustness& found) {
  if (found.by_knowledge.empty() || found.devices == 0) return {};
  std::string text = fmt::format("\n{:<34}{:>24}{:>26}{:>26}\n", "Known of every device", "without a rebound", "v_max, 95 % below", "B_H, 95 % below");
  const auto row = [&](const std::string& name, const DriveRobustness& d) {
    text += internal::left_aligned(name, 34) + internal::right_aligned(yield_text(d.bounce_free), 24) +
            internal::right_aligned(quantile_text(quantile_95(d, "largest_impact_velocity_m_s"), "m/s"), 26) +
            internal::right_aligned(quantile_text(quantile_95(d, "major_bounce_height_m"), "m"), 26) + "\n";
  };
  for (const DriveRobustness& d : found.by_knowledge) row(d.name, d);
  const Calibration& c = found.drives.back().calibration;
  if (c.pull_in_error.value_or(0) > 0 || c.frequency_error.value_or(0) > 0) row(calibration_words(c), found.drives.back());
  return text;
}

}  // namespace

json robustness_json(const Prepared& nominal, const Robustness& found, const RobustnessOptions& options,
                     const Provenance& provenance) {
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  json drives = json::array();
  for (const DriveRobustness& d : found.drives) {
    json figures = json::object(), worst = json::array(), failures = json::object();
    for (std::size_t i = 0; i < d.figures.size(); ++i)
      figures[std::string(ensemble_figures()[i].key)] = statistics_json(d.figures[i]);
    for (const std::size_t k : d.worst) worst.push_back(device_json(ensemble, d, k));
    std::map<std::string, std::size_t> reasons;
    for (const DeviceOutcome& o : d.outcomes) {
      if (!o.closed()) ++reasons[o.failure.empty() ? std::string(to_string(o.metrics.status)) : o.failure];
    }
    for (const auto& [why, count] : reasons) failures[why] = count;
    drives.push_back({{"name", d.name},
                      {"waveforms", waveforms_json(d, found.duration)},
                      {"closing", yield_json(d.closing)},
                      {"bounce_free", yield_json(d.bounce_free)},
                      {"figures", std::move(figures)},
                      {"failures", std::move(failures)},
                      {"worst", std::move(worst)}});
  }
  const SceneFile scene = resolved(nominal.scene, nominal.voltage_units());
  return {{"kind", "robustness"},
          {"status", found.interrupted ? "interrupted" : "done"},
          {"devices", found.devices},
          {"seed", options.seed},
          {"points", name_of(point_sets, options.points)},
          {"duration_s", found.duration},
          {"tolerance", found.tolerance},
          {"spread", spread_json(nominal.scene.spread)},
          {"drives", std::move(drives)},
          {"warnings", nominal.scene.warnings},
          {"scene", scene.json()},
          {"scene_toml", scene.text()},
          {"version", version},
          {"made_with", made_with_json()},
          {"command", provenance.command}};
}

std::string robustness_text(const Prepared& nominal, const Robustness& found, const RobustnessOptions& options) {
  std::string text;
  if (found.interrupted) text += "Interrupted: these are not all devices.\n\n";
  const Calibration& calibration = found.drives.empty() ? Calibration{} : found.drives.back().calibration;
  text += wrapped(fmt::format("{} devices of the spread: {}. {}", found.devices, spread_words(nominal.scene.spread),
                              calibration.is_empty()
                                  ? "All have the volts that were designed for the nominal device."
                                  : "The plain step has the volts of the nominal device, every other drive the units of each "
                                    "device: " + calibration_words(calibration) + ".")) +
          "\n\n";
  if (found.devices == 0) return text;
  constexpr std::size_t label = 34;
  std::size_t width = 27;
  for (const DriveRobustness& d : found.drives) width = std::max(width, internal::columns_of(d.name) + 2);
  const auto row = [&](std::string_view name, const auto& cell) {
    std::string line = internal::left_aligned(std::string(name), label);
    for (const DriveRobustness& d : found.drives) line += internal::right_aligned(cell(d), width);
    text += line + "\n";
  };
  row("", [](const DriveRobustness& d) { return d.name; });
  row("devices that close", [](const DriveRobustness& d) { return yield_text(d.closing); });
  row("without a rebound", [](const DriveRobustness& d) { return yield_text(d.bounce_free); });
  for (std::size_t i = 0; i < ensemble_figures().size(); ++i) {
    const EnsembleFigure& f = ensemble_figures()[i];
    const bool has_symbol = !f.symbol.empty() && f.symbol.find(' ') == std::string_view::npos;
    text += fmt::format("{}{}{}\n", f.name, has_symbol ? ", " : "", has_symbol ? f.symbol : "");
    for (const std::size_t q : {std::size_t{1}, std::size_t{2}}) {
      row(q == 1 ? "  median" : fmt::format("  {:.0f} % of devices below", 100 * robustness_quantiles[q]),
          [&](const DriveRobustness& d) { return quantile_text(d.figures[i].quantiles[q], f.unit); });
    }
  }
  text += knowledge_text(found);
  text += "\n" +
          wrapped(fmt::format("In brackets: 95 % confidence. Seed {}, {} points, window {}, integrator tolerance {}. A device "
                              "that does not close counts as the worst.",
                              options.seed, name_of(point_sets, options.points), quantity(found.duration, "s", 4),
                              internal::scientific(found.tolerance))) +
          "\n";
  for (const std::string& warning : nominal.scene.warnings) text += "\n" + wrapped("warning: " + warning) + "\n";
  return text;
}

std::string robustness_csv(const Prepared& nominal, const Robustness& found, const RobustnessOptions& options) {
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
    for (const EnsembleFigure& f : ensemble_figures()) text += "," + cell(fmt::format("{}: {}", d.name, f.key));
  }
  text += "\n";
  for (std::size_t k = 0; k < found.devices; ++k) {
    text += std::to_string(k);
    for (const double value : ensemble.values(k)) text += fmt::format(",{}", value);
    for (const DriveRobustness& d : found.drives) {
      const DeviceOutcome& o = d.outcomes[k];
      text += fmt::format(",{}", o.failure.empty() ? std::string(to_string(o.metrics.status)) : cell(o.failure));
      for (const EnsembleFigure& f : ensemble_figures()) {
        const double value = f.value(o);
        text += std::isfinite(value) ? fmt::format(",{}", value) : std::string(",");
      }
    }
    text += "\n";
  }
  return text;
}

}  // namespace softland
