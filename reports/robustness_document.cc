// The document of `softland robustness`, which simulates waveforms on devices under process variation, with its diagrams.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "document/escape.h"
#include "document/quantity.h"
#include "document/text.h"
#include "reports/origin.h"
#include "reports/robustness_prose.h"
#include "reports/robustness_report.h"
#include "reports/robustness_sections.h"
#include "sampling/statistics.h"

namespace softland {
namespace {

using internal::calibration_prose;
using internal::escaped;
using internal::is_erring;
using internal::is_had;
using internal::percent;
using internal::quantile_95;
using internal::quantile_text;
using internal::quantity;
using internal::share_text;
using internal::shown_drive;
using internal::some_collapse;
using internal::with_article;
using internal::worst_prose;
using internal::yield_text;

using DriveRecord = RobustnessRecord::Drive;

constexpr std::array drawn_figures{key_of(&Metrics::largest_impact_velocity), key_of(&Metrics::major_bounce_height),
                                   key_of(&Metrics::initial_contact_time)};

std::string lower_case(std::string_view name) {
  std::string words(name);
  words[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(words[0])));
  return words;
}

std::string label_of(const Figure& f) {
  const bool has_index = f.symbol.find('_') != std::string_view::npos;
  return fmt::format("{}{}{}", f.name, has_index ? ", " : "", has_index ? f.symbol : "");
}

// Returns the style of line i of `count` in charts that compare sets of drive waveforms: the last set has the style of the best
// waveform, the first one, the plain step, that of the baseline.
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
      .caption = fmt::format("Share of the devices whose {} is at most the value on the axis.",
                             f.key == key_of(&Metrics::initial_contact_time) ? "first contact" : lower_case(f.name)),
      .x_column = "x",
      .x_label = std::string(f.name),
      .x_unit = std::string(f.unit),
      .y_label = "Devices",
      .y_unit = "%",
      .y_home = std::array{0.0, 100.0},
      .height = 260};
  std::replace(chart.id.begin(), chart.id.end(), '_', '-');
  double least = std::numeric_limits<double>::infinity(), most = 0;
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
    least = std::min(least, values.front());
    // Choose the range of x of a figure of merit so that it covers 99 % of the devices under every set of drive waveforms.
    most = std::max(most, values[std::min(values.size() - 1, values.size() * 99 / 100)]);
    chart.series.push_back(
        {.table = name, .column = "y", .label = shown_drive(drives[i].name), .role = role_of(i, drives.size())});
    chart.x_whole[1] = std::max(chart.x_whole[1] == 1 ? 0.0 : chart.x_whole[1], values.back());
  }
  chart.x_whole[0] = 0;
  chart.x_home = {0, most > 0 ? most : 1};
  // The axis begins at 0, unless this leaves more than half of it empty.
  constexpr double margin = 0.1;
  if (least > most / 2 && least < most) chart.x_home[0] = least - margin * (most - least);
  chart.x_whole[1] = std::max(chart.x_whole[1], chart.x_home[1]);
  return chart;
}

// Returns the least value on the logarithmic axis of a histogram of the sets `values`: the smallest positive value of them, or
// a ten-thousandth of the largest. Returns 0 for a linear axis, if the medians of the sets differ by less than a factor of 10.
double least_of_wide(const std::vector<std::vector<double>>& values) {
  double softest = std::numeric_limits<double>::infinity(), hardest = 0, least = softest, most = 0;
  for (const std::vector<double>& set : values) {
    if (set.empty()) continue;
    const double median = sample_quantile(set, 0.5);
    softest = std::min(softest, median), hardest = std::max(hardest, median);
    for (const double value : set) {
      if (value > 0) least = std::min(least, value), most = std::max(most, value);
    }
  }
  constexpr double wide = 10, range = 1e4;
  return hardest > wide * softest ? std::max(least, most / range) : 0;
}

// Draws a histogram of a figure of merit over the devices, with the same bins for all sets of waveforms, over the range of the
// cumulative curves. It shows what these hide: two peaks if some devices close in another way than the others. The bins are
// narrow enough for each of the sets. They are equal on a logarithmic axis if the sets differ much.
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
  for (std::size_t i = 0; i < drives.size(); ++i) {
    for (const DeviceOutcome& o : drives[i].outcomes) {
      if (const double value = o.of(f); value <= chart.x_home[1]) values[i].push_back(value);
    }
  }
  const double least = least_of_wide(values);
  bool has_smaller = false;
  double low = std::numeric_limits<double>::infinity(), high = -low, width = low;
  constexpr std::size_t most_bins = 80;
  for (std::vector<double>& set : values) {
    for (double& value : set) {
      has_smaller = has_smaller || value < least;
      if (least > 0) value = std::log10(std::max(value, least));
      low = std::min(low, value), high = std::max(high, value);
    }
    if (set.empty()) continue;
    const Histogram own = histogram(set, most_bins);
    if (own.high > own.low) width = std::min(width, (own.high - own.low) / static_cast<double>(own.counts.size()));
  }
  if (!(high > low)) return chart;
  const double wanted = std::clamp(std::ceil((high - low) / width), 1.0, static_cast<double>(most_bins));
  width = (high - low) / wanted;
  if (least > 0) {
    chart.x_scale = internal::AxisScale::logarithmic;
    chart.is_of_steps = true;
    chart.x_home[0] = chart.x_whole[0] = least;
  }
  for (std::size_t i = 0; i < drives.size(); ++i) {
    std::vector<std::size_t> counts(static_cast<std::size_t>(wanted), 0);
    for (const double value : values[i]) ++counts[std::min(counts.size() - 1, static_cast<std::size_t>((value - low) / width))];
    const std::string name = fmt::format("{}-{}", chart.id, i);
    internal::CurveTable& table = tables[name];
    const auto point = [&](std::size_t edge, double share) {
      const double at = low + static_cast<double>(edge) * width;
      table["x"].push_back(least > 0 ? std::pow(10, at) : at);
      table["y"].push_back(share);
    };
    point(0, 0);
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const double share = 100 * static_cast<double>(counts[k]) / static_cast<double>(drives[i].outcomes.size());
      point(k, share);
      point(k + 1, share);
    }
    point(counts.size(), 0);
    chart.series.push_back(
        {.table = name, .column = "y", .label = shown_drive(drives[i].name), .role = role_of(i, drives.size())});
  }
  chart.caption =
      least > 0 ? fmt::format("Share of the devices in each interval, which ends {} above its beginning.{}",
                              percent(std::pow(10, width) - 1), has_smaller ? " The first also has all smaller values." : "")
                : fmt::format("Share of the devices in each interval of {}.", quantity(width, f.unit));
  return chart;
}

internal::Chart course_chart(const RobustnessReport& report, internal::CurveTables& tables) {
  internal::Chart chart{
      .id = "courses",
      .title = "Typical closings",
      .caption = fmt::format("Gap of the devices at the 5th, 50th and 95th percentile of the highest rebound under {}.",
                             with_article(report.found.drives.back().name)),
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
    const CurveRecord curve = curve_of(course.trajectory, report.nominal.scene.metrics);
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

// Returns the end of a name, which tells more than its beginning: for example the last folder of a path.
std::string end_of(const std::string& name, std::size_t columns) {
  if (internal::display_width(name) <= columns) return name;
  std::string end = name;
  while (internal::display_width(end) >= columns) {
    std::size_t first = 1;
    // Skip the further bytes of a letter of UTF-8.
    while (first < end.size() && (static_cast<unsigned char>(end[first]) & 0xC0U) == 0x80U) ++first;
    end.erase(0, first);
  }
  return "…" + end;
}

TableCell drive_cell(const DriveRecord& drive) {
  constexpr std::size_t widest = 44;
  const std::string name = shown_drive(drive.name);
  TableCell cell(end_of(name, widest));
  cell.html = escaped(name);
  return cell;
}

ReportSection statistics_section(const RobustnessRecord& found) {
  ReportTable table{.head = {"Over the devices"}, .rows = {}};
  for (const DriveRecord& d : found.drives) table.head.push_back(drive_cell(d));
  const auto add = [&](TableCell name, const auto& cell) {
    TableRow& row = table.rows.emplace_back(TableRow{std::move(name)});
    for (const DriveRecord& d : found.drives) row.emplace_back(cell(d), &d == &found.drives.back() ? "own" : "");
  };
  bool has_all_bounds = true;
  add("Devices that close", [](const DriveRecord& d) { return yield_text(d.closing); });
  if (some_collapse(found)) add("Collapse onto the electrode", [](const DriveRecord& d) { return yield_text(d.collapsed); });
  add("Bounce-free", [](const DriveRecord& d) { return yield_text(d.bounce_free); });
  for (const Figure& f : device_figures) {
    if (!is_had(found, f)) continue;
    for (const std::size_t q : {std::size_t{1}, std::size_t{2}}) {
      add(label_of(f) + (q == 1 ? ": median" : ": 95th percentile"), [&](const DriveRecord& d) {
        const EstimatedQuantile& one = d.figures[f].quantiles[q];
        if (std::isfinite(one.value) && !(std::isfinite(one.interval.low) && std::isfinite(one.interval.high)))
          has_all_bounds = false;
        return quantile_text(one, f.unit);
      });
    }
  }
  return {.id = "figures",
          .heading = "Figures",
          .parts = {std::move(table),
                    Paragraph{.text = fmt::format(
                                  "In brackets: 95 % confidence{}. Seed {}, {} points, window {}, integrator tolerance {}. {}",
                                  has_all_bounds ? "" : "; — where this number of devices gives no finite bound", found.seed,
                                  name_of(point_sets, found.points), quantity(found.duration, "s", 4),
                                  internal::scientific(found.tolerance), worst_prose),
                              .is_note = true},
                    Paragraph{.text = internal::window_prose(found.windows), .is_note = true}}};
}

// Returns the section on the value of per-device calibration: figures of merit under the last compared set of waveforms, for
// more and more quantities that are measured on every device.
ReportSection knowledge_section(const RobustnessRecord& found) {
  ReportSection section{.id = "knowledge", .heading = "Value of per-device calibration", .parts = {}};
  if (found.by_knowledge.empty()) return section;
  ReportTable table{.head = {"Measured on every device", "Bounce-free", "v_max, 95th percentile", "B_H, 95th percentile"},
                    .rows = {}};
  const auto add = [&](const std::string& name, const DriveRecord& d) {
    table.rows.push_back({name, yield_text(d.bounce_free),
                          quantile_text(quantile_95(d, key_of(&Metrics::largest_impact_velocity)), "m/s"),
                          quantile_text(quantile_95(d, key_of(&Metrics::major_bounce_height)), "m")});
  };
  for (const DriveRecord& d : found.by_knowledge) add(d.name, d);
  const Calibration& c = found.drives.back().calibration;
  if (is_erring(c)) add(calibration_prose(c), found.drives.back());
  section.parts = {std::move(table)};
  return section;
}

// Returns a Sobol' index with its confidence interval as text: "62 % (55 to 69)".
std::string index_text(const SobolIndex& index) {
  if (!std::isfinite(index.value)) return "—";
  const auto share = [](double value) { return 100 * internal::share_of(value) + 0.0; };
  return fmt::format("{:.0f} % ({:.0f} to {:.0f})", share(index.value), share(index.interval.low), share(index.interval.high));
}

ReportSection sensitivity_section(const RobustnessRecord& record) {
  ReportSection section{.id = "sensitivity", .heading = "Sources of the variation", .parts = {}};
  if (!record.why_no_sensitivity.empty())
    section.parts.emplace_back(Paragraph{fmt::format("There are no Sobol' indices: {}.", record.why_no_sensitivity)});
  if (record.sensitivity.empty()) return section;
  ReportTable table{.head = {"Share of the variance"}, .rows = {}};
  for (const RobustnessRecord::Sensitive& f : record.sensitivity) {
    for (const char* how : {"{}, first order", "{}, total"})
      table.head.emplace_back(fmt::format(fmt::runtime(how), figure_of(f.key).symbol));
  }
  for (const RobustnessRecord::Varied& v : record.spread) {
    TableRow& row = table.rows.emplace_back(TableRow{v.name});
    for (const RobustnessRecord::Sensitive& f : record.sensitivity) {
      const auto indices = f.variables.find(v.name);
      const bool is_known = indices != f.variables.end();
      row.emplace_back(is_known ? index_text(indices->second.first_order) : "unknown");
      row.emplace_back(is_known ? index_text(indices->second.total) : "unknown");
    }
  }
  section.parts = {
      std::move(table),
      Paragraph{.text = fmt::format(
                    "Sobol' indices under the last waveform, from {} rows of devices. The first-order index is the share of a "
                    "figure's variance that would vanish if the quantity were known; the total index is the share in which the "
                    "quantity takes part. Where a figure jumps with a rebound, percentiles say more than variances.",
                    record.sensitivity.front().rows),
                .is_note = true}};
  for (const RobustnessRecord::Sensitive& f : record.sensitivity) {
    if (f.variables.empty())
      section.parts.emplace_back(
          Paragraph{fmt::format("{}: {}.", figure_of(f.key).symbol, internal::why_no_indices(f.rows, f.failed_rows))});
  }
  return section;
}

double number_of(const std::map<std::string, double>& all, std::string_view name) {
  const auto found = all.find(std::string(name));
  return found == all.end() ? Metrics::unset : found->second;
}

// Returns the reason why a device has no figures: its failure, or its outcome in words.
std::string why_no_figures(const RobustnessRecord::Device& device) {
  if (!device.failure.empty()) return device.failure;
  if (device.status == to_string(Status::no_contact)) return "stays open";
  std::string words = device.status;
  std::ranges::replace(words, '_', ' ');
  return words;
}

ReportSection worst_section(const RobustnessRecord& record) {
  ReportSection section{.id = "worst", .heading = "The worst devices", .parts = {}, .shown = ShownIn::page};
  if (record.devices == 0) return section;
  const DriveRecord& last = record.drives.back();
  ReportTable table{.head = {"Device"}, .rows = {}};
  for (const RobustnessRecord::Varied& v : record.spread) table.head.emplace_back(v.name);
  table.head.insert(table.head.end(), {"Highest rebound", "Largest impact velocity", "First contact"});
  for (const RobustnessRecord::Device& device : last.worst) {
    TableRow& row = table.rows.emplace_back(TableRow{fmt::format("{}", device.number)});
    for (const RobustnessRecord::Varied& v : record.spread)
      row.emplace_back(internal::value_text(v, number_of(device.values, v.name)));
    if (device.failure.empty() && std::isfinite(number_of(device.figures, drawn_figures[1]))) {
      for (const std::string_view key : {drawn_figures[1], drawn_figures[0], drawn_figures[2]})
        row.emplace_back(quantity(number_of(device.figures, key), figure_of(key).unit));
    } else {
      row.emplace_back(why_no_figures(device), "missing", 3);
    }
  }
  if (!table.rows.empty())
    section.parts = {std::move(table),
                     Paragraph{.text = fmt::format("The waveform is {}.", with_article(last.name)), .is_note = true}};
  return section;
}

std::pair<std::string, std::string> headline_of(const RobustnessRecord& found) {
  const DriveRecord &step = found.drives.front(), &own = found.drives.back();
  const auto words = [&](const DriveRecord& d) {
    return fmt::format(
        "{} of {} {} bounce-free; the 95th percentile is {} for the largest impact velocity and {} for the highest rebound",
        share_text(d.bounce_free.value), internal::devices_text(found.devices), found.devices == 1 ? "closes" : "close",
        quantity(quantile_95(d, drawn_figures[0]).value, "m/s"), quantity(quantile_95(d, drawn_figures[1]).value, "m"));
  };
  if (found.drives.size() == 1) return {"Under the plain step " + words(step) + ".", ""};
  return {words(own), fmt::format("; under the plain step these figures are {}, {} and {}.", share_text(step.bounce_free.value),
                                  quantity(quantile_95(step, drawn_figures[0]).value, "m/s"),
                                  quantity(quantile_95(step, drawn_figures[1]).value, "m"))};
}

std::vector<KeyNumber> keys_of(const RobustnessRecord& found) {
  const DriveRecord &step = found.drives.front(), &own = found.drives.back();
  const auto before = [&](const std::string& value) { return found.drives.size() > 1 ? "plain step " + value : std::string(); };
  std::vector<KeyNumber> keys{
      {.name = "Bounce-free", .value = share_text(own.bounce_free.value), .change = before(share_text(step.bounce_free.value))}};
  for (const std::string_view key : drawn_figures) {
    const Figure& f = figure_of(key);
    const auto value = [&](const DriveRecord& d) {
      const double q = quantile_95(d, key).value;
      return std::isfinite(q) ? quantity(q, f.unit) : std::string("∞");
    };
    keys.push_back({.name = label_of(f) + ", 95th percentile", .value = value(own), .change = before(value(step))});
  }
  return keys;
}

}  // namespace

Document document_of(const RobustnessRecord& found) {
  Document document{.title = title_of(found.origin),
                    .origin = "robustness",
                    .sections = {{.id = "charts", .heading = "Variation between the devices", .parts = {}}},
                    .warnings = found.warnings,
                    .made = made_again(found.origin, found.seed, found.tolerance)};
  for (const std::string& words : found.about) document.sections.front().parts.emplace_back(Paragraph{words});
  if (found.devices == 0) return document;
  std::tie(document.headline, document.headline_rest) = headline_of(found);
  document.keys = keys_of(found);
  for (ReportSection& section :
       std::array{knowledge_section(found), statistics_section(found), sensitivity_section(found),
                  internal::derivatives_section(found.derivatives, found.drives.back()),
                  found.box_and_chaos ? internal::box_and_chaos_section(found) : ReportSection(), worst_section(found)})
    document.sections.push_back(std::move(section));
  return document;
}

Document robustness_document(const RobustnessReport& report) {
  Document document = document_of(record_of(report));
  if (report.found.devices == 0) return document;
  document.draw = [&report] { return picture_of(report); };
  document.sections.front().parts.emplace_back(internal::all_charts());
  constexpr std::ptrdiff_t behind_figures = 3;  // number of sections after which the page shows the scatter plots
  document.sections.insert(document.sections.begin() + behind_figures, internal::device_scatter(report));
  return document;
}

}  // namespace softland
