#include "reports/robustness_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "reports/escape.h"
#include "reports/estimates.h"
#include "reports/json_number.h"
#include "reports/made_with.h"
#include "reports/other_ways_report.h"
#include "reports/page.h"
#include "reports/quantity.h"
#include "reports/text.h"
#include "sampling/statistics.h"
#include "version.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using internal::interval_json;
using internal::json_number;
using internal::percent;
using internal::quantile_text;
using internal::quantity;
using internal::yield_json;
using internal::yield_text;
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
  for (const EnsembleFigure& f : ensemble_figures()) all[std::string(f.key)] = json_number(f.value(outcome));
  return all;
}

// Of the varying quantities of device k.
std::vector<double> shown_values(const Ensemble& ensemble, std::size_t k) {
  return DeviceDrives(ensemble.nominal()).shown(ensemble.values(k));
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

std::string_view error_words(const DeviceSpread& spread) {
  return spread.varies_drives() ? " The sources of the drives err as the spread says." : "";
}

// "Vdp ± 1 %, frequency ± 0.5 %"
std::string calibration_words(const Calibration& c) {
  std::string words;
  const auto add = [&](std::string_view name, const std::optional<double>& error) {
    if (!error) return;
    words += (words.empty() ? "" : ", ") + std::string(name) + (*error > 0 ? " ± " + percent(*error) : " exactly");
  };
  add(measured_pull_in, c.pull_in_error);
  add(measured_frequency, c.frequency_error);
  return c.classes ? fmt::format("{}, {} classes", words, *c.classes) : words;
}

bool is_erring(const Calibration& c) { return c.pull_in_error.value_or(0) > 0 || c.frequency_error.value_or(0) > 0; }

const EstimatedQuantile& quantile_95(const DriveRobustness& drive, std::string_view key) {
  return drive.figures[static_cast<std::size_t>(&ensemble_figure(key) - ensemble_figures().data())].quantiles[2];
}

json calibration_json(const Calibration& c) {
  const auto error = [](const std::optional<double>& of) { return of ? json(*of) : json(nullptr); };
  return {{"Vdp_error", error(c.pull_in_error)},
          {"frequency_error", error(c.frequency_error)},
          {"classes", c.classes ? json(*c.classes) : json(nullptr)}};
}

json classes_json(const std::vector<KnownUnits::Class>& classes) {
  json all = json::array();
  for (const KnownUnits::Class& c : classes)
    all.push_back({{"volts_factor", c.centre.volts}, {"time_factor", c.centre.time}, {"share", c.share}});
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

// "62 % (55 to 69)"
std::string index_text(const SobolIndex& index) {
  if (!std::isfinite(index.value)) return "—";
  return fmt::format("{:.0f} % ({:.0f} to {:.0f})", 100 * index.value + 0.0, 100 * index.interval.low, 100 * index.interval.high);
}

// Where the spread of the last drive comes from.
std::string sensitivity_text(const Sensitivity& sensitivity) {
  if (sensitivity.figures.empty()) return {};
  std::string text = fmt::format("\n{:<34}", "Share of the variance, alone / in all");
  for (const FigureSensitivity& f : sensitivity.figures)
    text += internal::right_aligned(std::string(ensemble_figure(f.key).symbol), 18);
  text += "\n";
  for (std::size_t i = 0; i < sensitivity.variables.size(); ++i) {
    text += internal::left_aligned(sensitivity.variables[i], 37);
    for (const FigureSensitivity& f : sensitivity.figures) {
      text += internal::right_aligned(f.estimate.indices ? percent(std::max(0.0, f.estimate.indices->first_order[i].value)) +
                                                               " / " + percent(f.estimate.indices->total[i].value)
                                                         : std::string("too many fail"),
                                      18);
    }
    text += "\n";
  }
  return text;
}

// What each measurement is worth: the last drive with more and more known of the devices.
std::string knowledge_text(const Robustness& found) {
  if (found.by_knowledge.empty() || found.devices == 0) return {};
  const Calibration& c = found.drives.back().known.calibration();
  const std::string own = calibration_words(c);
  const std::size_t width = std::max<std::size_t>(34, internal::columns_of(own) + 2);
  std::string text = "\n" + internal::left_aligned("Known of every device", width) +
                     fmt::format("{:>24}{:>26}{:>26}\n", "without a rebound", "v_max, 95 % below", "B_H, 95 % below");
  const auto row = [&](const std::string& name, const DriveRobustness& d) {
    text += internal::left_aligned(name, width) + internal::right_aligned(yield_text(d.bounce_free), 24) +
            internal::right_aligned(quantile_text(quantile_95(d, "largest_impact_velocity_m_s"), "m/s"), 26) +
            internal::right_aligned(quantile_text(quantile_95(d, "major_bounce_height_m"), "m"), 26) + "\n";
  };
  for (const DriveRobustness& d : found.by_knowledge) row(d.name, d);
  if (is_erring(c)) row(own, found.drives.back());
  return text;
}

}  // namespace

json robustness_json(const RobustnessReport& report) {
  const auto& [nominal, found, options, command, sensitivity, courses, ways, interrupted] = report;
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  const auto drive_json = [&](const DriveRobustness& d) {
    json figures = json::object(), worst = json::array(), failures = json::object();
    for (std::size_t i = 0; i < d.figures.size(); ++i)
      figures[std::string(ensemble_figures()[i].key)] = statistics_json(d.figures[i]);
    for (const std::size_t k : d.worst) worst.push_back(device_json(ensemble, d, k));
    std::map<std::string, std::size_t> reasons;
    for (const DeviceOutcome& o : d.outcomes) {
      if (!o.closed()) ++reasons[o.failure.empty() ? std::string(to_string(o.metrics.status)) : o.failure];
    }
    for (const auto& [why, count] : reasons) failures[why] = count;
    return json{{"name", d.name},
                {"calibration", calibration_json(d.known.calibration())},
                {"classes", classes_json(d.known.classes())},
                {"waveforms", waveforms_json(d, found.duration)},
                {"closing", yield_json(d.closing)},
                {"bounce_free", yield_json(d.bounce_free)},
                {"figures", std::move(figures)},
                {"failures", std::move(failures)},
                {"worst", std::move(worst)}};
  };
  json drives = json::array(), by_knowledge = json::array();
  for (const DriveRobustness& d : found.drives) drives.push_back(drive_json(d));
  for (const DriveRobustness& d : found.by_knowledge) by_knowledge.push_back(drive_json(d));
  const SceneFile scene = resolved(nominal.scene, nominal.voltage_units());
  return {{"kind", "robustness"},
          {"status", interrupted ? "interrupted" : "done"},
          {"devices", found.devices},
          {"seed", options.seed},
          {"points", name_of(point_sets, options.points)},
          {"duration_s", found.duration},
          {"tolerance", found.tolerance},
          {"spread", spread_json(nominal.scene.spread)},
          {"drives", std::move(drives)},
          {"by_knowledge", std::move(by_knowledge)},
          {"sensitivity", sensitivity_json(sensitivity)},
          {"other_ways", ways ? internal::other_ways_json(*ways, found.drives.back(), nominal) : json(nullptr)},
          {"warnings", nominal.scene.warnings},
          {"scene", scene.json()},
          {"scene_toml", scene.text()},
          {"version", version},
          {"made_with", made_with_json()},
          {"command", command}};
}

std::string robustness_text(const RobustnessReport& report) {
  const auto& [nominal, found, options, command, sensitivity, courses, ways, interrupted] = report;
  std::string text;
  if (found.interrupted) text += "Interrupted: these are not all devices.\n\n";
  const Calibration& calibration = found.drives.empty() ? Calibration{} : found.drives.back().known.calibration();
  text += wrapped(fmt::format("{} devices of the spread: {}. {}{}", found.devices, spread_words(nominal.scene.spread),
                              calibration.is_empty()
                                  ? "All have the volts that were designed for the nominal device."
                                  : "The plain step has the volts of the nominal device, every other drive the units of each "
                                    "device, known of it: " +
                                        calibration_words(calibration) + ".",
                              error_words(nominal.scene.spread))) +
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
  text += knowledge_text(found) + sensitivity_text(sensitivity);
  if (ways) text += internal::other_ways_text(*ways, found.drives.back(), nominal);
  text += "\n" +
          wrapped(fmt::format("In brackets: 95 % confidence. Seed {}, {} points, window {}, integrator tolerance {}. A device "
                              "that does not close counts as the worst.",
                              options.seed, name_of(point_sets, options.points), quantity(found.duration, "s", 4),
                              internal::scientific(found.tolerance))) +
          "\n";
  for (const std::string& warning : nominal.scene.warnings) text += "\n" + wrapped("warning: " + warning) + "\n";
  return text;
}

std::string robustness_csv(const RobustnessReport& report) {
  const auto& [nominal, found, options, command, sensitivity, courses, ways, interrupted] = report;
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
    for (const double value : shown_values(ensemble, k)) text += fmt::format(",{}", value);
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

// ---- the page

namespace {

using internal::Cell;
using internal::escaped;
using internal::section;
using internal::symbol_html;
using internal::table_html;
using internal::TableRow;

constexpr std::array drawn_figures{std::string_view("largest_impact_velocity_m_s"), std::string_view("major_bounce_height_m"),
                                   std::string_view("initial_contact_time_s")};

std::string lower_case(std::string_view name) {
  std::string words(name);
  words[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(words[0])));
  return words;
}

std::string label_html(const EnsembleFigure& f) {
  const bool has_index = f.symbol.find('_') != std::string_view::npos;
  return std::string(f.name) + (has_index ? ", " + symbol_html(f.symbol) : "");
}

// Softland's pen for the last drive, that of the baseline for the plain step, others between.
internal::Role role_of(std::size_t i, std::size_t count) {
  if (i + 1 == count && i > 0) return internal::Role::best;
  if (i == 0) return internal::Role::baseline;
  constexpr std::array others{internal::Role::third, internal::Role::fourth, internal::Role::fifth};
  return others[(i - 1) % others.size()];
}

internal::Chart distribution_chart(const RobustnessReport& report, std::string_view key, internal::CurveTables& tables) {
  const EnsembleFigure& f = ensemble_figure(key);
  const std::vector<DriveRobustness>& drives = report.found.drives;
  internal::Chart chart{.id = "share-" + std::string(f.symbol),
                        .title = std::string(f.name),
                        .caption = fmt::format("Share of the devices whose {} is at most this.",
                                               f.key == "initial_contact_time_s" ? "first contact" : lower_case(f.name)),
                        .x_column = "x",
                        .x_label = std::string(f.name),
                        .x_unit = std::string(f.unit),
                        .y_label = "Devices",
                        .y_unit = "%",
                        .y_home = std::array{0.0, 100.0},
                        .height = 260};
  std::replace(chart.id.begin(), chart.id.end(), '_', '-');
  double most = 0;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    std::vector<double> values;
    for (const DeviceOutcome& o : drives[i].outcomes) {
      if (const double value = f.value(o); std::isfinite(value)) values.push_back(value);
    }
    if (values.empty()) continue;
    std::sort(values.begin(), values.end());
    const std::string name = fmt::format("{}-{}", chart.id, i);
    internal::CurveTable& table = tables[name];
    const double all = static_cast<double>(drives[i].outcomes.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      table["x"].push_back(values[k]);
      table["y"].push_back(100 * static_cast<double>(k + 1) / all);
    }
    // Seen as far as all but a few of any drive go.
    most = std::max(most, values[std::min(values.size() - 1, values.size() * 99 / 100)]);
    chart.series.push_back({.table = name, .column = "y", .label = drives[i].name, .role = role_of(i, drives.size())});
    chart.x_whole[1] = std::max(chart.x_whole[1] == 1 ? 0.0 : chart.x_whole[1], values.back());
  }
  chart.x_whole[0] = 0;
  chart.x_home = {0, most > 0 ? most : 1};
  chart.x_whole[1] = std::max(chart.x_whole[1], chart.x_home[1]);
  return chart;
}

// How many devices have which value, in bins that all drives share, as far as the cumulative curves are shown: two kinds of
// closings are two heaps.
internal::Chart histogram_chart(const RobustnessReport& report, std::string_view key, const internal::Chart& cumulative,
                                internal::CurveTables& tables) {
  const EnsembleFigure& f = ensemble_figure(key);
  const std::vector<DriveRobustness>& drives = report.found.drives;
  internal::Chart chart = cumulative;
  chart.id = "count" + cumulative.id.substr(cumulative.id.find('-'));
  chart.title = fmt::format("{}: histogram", f.name);
  chart.height = 150;
  chart.y_home.reset();
  chart.x_whole = chart.x_home;
  chart.series.clear();
  std::vector<std::vector<double>> values(drives.size());
  std::vector<double> all;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    for (const DeviceOutcome& o : drives[i].outcomes) {
      if (const double value = f.value(o); value <= chart.x_home[1]) values[i].push_back(value);
    }
    all.insert(all.end(), values[i].begin(), values[i].end());
  }
  if (all.empty()) return chart;
  constexpr std::size_t most_bins = 80;
  const Histogram bins = histogram(all, most_bins);
  const double width = (bins.high - bins.low) / static_cast<double>(bins.counts.size());
  if (!(width > 0)) return chart;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    std::vector<std::size_t> counts(bins.counts.size(), 0);
    for (const double value : values[i])
      ++counts[std::min(counts.size() - 1, static_cast<std::size_t>((value - bins.low) / width))];
    const std::string name = fmt::format("{}-{}", chart.id, i);
    internal::CurveTable& table = tables[name];
    const auto point = [&](std::size_t edge, double share) {
      table["x"].push_back(bins.low + static_cast<double>(edge) * width);
      table["y"].push_back(share);
    };
    point(0, 0);
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const double share = 100 * static_cast<double>(counts[k]) / static_cast<double>(drives[i].outcomes.size());
      point(k, share);
      point(k + 1, share);
    }
    point(counts.size(), 0);
    chart.series.push_back({.table = name, .column = "y", .label = drives[i].name, .role = role_of(i, drives.size())});
  }
  chart.caption = fmt::format("Share of the devices in each interval of {}.", quantity(width, f.unit));
  return chart;
}

internal::Chart course_chart(const RobustnessReport& report, internal::CurveTables& tables) {
  internal::Chart chart{
      .id = "courses",
      .title = "Typical closings",
      .caption = fmt::format("Gap of the devices whose highest rebound is the 5, 50 and 95 % quantile under {}.",
                             report.found.drives.back().name),
      .x_column = "time_s",
      .x_label = "Time",
      .x_unit = "s",
      .y_label = "Gap",
      .y_unit = "m",
      .zero_line = true,
      .zero_label = "contact",
      .height = 260};
  constexpr std::array roles{internal::Role::third, internal::Role::best, internal::Role::baseline};
  double touch = 0;
  for (std::size_t i = 0; i < report.courses.size(); ++i) {
    const DeviceCourse& course = report.courses[i];
    const std::string name = fmt::format("course-{}", i);
    const ResultCurve curve = curve_of(course.trajectory, report.nominal.scene.metrics);
    if (curve.time.size() < 2) continue;
    tables[name] = {{"time_s", curve.time}, {"gap", curve.gap}};
    if (!course.trajectory.touches.empty()) touch = std::max(touch, course.trajectory.touches.front().begin);
    chart.series.push_back({.table = name,
                            .column = "gap",
                            .label = fmt::format("{:g} %: device {}", 100 * course.probability, course.device),
                            .role = roles[i % roles.size()]});
  }
  chart.x_whole = {0, report.found.duration};
  chart.x_home = {0, touch > 0 ? std::min(report.found.duration, 2.5 * touch) : report.found.duration};
  return chart;
}

internal::Picture picture_of(const RobustnessReport& report) {
  internal::Picture drawn;
  for (const std::string_view key : drawn_figures) {
    drawn.charts.push_back(distribution_chart(report, key, drawn.tables));
    if (!drawn.charts.back().series.empty())
      drawn.charts.push_back(histogram_chart(report, key, internal::Chart(drawn.charts.back()), drawn.tables));
  }
  std::erase_if(drawn.charts, [](const internal::Chart& chart) { return chart.series.empty(); });
  if (!report.courses.empty()) drawn.charts.push_back(course_chart(report, drawn.tables));
  return drawn;
}

std::string statistics_table(const Robustness& found) {
  TableRow head{"Over the devices"};
  for (const DriveRobustness& d : found.drives) head.emplace_back(escaped(d.name));
  std::vector<TableRow> rows;
  const auto add = [&](const std::string& name, const auto& cell) {
    TableRow& row = rows.emplace_back(TableRow{name});
    for (const DriveRobustness& d : found.drives) row.emplace_back(cell(d), &d == &found.drives.back() ? "own" : "");
  };
  add("Devices that close", [](const DriveRobustness& d) { return yield_text(d.closing); });
  add("Without a rebound", [](const DriveRobustness& d) { return yield_text(d.bounce_free); });
  for (std::size_t i = 0; i < ensemble_figures().size(); ++i) {
    const EnsembleFigure& f = ensemble_figures()[i];
    for (const std::size_t q : {std::size_t{1}, std::size_t{2}}) {
      add(label_html(f) + (q == 1 ? ": median" : ": 95 % below"),
          [&](const DriveRobustness& d) { return quantile_text(d.figures[i].quantiles[q], f.unit); });
    }
  }
  return table_html(head, rows) + "<p class=\"below\">In brackets: 95 % confidence.</p>\n";
}

std::string knowledge_table(const Robustness& found) {
  if (found.by_knowledge.empty()) return {};
  std::vector<TableRow> rows;
  const auto add = [&](const std::string& name, const DriveRobustness& d) {
    rows.push_back({name, yield_text(d.bounce_free), quantile_text(quantile_95(d, "largest_impact_velocity_m_s"), "m/s"),
                    quantile_text(quantile_95(d, "major_bounce_height_m"), "m")});
  };
  for (const DriveRobustness& d : found.by_knowledge) add(escaped(d.name), d);
  const Calibration& c = found.drives.back().known.calibration();
  if (is_erring(c)) add(calibration_words(c), found.drives.back());
  return section("knowledge", "What measuring a device is worth",
                 table_html({"Known of every device", "Without a rebound", "Largest impact speed, 95 % below",
                             "Highest rebound, 95 % below"},
                            rows));
}

std::string sensitivity_table(const Sensitivity& sensitivity) {
  if (sensitivity.figures.empty()) return {};
  TableRow head{"Varies"};
  for (const FigureSensitivity& f : sensitivity.figures) {
    const std::string symbol = symbol_html(ensemble_figure(f.key).symbol);
    head.emplace_back(symbol + ", alone");
    head.emplace_back(symbol + ", in all");
  }
  std::vector<TableRow> rows;
  for (std::size_t i = 0; i < sensitivity.variables.size(); ++i) {
    TableRow& row = rows.emplace_back(TableRow{escaped(sensitivity.variables[i])});
    for (const FigureSensitivity& f : sensitivity.figures) {
      if (!f.estimate.indices) {
        row.emplace_back("too many devices fail", "missing", 2);
        continue;
      }
      row.emplace_back(index_text(f.estimate.indices->first_order[i]));
      row.emplace_back(index_text(f.estimate.indices->total[i]));
    }
  }
  return section(
      "sensitivity", "Where the spread comes from",
      table_html(head, rows) +
          fmt::format("<p class=\"below\">Sobol' indices under the last drive, {} rows: the share of a figure's variance "
                      "that would be gone if the quantity were known (alone), and the share in which it has a part (in "
                      "all). Where rebounds set in at once, variances say less than quantiles.</p>\n",
                      sensitivity.figures.front().estimate.rows));
}

std::string worst_table(const RobustnessReport& report) {
  const DriveRobustness& last = report.found.drives.back();
  const Ensemble ensemble(report.nominal, report.options.samples, report.options.seed, report.options.points);
  const std::vector<SpreadVariable>& variables = report.nominal.scene.spread.variables;
  TableRow head{"Device"};
  for (const SpreadVariable& v : variables) head.emplace_back(escaped(v.name));
  head.insert(head.end(), {"Highest rebound", "Largest impact speed", "First contact"});
  std::vector<TableRow> rows;
  for (const std::size_t k : last.worst) {
    TableRow& row = rows.emplace_back(TableRow{fmt::format("{}", k)});
    const std::vector<double> values = shown_values(ensemble, k);
    for (std::size_t i = 0; i < values.size(); ++i)
      row.emplace_back(variables[i].is_factor ? fmt::format("× {:.4f}", values[i])
                                              : quantity(values[i], variables[i].keys.front().unit, 5));
    const DeviceOutcome& o = last.outcomes[k];
    if (!o.closed()) {
      row.emplace_back(escaped(o.failure.empty() ? std::string(to_string(o.metrics.status)) : o.failure), "missing", 3);
      continue;
    }
    for (const std::string_view key : {drawn_figures[1], drawn_figures[0], drawn_figures[2]})
      row.emplace_back(quantity(ensemble_figure(key).value(o), ensemble_figure(key).unit));
  }
  return rows.empty() ? std::string()
                      : section("worst", "The worst devices",
                                table_html(head, rows) + fmt::format("<p class=\"below\">Under {}.</p>\n", escaped(last.name)));
}

std::pair<std::string, std::string> headline_of(const Robustness& found) {
  const DriveRobustness &step = found.drives.front(), &own = found.drives.back();
  const auto words = [&](const DriveRobustness& d) {
    return fmt::format("{} of {} devices close without a rebound, and 95 % touch at no more than {} and rise no more than {}",
                       percent(d.bounce_free.value), found.devices, quantity(quantile_95(d, drawn_figures[0]).value, "m/s"),
                       quantity(quantile_95(d, drawn_figures[1]).value, "m"));
  };
  if (found.drives.size() == 1) return {"Under the plain step " + words(step) + ".", ""};
  return {words(own), fmt::format("; under the plain step it is {}, {} and {}.", percent(step.bounce_free.value),
                                  quantity(quantile_95(step, drawn_figures[0]).value, "m/s"),
                                  quantity(quantile_95(step, drawn_figures[1]).value, "m"))};
}

std::string keys_of(const Robustness& found) {
  const DriveRobustness &step = found.drives.front(), &own = found.drives.back();
  const auto before = [&](const std::string& value) { return found.drives.size() > 1 ? "plain step " + value : std::string(); };
  std::string keys =
      internal::key_html("Without a rebound", percent(own.bounce_free.value), before(percent(step.bounce_free.value)));
  for (const std::string_view key : drawn_figures) {
    const EnsembleFigure& f = ensemble_figure(key);
    const auto value = [&](const DriveRobustness& d) {
      const double q = quantile_95(d, key).value;
      return std::isfinite(q) ? quantity(q, f.unit) : std::string("not closed");
    };
    keys += internal::key_html(label_html(f) + ", 95\u00a0%", value(own), before(value(step)));
  }
  return keys;
}

}  // namespace

std::string robustness_html(const RobustnessReport& report) {
  const auto& [nominal, found, options, command, sensitivity, courses, ways, interrupted] = report;
  const internal::Picture drawn = picture_of(report);
  std::string charts;
  for (const internal::Chart& chart : drawn.charts) charts += internal::figure_html(drawn.tables, chart);
  Result result{.command = command, .version = std::string(version), .made_with = made_with()};
  result.seed = options.seed;
  result.tolerance = found.tolerance;
  result.scene.text = resolved(nominal.scene, nominal.voltage_units()).text();
  const auto [main, rest] = headline_of(found);
  const Calibration& calibration = found.drives.back().known.calibration();
  std::string about = fmt::format(
      "<p>{} devices of the spread ({} points): {}. {}{}</p>\n", found.devices, name_of(point_sets, options.points),
      escaped(spread_words(nominal.scene.spread)),
      calibration.is_empty() ? "All have the volts that were designed for the nominal device."
                             : "The plain step has the volts of the nominal device; every other drive is in the units of each "
                               "device, known of it: " +
                                   calibration_words(calibration) + ".",
      error_words(nominal.scene.spread));
  if (found.interrupted) about += "<p>Interrupted: these are not all devices.</p>\n";
  return internal::page({.title = nominal.scene.title,
                         .origin = "robustness",
                         .headline = main,
                         .headline_rest = rest,
                         .keys = keys_of(found),
                         .body = section("charts", "How the devices differ", about + charts) + knowledge_table(found) +
                                 section("figures", "Figures", statistics_table(found)) + sensitivity_table(sensitivity) +
                                 (ways ? internal::other_ways_html(*ways, found.drives.back(), nominal) : "") +
                                 worst_table(report) + internal::reproduce(result) + internal::scene(result),
                         .style = internal::chart_style(),
                         .scripts = internal::chart_scripts(drawn)});
}

}  // namespace softland
