// Diagrams and page of `softland robustness`.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "reports/box_and_chaos_report.h"
#include "reports/derivatives_report.h"
#include "reports/device_scatter.h"
#include "reports/escape.h"
#include "reports/estimates.h"
#include "reports/origin.h"
#include "reports/page.h"
#include "reports/quantity.h"
#include "reports/robustness_report.h"
#include "reports/robustness_words.h"
#include "sampling/statistics.h"

namespace softland {
namespace {

using internal::calibration_words;
using internal::error_words;
using internal::escaped;
using internal::is_erring;
using internal::is_had;
using internal::outside_words;
using internal::percent;
using internal::quantile_95;
using internal::quantile_text;
using internal::quantity;
using internal::section;
using internal::shown_values;
using internal::some_collapse;
using internal::spread_words;
using internal::symbol_html;
using internal::table_html;
using internal::TableRow;
using internal::worst_words;
using internal::yield_text;

constexpr std::array drawn_figures{key_of(&Metrics::largest_impact_velocity), key_of(&Metrics::major_bounce_height),
                                   key_of(&Metrics::initial_contact_time)};

std::string lower_case(std::string_view name) {
  std::string words(name);
  words[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(words[0])));
  return words;
}

std::string label_html(const Figure& f) {
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
  const Figure& f = figure_of(key);
  const std::vector<DriveRobustness>& drives = report.found.drives;
  internal::Chart chart{
      .id = "share-" + std::string(f.symbol),
      .title = std::string(f.name),
      .caption = fmt::format("Share of the devices whose {} is at most this.",
                             f.key == key_of(&Metrics::initial_contact_time) ? "first contact" : lower_case(f.name)),
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
      if (const double value = o.of(f); std::isfinite(value)) values.push_back(value);
    }
    if (values.empty()) continue;
    std::sort(values.begin(), values.end());
    const std::string name = fmt::format("{}-{}", chart.id, i);
    internal::CurveTable& table = tables[name];
    const auto all = static_cast<double>(drives[i].outcomes.size());
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
  const Figure& f = figure_of(key);
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
      if (const double value = o.of(f); value <= chart.x_home[1]) values[i].push_back(value);
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
  if (some_collapse(found)) add("Pulled onto the electrode", [](const DriveRobustness& d) { return yield_text(d.collapsed); });
  add("Without a rebound", [](const DriveRobustness& d) { return yield_text(d.bounce_free); });
  for (const Figure& f : device_figures) {
    if (!is_had(found, f)) continue;
    for (const std::size_t q : {std::size_t{1}, std::size_t{2}}) {
      add(label_html(f) + (q == 1 ? ": median" : ": 95 % below"),
          [&](const DriveRobustness& d) { return quantile_text(d.figures[f].quantiles[q], f.unit); });
    }
  }
  return table_html(head, rows) + fmt::format("<p class=\"below\">In brackets: 95 % confidence. {}</p>\n", worst_words);
}

std::string window_paragraph(const HoldWindows& windows) {
  const std::string words = internal::window_words(windows);
  return words.empty() ? words : "<p>" + escaped(words) + "</p>\n";
}

std::string knowledge_table(const Robustness& found) {
  if (found.by_knowledge.empty()) return {};
  std::vector<TableRow> rows;
  const auto add = [&](const std::string& name, const DriveRobustness& d) {
    rows.push_back({name, yield_text(d.bounce_free),
                    quantile_text(quantile_95(d, key_of(&Metrics::largest_impact_velocity)), "m/s"),
                    quantile_text(quantile_95(d, key_of(&Metrics::major_bounce_height)), "m")});
  };
  for (const DriveRobustness& d : found.by_knowledge) add(escaped(d.name), d);
  const Calibration& c = found.drives.back().known.calibration();
  if (is_erring(c)) add(calibration_words(c), found.drives.back());
  return section("knowledge", "What measuring a device is worth",
                 table_html({"Known of every device", "Without a rebound", "Largest impact speed, 95 % below",
                             "Highest rebound, 95 % below"},
                            rows));
}

// "62 % (55 to 69)"
std::string index_text(const SobolIndex& index) {
  if (!std::isfinite(index.value)) return "—";
  const auto share = [](double value) { return 100 * internal::share_of(value) + 0.0; };
  return fmt::format("{:.0f} % ({:.0f} to {:.0f})", share(index.value), share(index.interval.low), share(index.interval.high));
}

std::string sensitivity_table(const Sensitivity& sensitivity) {
  if (sensitivity.figures.empty()) return {};
  TableRow head{"Varies"};
  for (const FigureSensitivity& f : sensitivity.figures) {
    const std::string symbol = symbol_html(figure_of(f.key).symbol);
    head.emplace_back(symbol + ", alone");
    head.emplace_back(symbol + ", in all");
  }
  std::vector<TableRow> rows;
  for (std::size_t i = 0; i < sensitivity.variables.size(); ++i) {
    TableRow& row = rows.emplace_back(TableRow{escaped(sensitivity.variables[i])});
    for (const FigureSensitivity& f : sensitivity.figures) {
      if (!f.estimate.indices) {
        row.emplace_back(escaped(internal::why_no_indices(f.estimate)), "missing", 2);
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
      row.emplace_back(quantity(o.of(figure_of(key)), figure_of(key).unit));
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
    const Figure& f = figure_of(key);
    const auto value = [&](const DriveRobustness& d) {
      const double q = quantile_95(d, key).value;
      return std::isfinite(q) ? quantity(q, f.unit) : std::string("∞");
    };
    keys += internal::key_html(label_html(f) + ", 95\u00a0%", value(own), before(value(step)));
  }
  return keys;
}

}  // namespace

std::string robustness_html(const RobustnessReport& report) {
  const auto& [nominal, found, options, command, sensitivity, derivatives, courses, ways, windows, interrupted] = report;
  const internal::Picture drawn = picture_of(report);
  std::string charts;
  for (const internal::Chart& chart : drawn.charts) charts += internal::figure_html(drawn.tables, chart);
  Result result = internal::origin(nominal, command);
  result.seed = options.seed;
  result.tolerance = found.tolerance;
  const auto [main, rest] = headline_of(found);
  const Calibration& calibration = found.drives.back().known.calibration();
  std::string about = fmt::format(
      "<p>{} devices of the spread ({} points): {}. {}{}{}</p>\n", found.devices, name_of(point_sets, options.points),
      escaped(spread_words(nominal.scene.spread)),
      calibration.is_empty() ? "All have the volts that were designed for the nominal device."
                             : "The plain step has the volts of the nominal device; every other drive is in the units of each "
                               "device, known of it: " +
                                   calibration_words(calibration) + ".",
      error_words(nominal.scene.spread), escaped(outside_words(found)));
  if (found.interrupted) about += "<p>Interrupted: these are not all devices.</p>\n";
  return internal::page({.title = nominal.scene.title,
                         .origin = "robustness",
                         .headline = main,
                         .headline_rest = rest,
                         .keys = keys_of(found),
                         .body = section("charts", "How the devices differ", about + charts) + knowledge_table(found) +
                                 section("figures", "Figures", statistics_table(found) + window_paragraph(windows)) +
                                 internal::device_scatter_html(report) + sensitivity_table(sensitivity) +
                                 internal::derivatives_html(derivatives, found.drives.back()) +
                                 (ways ? internal::other_ways_html(*ways, found.drives.back(), nominal) : "") +
                                 worst_table(report) + internal::reproduce(result) + internal::scene(result),
                         .style = internal::chart_style(),
                         .scripts = internal::chart_scripts(drawn)});
}

}  // namespace softland
