#include "reports/robustness_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "base/require.h"
#include "config/assumed_spread.h"
#include "document/json_number.h"
#include "reports/robustness_prose.h"
#include "reports/robustness_sections.h"
#include "reports/study_members.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/simulate.h"
#include "studies/closing/summits_at_hold.h"
#include "studies/devices/box_and_chaos.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using internal::shown_values;
using nlohmann::json;

RobustnessRecord::Device device_of(const Ensemble& ensemble, const DriveRobustness& drive, std::size_t k) {
  const DeviceOutcome& outcome = drive.outcomes[k];
  RobustnessRecord::Device device{.number = k,
                                  .values = {},
                                  .status = std::string(to_string(outcome.metrics.status)),
                                  .failure = outcome.failure,
                                  .figures = {}};
  const std::vector<double> values = shown_values(ensemble, k);
  const std::vector<SpreadVariable>& variables = ensemble.nominal().scene.spread.variables;
  for (std::size_t i = 0; i < variables.size(); ++i) device.values[variables[i].name] = values[i];
  for (const Figure& f : asked_among(device_figures, ensemble.nominal().scene.metrics.asked))
    device.figures[std::string(f.key)] = outcome.of(f);
  return device;
}

std::map<std::string, Points> waveforms_of(const PreparedScene& nominal, const DriveRobustness& drive, double duration) {
  std::map<std::string, Points> all;
  const std::vector<std::string> names = nominal.drive_names();
  for (const auto& [name, waveform] : drive.waveforms) {
    const auto k = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    const Signal s = nominal.applied(k, nominal.commanded(k, waveform));
    const bool is_factor = name == dispersion_drive;
    Points& points = all[name];
    for (const auto& [t, v] : polyline(s, duration, 1e-3 * (s.maximum(duration) - s.minimum(duration)), 0))
      points.push_back({t, is_factor ? 1 + v : v});
  }
  return all;
}

// Returns the warnings of the nominal scene, and the reason why the last compared set of waveforms does not keep the nominal
// device closed.
std::vector<std::string> warnings(const RobustnessReport& report) {
  std::vector<std::string> all = report.nominal.scene.warnings;
  if (!report.unheld.empty()) all.push_back(report.unheld);
  if (!report.found.drives.empty()) {
    const DriveRobustness& last = report.found.drives.back();
    const std::vector<Signal> signals =
        until_command(report.nominal, report.nominal.applied(report.nominal.in_drive_order(last.waveforms)));
    if (std::string few = few_summits_warning(report.nominal.model, signals); !few.empty()) all.push_back(std::move(few));
  }
  return all;
}

RobustnessRecord::Drive drive_of(const RobustnessReport& report, const Ensemble& ensemble, const DriveRobustness& d) {
  const PreparedScene& nominal = report.nominal;
  RobustnessRecord::Drive drive{.name = d.name,
                                .closed_state = {},
                                .calibration = d.known.calibration(),
                                .classes = d.known.classes(),
                                .waveforms = waveforms_of(nominal, d, report.found.duration),
                                .closing = d.closing,
                                .collapsed = d.collapsed,
                                .bounce_free = d.bounce_free,
                                .figures = d.figures,
                                .failures = {},
                                .worst = {}};
  if (nominal.model.has_contact())
    drive.closed_state = closed_state(nominal, until_command(nominal, nominal.applied(nominal.in_drive_order(d.waveforms))));
  for (const std::size_t k : d.worst) drive.worst.push_back(device_of(ensemble, d, k));
  for (const DeviceOutcome& o : d.outcomes) {
    if (!o.closed()) ++drive.failures[o.failure.empty() ? std::string(to_string(o.metrics.status)) : o.failure];
  }
  return drive;
}

std::vector<RobustnessRecord::Varied> varied(const DeviceSpread& spread) {
  std::vector<RobustnessRecord::Varied> all;
  for (const SpreadVariable& v : spread.variables) {
    all.push_back({.name = v.name,
                   .keys = {},
                   .distribution = std::string(name_of(distribution_kinds, v.distribution.kind())),
                   .unit = v.keys.front().unit,
                   .is_factor = v.is_factor,
                   .mean = v.distribution.mean(),
                   .deviation = v.distribution.standard_deviation()});
    for (const VariedKey& key : v.keys) all.back().keys.push_back(key.name());
  }
  return all;
}

std::vector<RobustnessRecord::Sensitive> sensitive(const Sensitivity& sensitivity) {
  std::vector<RobustnessRecord::Sensitive> all;
  for (const FigureSensitivity& f : sensitivity.figures) {
    all.push_back({f.key, f.estimate.rows, f.estimate.failed_rows, {}});
    for (std::size_t i = 0; i < sensitivity.variables.size() && f.estimate.indices; ++i)
      all.back().variables[sensitivity.variables[i]] = {f.estimate.indices->first_order[i], f.estimate.indices->total[i]};
  }
  return all;
}

std::string about_prose(const RobustnessReport& report) {
  const Robustness& found = report.found;
  const DeviceSpread& spread = report.nominal.scene.spread;
  const Calibration calibration = found.drives.empty() ? Calibration{} : found.drives.back().known.calibration();
  return fmt::format(
      "{}{} under process variation ({} points): {}. {}{}{}", report.spread_assumed ? std::string(assumed_prose) + " " : "",
      internal::devices_text(found.devices), name_of(point_sets, report.options.points), internal::spread_prose(spread),
      calibration.is_empty()
          ? "All are driven with the voltages of the nominal design."
          : "The plain step has the voltages of the nominal design; every other drive is scaled by per-device calibration: " +
                internal::calibration_prose(calibration) + ".",
      internal::error_prose(spread), internal::outside_prose(found));
}

// Writes or reads the parts of the results that belong to one figure of merit each, in the order of `keys`.
template <class Part, class Keys>
void by_figure(internal::Archive& a, std::vector<Part>& parts, const Keys& keys, std::string_view about) {
  if (a.reads()) {
    for (const std::string_view key : keys) {
      if (internal::value_at(a.from(), key).is_object()) parts.emplace_back().key = key;
    }
  }
  for (Part& part : parts) a(part.key, part, about);
  if (a.lists()) a("FIGURE", Part{}, about);
}

}  // namespace

json internal::windows_json(const HoldWindows& windows) {
  json all = json::object();
  for (const auto& [electrode, window] : windows.of_electrodes)
    all[electrode] = std::isfinite(window.lower) ? json::array({window.lower, json_number(window.upper)}) : json();
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

namespace internal {

struct QuantileAt {
  double probability = Metrics::unset;
  EstimatedQuantile quantile;
};
void members(Archive& a, QuantileAt& one) {
  a("probability", one.probability, "probability of the quantile");
  softland::members(a, one.quantile);
}

}  // namespace internal

void members(internal::Archive& a, FigureStatistics& s) {
  a("mean", s.mean, "mean over the devices that have the figure");
  a("standard_deviation", s.standard_deviation, "standard deviation over these devices");
  a("skewness", s.skewness, "skewness over these devices");
  a("devices", s.devices, "number of these devices");
  std::vector<internal::QuantileAt> quantiles;
  for (std::size_t i = 0; !a.reads() && i < s.quantiles.size(); ++i)
    quantiles.push_back({robustness_quantiles[i], s.quantiles[i]});
  a("quantiles", quantiles, "quantiles over all devices");
  for (std::size_t i = 0; i < std::min(quantiles.size(), s.quantiles.size()); ++i) s.quantiles[i] = quantiles[i].quantile;
}

void members(internal::Archive& a, Calibration& c) {
  a("Vdp_error", internal::OrNull{c.pull_in_error}, "relative error of the measured Vdp of each device");
  a("frequency_error", internal::OrNull{c.frequency_error}, "relative error of the measured frequency");
  a("piezo_error", internal::OrNull{c.piezo_error}, "relative error of the measured deflection by the piezo");
  a("time_error_s", internal::OrNull{c.time_error}, "standard deviation of the error of a measured closing time");
  a("classes", internal::OrNull{c.classes}, "number of classes into which devices are sorted");
}

void members(internal::Archive& a, MeasuredUnits::Class& c) {
  a("volts_factor", c.centre.volts, "factor of the voltages of the class");
  a("time_factor", c.centre.time, "factor of its times");
  a("piezo_factor", c.centre.piezo, "factor of its piezo voltages");
  a("share", c.share, "share of the devices in the class");
}

void members(internal::Archive& a, RobustnessRecord::Varied& v) {
  a("name", v.name, "name of the varied quantity");
  a("keys", v.keys, "keys of the scene that vary with it");
  a("distribution", v.distribution, "kind of distribution");
  a("unit", v.unit, "unit of its first key; empty for a factor");
  a("is_factor", v.is_factor, "whether it multiplies the value of the scene");
  a("mean", v.mean, "mean");
  a("standard_deviation", v.deviation, "standard deviation");
}

void members(internal::Archive& a, RobustnessRecord::Device& device) {
  a("device", device.number, "number of the device");
  a("values", device.values, "its varied quantities [SI unit, or factor]");
  a("status", device.status, "outcome of its closing");
  a("figures", device.figures, "its figures, by key");
  if (a.has(!device.failure.empty())) a("failure", device.failure, "why the device was not simulated to the end");
}

void members(internal::Archive& a, RobustnessRecord::Drive& d) {
  a("name", d.name, "name of the set of waveforms");
  a("closed_state", internal::OrNull{d.closed_state}, "closed equilibrium of the nominal design");
  a("calibration", d.calibration, "measurements that scale the waveforms of each device; null: not measured");
  a("classes", d.classes, "classes into which devices are sorted");
  a("waveforms", d.waveforms, "waveform of each drive: time [s], level [V]");
  a("closing", d.closing, "devices that close and stay closed");
  a("collapsed_onto_electrode", d.collapsed, "devices that collapse onto the electrode");
  a("bounce_free", d.bounce_free, "devices that close without a significant rebound");
  a.object(
      "figures",
      [&](auto& figures) {
        for (const Figure& f : device_figures) {
          if (a.lists() || !figures.has(f.asked == nullptr || d.figures[f].devices > 0)) continue;
          figures(f.key, d.figures[f], "statistics of the figure");
        }
        if (a.lists()) figures("FIGURE", FigureStatistics{}, "statistics of the figure");
      },
      "figures over the devices");
  a("failures", d.failures, "number of devices that do not close, by reason");
  a("worst", d.worst, "worst devices");
}

void members(internal::Archive& a, SobolIndex& index) {
  a("value", index.value, "the index");
  a.pair("interval", index.interval.low, index.interval.high, "confidence interval of the index");
  a("above_zero", index.above_zero, "whether the interval is above zero");
}

void members(internal::Archive& a, RobustnessRecord::Sensitive::Indices& indices) {
  a("first_order", indices.first_order, "Sobol' index of first order");
  a("total", indices.total, "total Sobol' index");
}

void members(internal::Archive& a, RobustnessRecord::Sensitive& s) {
  a("rows", s.rows, "number of rows of the estimate");
  a("failed_rows", s.failed_rows, "number of rows with a failed simulation");
  a("variables", s.variables, "indices by varied quantity");
}

void members(internal::Archive& a, RobustnessRecord::Derived::Variable& v) {
  a("nominal", v.nominal, "value of the nominal design");
  a("standard_deviation", v.deviation, "standard deviation over the devices");
  if (a.has(!v.why_none.empty())) a("why_none", v.why_none, "why there is no derivative by it");
}

void members(internal::Archive& a, RobustnessRecord::Derived::Slope& slope) {
  a("derivative", slope.derivative, "derivative of the figure [SI units]");
  a("relative", slope.relative, "relative change of the figure divided by that of the quantity");
  a("per_standard_deviation", slope.step, "change of the figure for one standard deviation of the quantity");
}

void members(internal::Archive& a, RobustnessRecord::Derived::Of& figure) {
  a("nominal", figure.nominal, "figure of the nominal design");
  a("by", figure.by, "derivatives by varied quantity");
  a("standard_deviation", figure.deviation, "standard deviation that the derivatives predict");
  a("error", figure.error, "error of the derivatives");
  a("agrees_with_devices", figure.agrees, "whether the figure varies as much over the devices, or that is unknown");
  if (a.has(!figure.why_none.empty())) a("why_none", figure.why_none, "why there is no derivative");
}

void members(internal::Archive& a, RobustnessRecord::Derived& d) {
  a("drive", d.drive, "set of waveforms");
  a("grazes", d.grazes, "whether a touch nearly appears or disappears, so that derivatives hold for small changes only");
  a("slowest_crossing", d.grazing, "smallest speed through the contact plane, as a share of that at first contact");
  a("variables", d.variables, "varied quantities");
  a.object(
      "figures",
      [&](auto& figures) {
        std::vector<std::string_view> keys;
        for (const Figure& f : device_figures) keys.push_back(f.key);
        by_figure(figures, d.figures, keys, "derivatives of the figure");
      },
      "derivatives of figures");
  if (a.has(!d.why_none.empty())) a("why_none", d.why_none, "why there are no derivatives");
}

void members(internal::Archive& a, RobustnessRecord::BoxAndChaosRecord::InBox& device) {
  a("value", device.figure, "the figure");
  a("values", device.values, "varied quantities of the device [SI unit, or factor]");
  a("status", device.status, "outcome of its closing");
  if (a.has(!device.failure.empty())) a("failure", device.failure, "why the device was not simulated to the end");
}

void members(internal::Archive& a, RobustnessRecord::BoxAndChaosRecord::Range& range) {
  a("least", range.least, "device with the least figure in the box");
  a("most", range.most, "device with the largest figure in the box");
  a.pair("sampled", range.of_sample.low, range.of_sample.high, "least and largest figure of the sampled devices inside");
}

void members(internal::Archive& a, FigureChaos& c) {
  a("devices", c.fitted, "number of devices to which the polynomials are fitted");
  a("other_devices", c.unseen, "number of devices on which they are tested");
  a("degree", c.degree, "degree of the polynomials");
  a("terms", c.terms, "number of terms");
  a("q2_cross_validated", c.q2, "share of the variance that they predict, by cross-validation");
  a("q2_other_devices", c.q2_unseen, "the same on the other devices");
  a("mean", c.mean, "mean of the figure");
  a("standard_deviation", c.standard_deviation, "standard deviation of the figure");
  a("quantile_95", c.quantile_95, "95th percentile of the figure");
}

void members(internal::Archive& a, RobustnessRecord::BoxAndChaosRecord& ways) {
  a("drive", ways.drive, "set of waveforms");
  a.object(
      "box",
      [&](auto& box) {
        box("share_of_devices", ways.share, "share of devices inside the box");
        box("half_width_standard_deviations", ways.half_width, "half width of the box in standard deviations");
        box("sampled_devices_inside", ways.sampled_inside, "number of sampled devices inside");
        box("closings", ways.closings, "number of closings of the searches");
        box.object(
            "figures",
            [&](auto& figures) { by_figure(figures, ways.ranges, explained_figures, "range of the figure in the box"); },
            "range of each figure");
      },
      "worst cases in a box of the varied quantities");
  a("devices_left_out", ways.left_out, "number of devices without the figures");
  a.object(
      "polynomial_chaos", [&](auto& chaos) { by_figure(chaos, ways.chaos, explained_figures, "polynomials for the figure"); },
      "polynomials in the varied quantities, by figure");
  if (a.has(!ways.why_none.empty())) a("why_none", ways.why_none, "why there are no such results");
}

void members(internal::Archive& a, RobustnessRecord& r) {
  members(a, r.origin);
  a("status", internal::Stopped{r.interrupted}, "`done` or `interrupted`");
  a("devices", r.devices, "number of simulated devices");
  a("seed", r.seed, "seed of the devices");
  a("points", internal::Chosen{r.points, point_sets}, "point set of the devices");
  a("duration_s", r.duration, "simulated time");
  a("tolerance", r.tolerance, "relative tolerance of the integrator");
  a("about", r.about, "the devices in words");
  a("spread", r.spread, "varied quantities");
  a("spread_assumed", r.spread_assumed, "whether the scene has no [spread] and the usual one was assumed");
  a.custom("hold_window_V", r.windows, internal::windows_json, internal::read_windows,
           internal::Like<std::map<std::string, std::array<double, 2>>>{
               "by electrode, hold voltages between which the devices stay closed"});
  a("hold_window_devices", r.windows.devices, "number of devices in the hold window");
  a("drives", r.drives, "results by set of waveforms, the plain step first");
  a("by_knowledge", r.by_knowledge, "results of the last set with other measurements");
  a.object(
      "sensitivity",
      [&](auto& sensitivity) {
        sensitivity.object(
            "figures", [&](auto& figures) { by_figure(figures, r.sensitivity, explained_figures, "indices of the figure"); },
            "indices by figure");
        if (sensitivity.has(!r.why_no_sensitivity.empty()))
          sensitivity("why_none", r.why_no_sensitivity, "why there are no indices");
      },
      "Sobol' indices");
  a("derivatives", r.derivatives, "derivatives of the last set of waveforms");
  a("other_ways", internal::OrNull{r.box_and_chaos}, "worst cases and polynomial chaos, with `--other-ways`");
  a("warnings", r.warnings, "warnings");
}

void add_details(RobustnessReport& report, bool other_ways_too, const Progress& progress) {
  if (report.found.interrupted || report.found.devices == 0) return;
  // The confidence intervals of the indices from fewer rows span most of 0 to 100 %.
  constexpr std::uint64_t devices_per_row = 4, fewest_rows = 32, most_rows = 1024;
  const DriveRobustness& last = report.found.drives.back();
  const std::uint64_t rows = std::min<std::uint64_t>(report.options.samples / devices_per_row, most_rows);
  if (rows < fewest_rows) {
    report.sensitivity.why_none = fmt::format(
        "with fewer than {} devices their confidence intervals are too wide to say anything", devices_per_row * fewest_rows);
  } else {
    report.sensitivity = sensitivity(report.nominal, last, rows, report.options, progress);
  }
  report.derivatives = derivatives(report.nominal, internal::exactly_measured(report.nominal, last), {}, progress);
  report.windows = hold_windows(report.nominal, report.options, progress);
  if (report.nominal.model.has_contact()) {
    const std::vector<Signal> signals =
        until_command(report.nominal, report.nominal.applied(report.nominal.in_drive_order(last.waveforms)));
    report.unheld = hold_warning(report.nominal.model, signals, closed_state(report.nominal, signals));
  }
  report.courses = device_courses(report.nominal, last, report.found, report.options);
  if (other_ways_too) report.box_and_chaos = box_and_chaos(report.nominal, last, report.options, {}, progress);
  report.interrupted = progress.stopped();
}

RobustnessRecord record_of(const RobustnessReport& report) {
  const auto& [nominal, found, options, command, spread_assumed, sensitivity, derivatives, courses, ways, windows, unheld,
               interrupted] = report;
  RobustnessRecord record{.origin = whole_origin_of("robustness", nominal, command),
                          .interrupted = interrupted,
                          .spread_assumed = spread_assumed,
                          .devices = found.devices,
                          .seed = options.seed,
                          .points = options.points,
                          .duration = found.duration,
                          .tolerance = found.tolerance,
                          .about = {about_prose(report)},
                          .spread = varied(nominal.scene.spread),
                          .windows = windows,
                          .drives = {},
                          .by_knowledge = {},
                          .sensitivity = sensitive(sensitivity),
                          .why_no_sensitivity = sensitivity.why_none,
                          .derivatives = internal::record_of(derivatives, found.drives.back()),
                          .box_and_chaos = {},
                          .warnings = warnings(report)};
  if (found.interrupted) record.about.emplace_back("Interrupted: the devices are incomplete.");
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  for (const DriveRobustness& d : found.drives) record.drives.push_back(drive_of(report, ensemble, d));
  for (const DriveRobustness& d : found.by_knowledge) record.by_knowledge.push_back(drive_of(report, ensemble, d));
  if (ways) record.box_and_chaos = internal::record_of(*ways, found.drives.back(), nominal);
  return record;
}

json json_of(const RobustnessRecord& record) { return internal::record_json(record); }

// Null in JSON stands for any non-finite number: figures of merit over the box of varied quantities become infinite, as for a
// device that does not close.
RobustnessRecord read_robustness(const json& from) {
  RobustnessRecord record = internal::whole_record<RobustnessRecord>(from);
  require(!record.drives.empty(), "\"drives\" is empty");
  if (!record.box_and_chaos) return record;
  RobustnessRecord::BoxAndChaosRecord& ways = *record.box_and_chaos;
  require(ways.chaos.size() == ways.ranges.size(), "\"polynomial_chaos\" has other figures than \"box\"");
  const auto set_infinite = [](double& value) {
    if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
  };
  for (RobustnessRecord::BoxAndChaosRecord::Range& range : ways.ranges) {
    for (RobustnessRecord::BoxAndChaosRecord::InBox* device : {&range.least, &range.most}) {
      if (!device->values.empty()) set_infinite(device->figure);
    }
    if (ways.sampled_inside > 0) set_infinite(range.of_sample.low), set_infinite(range.of_sample.high);
  }
  return record;
}

std::string robustness_csv(const RobustnessReport& report) {
  const auto& [nominal, found, options, command, spread_assumed, sensitivity, derivatives, courses, ways, windows, unheld,
               interrupted] = report;
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  std::string text = "device";
  // The name of a set of waveforms may have commas and quotes, which a CSV cell must escape.
  const auto cell = [](const std::string& name) {
    std::string quoted = "\"";
    for (const char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return name.find_first_of(",\"\n") == std::string::npos ? name : quoted + "\"";
  };
  const std::vector<Figure> figures = asked_among(device_figures, nominal.scene.metrics.asked);
  for (const SpreadVariable& v : nominal.scene.spread.variables) text += "," + cell(v.name);
  for (const DriveRobustness& d : found.drives) {
    text += "," + cell(d.name + ": status");
    for (const Figure& f : figures) text += "," + cell(fmt::format("{}: {}", d.name, f.key));
  }
  text += "\n";
  for (std::size_t k = 0; k < found.devices; ++k) {
    text += std::to_string(k);
    for (const double value : shown_values(ensemble, k)) text += fmt::format(",{}", value);
    for (const DriveRobustness& d : found.drives) {
      const DeviceOutcome& o = d.outcomes[k];
      text += fmt::format(",{}", o.failure.empty() ? std::string(to_string(o.metrics.status)) : cell(o.failure));
      for (const Figure& f : figures) {
        const double value = o.of(f);
        text += std::isfinite(value) ? fmt::format(",{}", value) : std::string(",");
      }
    }
    text += "\n";
  }
  return text;
}

}  // namespace softland
