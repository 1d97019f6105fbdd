#include "reports/robustness_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "document/escape.h"
#include "document/page.h"
#include "document/quantity.h"
#include "reports/robustness_prose.h"
#include "reports/robustness_report.h"
#include "sampling/statistics.h"

namespace softland::internal {
namespace {

using Derived = RobustnessRecord::Derived;

const FigureStatistics& statistics_of(const DriveRobustness& drive, std::string_view key) {
  return drive.figures[figure_of(key)];
}

// Returns the relative change of a figure of merit divided by the relative change of a varied quantity; NaN if figure or
// quantity is 0.
double elasticity(const FigureDerivatives& figure, const Derivatives::Variable& variable, double derivative) {
  const double size = figure.value / variable.nominal;
  return size != 0 && std::isfinite(size) ? derivative / size : Metrics::unset;
}

std::string with_sign(const std::string& number, double value) { return (value > 0 ? "+" : "") + number; }

// Largest ratio of the standard deviation of a figure in the sample to the one that the derivatives predict (or the inverse) at
// which the derivatives at the nominal device describe the varied devices.
constexpr double most_apart = 2;

bool agrees(const FigureDerivatives& figure, const DriveRobustness& drive) {
  const double sampled = statistics_of(drive, figure.key).standard_deviation;
  if (!figure.is_known() || !std::isfinite(sampled)) return figure.is_known();
  return figure.deviation <= most_apart * sampled && sampled <= most_apart * figure.deviation;
}

// Returns the table cell of a figure of merit and a varied quantity: relative derivative, and change for one standard
// deviation: "+0.52 %/%, +1.2 µs".
std::string derivative_cell(const Derived::Of& figure, const std::string& variable) {
  const auto slope = figure.by.find(variable);
  if (!figure.agrees || slope == figure.by.end() || !std::isfinite(slope->second.derivative)) return "—";
  const auto& [derivative, relative, step] = slope->second;
  const std::string change = with_sign(quantity(step, figure_of(figure.key).unit), step);
  return std::isfinite(relative) ? with_sign(plain_number(relative), relative) + " %/%, " + change : change;
}

std::string deviation_cell(const Derived::Of& figure) {
  const bool none = std::ranges::none_of(figure.by, [](const auto& slope) { return std::isfinite(slope.second.derivative); });
  return none ? "—" : quantity(figure.deviation, figure_of(figure.key).unit);
}

// Explains to a reader of the report what a derivative of a figure of merit means, and where it does not apply.
std::string meaning_of(const Derived& derivatives) {
  std::string words = fmt::format(
      "Exact derivatives at the nominal design under {}. A cell has the change of the figure in per cent for one per cent of the "
      "quantity, and the change for one standard deviation. To first order the squares of these changes add up to the variance. "
      "A rebound that appears or disappears is not a small change: trust the sample where the two standard deviations differ.",
      with_article(derivatives.drive));
  std::vector<std::string> apart;
  for (const Derived::Of& figure : derivatives.figures) {
    if (!figure.by.empty() && !figure.agrees) apart.emplace_back(figure_of(figure.key).symbol);
  }
  if (!apart.empty()) {
    words += fmt::format(
        " The derivatives of {} are not shown: their standard deviation differs from that of the devices by more than a factor "
        "of {:g}.",
        in_words(apart), most_apart);
  }
  if (derivatives.grazes) {
    words += fmt::format(
        " Grazing: the slowest crossing of the contact plane has {} of the impact velocity, so a touch nearly appears or "
        "disappears. The derivatives of figures after the first touch hold for much smaller changes only.",
        percent(derivatives.grazing));
  }
  for (const auto& [name, variable] : derivatives.variables) {
    if (!variable.why_none.empty()) words += fmt::format(" {} is left out: {}.", name, variable.why_none);
  }
  return words;
}

std::string why_no_derivatives(const Derived& derivatives) {
  return fmt::format("The figures have no derivatives here: {}.", derivatives.why_none);
}

using DriveRecord = RobustnessRecord::Drive;
using BoxAndChaosRecord = RobustnessRecord::BoxAndChaosRecord;
using RangeRecord = BoxAndChaosRecord::Range;

// Largest share of the variance of a figure of merit that polynomial chaos may leave unexplained if the report says that it
// predicts the figure.
constexpr double predicted_well = 0.1;

const FigureStatistics& sampled(const DriveRecord& drive, std::string_view key) { return drive.figures[figure_of(key)]; }

std::string figure_text(double value, std::string_view key) {
  return std::isinf(value) ? "∞" : quantity(value, figure_of(key).unit);
}

// Prefer the coefficient of determination q2 on devices that were not in the training set: the error on training devices is too
// small.
double missed(const FigureChaos& chaos) { return 1 - (std::isfinite(chaos.q2_unseen) ? chaos.q2_unseen : chaos.q2); }

// A polynomial chaos prediction that misses all of the variance or more is no better than the mean.
std::string missed_share(double share) { return share >= 1 ? "all" : percent(std::max(0.0, share)); }
std::string missed_text(double q2) { return std::isfinite(q2) ? missed_share(1 - q2) : "—"; }

ReportTable compared(const BoxAndChaosRecord& ways, const DriveRecord& drive) {
  ReportTable table{.head = {"Cross-checks, under " + with_article(drive.name)}, .rows = {}};
  for (const RangeRecord& r : ways.ranges) table.head.emplace_back(figure_of(r.key).symbol);
  const auto add = [&](TableCell name, auto&& cell) {
    TableRow& row = table.rows.emplace_back(TableRow{std::move(name)});
    for (std::size_t i = 0; i < ways.ranges.size(); ++i) row.emplace_back(cell(ways.ranges[i], ways.chaos[i]));
  };
  const auto part = [](const char* name) { return TableCell(name, "part"); };
  add("Mean: sampled", [&](const RangeRecord& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).mean, r.key); });
  add(part("polynomial chaos"), [](const RangeRecord&, const FigureChaos& c) { return figure_text(c.mean, c.key); });
  add("Standard deviation: sampled",
      [&](const RangeRecord& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).standard_deviation, r.key); });
  add(part("polynomial chaos"),
      [](const RangeRecord&, const FigureChaos& c) { return figure_text(c.standard_deviation, c.key); });
  add("95th percentile: sampled",
      [&](const RangeRecord& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).quantiles[2].value, r.key); });
  add(part("polynomial chaos"), [](const RangeRecord&, const FigureChaos& c) { return figure_text(c.quantile_95, c.key); });
  add("Worst in the box: found by search",
      [](const RangeRecord& r, const FigureChaos&) { return figure_text(r.most.figure, r.key); });
  add(part("sampled"), [](const RangeRecord& r, const FigureChaos&) { return figure_text(r.of_sample.high, r.key); });
  add("Best in the box: found by search",
      [](const RangeRecord& r, const FigureChaos&) { return figure_text(r.least.figure, r.key); });
  add(part("sampled"), [](const RangeRecord& r, const FigureChaos&) { return figure_text(r.of_sample.low, r.key); });
  add("Unexplained variance: cross-validated", [](const RangeRecord&, const FigureChaos& c) { return missed_text(c.q2); });
  add(part("on devices not used in the fit"), [](const RangeRecord&, const FigureChaos& c) { return missed_text(c.q2_unseen); });
  return table;
}

std::string box_prose(const BoxAndChaosRecord& ways, std::size_t devices) {
  return fmt::format(
      "The box holds every quantity within ± {:.2f} standard deviations of its underlying normal variable. It covers {:.0f} % of "
      "all devices, and {} of the {} sampled ones. Its worst value is therefore at least the {:.0f}th percentile of the devices. "
      "Worst and best values were found by searches with {} closings; the true range is at least as wide.",
      ways.half_width, 100 * ways.share, ways.sampled_inside, devices, 100 * ways.share, ways.closings);
}

/// Returns sentences on how well polynomial chaos describes each figure of merit.
std::string chaos_prose(const BoxAndChaosRecord& ways) {
  std::vector<std::string> good, bad, none;
  for (const FigureChaos& c : ways.chaos) {
    const std::string name(figure_of(c.key).symbol);
    if (!std::isfinite(c.q2)) {
      none.push_back(name);
    } else if (missed(c) <= predicted_well) {
      good.push_back(name);
    } else {
      bad.push_back(fmt::format("{} ({} of the variance)", name, missed_share(missed(c))));
    }
  }
  std::string words = fmt::format("Polynomial chaos is fitted to the first {} devices of the sample, without a further closing.",
                                  ways.chaos.front().fitted + ways.left_out);
  if (ways.left_out > 0) {
    words +=
        fmt::format(" {} of them do not close; its mean, standard deviation and percentile treat such devices as if they closed.",
                    ways.left_out);
  }
  if (!good.empty()) words += fmt::format(" It predicts {}{}.", in_words(good), ways.left_out > 0 ? " of those that close" : "");
  if (!bad.empty()) {
    words += fmt::format(
        " It fails for {}: a figure jumps where a small change of a quantity adds or removes a touch, and polynomials cannot "
        "follow. Trust the sample there.",
        in_words(bad));
  }
  if (!none.empty())
    words += fmt::format(" It cannot describe {}: too few of these devices have the figure, or all have the same value.",
                         in_words(none));
  return words;
}

// Describes the device with the extreme value of a figure of merit in the box of varied quantities. Each quantity is given in
// its SI unit, or as the factor by which it differs from the nominal device.
BoxAndChaosRecord::InBox in_box(const BoxDevice& device, const PreparedScene& nominal) {
  BoxAndChaosRecord::InBox record{.figure = device.figure,
                                  .values = {},
                                  .status = std::string(to_string(device.outcome.metrics.status)),
                                  .failure = device.outcome.failure};
  const std::vector<double> shown = device.values.empty() ? device.values : DeviceDrives(nominal).shown(device.values);
  for (std::size_t i = 0; i < shown.size(); ++i) record.values[nominal.scene.spread.variables[i].name] = shown[i];
  return record;
}

constexpr std::size_t most_dots = 300;
constexpr std::size_t groups = 16;  // number of groups of devices by a varied quantity, each with its median
constexpr std::size_t fewest_of_group = 5;
constexpr double shown_share = 0.99;  // share of the devices that a plot shows: its axis leaves out outliers

// A varied quantity by device; a factor is given as its deviation in percent.
struct VariedQuantity {
  std::string name, unit;
  std::vector<double> values;
};

std::vector<VariedQuantity> quantities_of(const RobustnessReport& report) {
  constexpr double percent = 100;
  const std::vector<SpreadVariable>& variables = report.nominal.scene.spread.variables;
  const Ensemble ensemble(report.nominal, report.options.samples, report.options.seed, report.options.points);
  std::vector<VariedQuantity> all;
  for (const SpreadVariable& v : variables)
    all.push_back({.name = v.name, .unit = v.is_factor ? "%" : std::string(v.keys.front().unit), .values = {}});
  for (std::size_t k = 0; k < report.found.devices; ++k) {
    const std::vector<double> values = shown_values(ensemble, k);
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i].values.push_back(variables[i].is_factor ? percent * (values[i] - 1) : values[i]);
  }
  return all;
}

// Returns the medians of a figure of merit y in groups of devices with similar values of a varied quantity x. A device without
// the figure counts as the worst device.
CurveTable medians(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return x[k]; });
  const std::size_t all = std::min(groups, order.size() / fewest_of_group);
  CurveTable line{{"x", {}}, {"y", {}}};
  for (std::size_t g = 0; g < all; ++g) {
    std::vector<double> of_x, of_y;
    for (std::size_t i = g * order.size() / all; i < (g + 1) * order.size() / all; ++i) {
      of_x.push_back(x[order[i]]);
      of_y.push_back(y[order[i]]);
    }
    const double middle = sample_quantile(of_y, 0.5);
    if (!std::isfinite(middle)) continue;
    line["x"].push_back(sample_quantile(of_x, 0.5));
    line["y"].push_back(middle);
  }
  return line;
}

std::string scatter(const VariedQuantity& quantity, const Figure& figure, const std::vector<double>& values, int number) {
  std::vector<double> finite;
  std::ranges::copy_if(values, std::back_inserter(finite), [](double v) { return std::isfinite(v); });
  if (finite.size() < fewest_of_group) return {};
  const double most = sample_quantile(finite, shown_share);
  CurveTables tables{{"medians", medians(quantity.values, values)}};
  CurveTable& dots = tables["dots"];
  for (std::size_t k = 0; k < values.size() && k < most_dots; ++k) {
    if (!(values[k] <= most)) continue;
    dots["x"].push_back(quantity.values[k]);
    dots["y"].push_back(values[k]);
  }
  if (dots["x"].empty()) return {};
  const auto [low, high] = std::ranges::minmax(quantity.values);
  const auto [least, largest] = std::ranges::minmax(dots["y"]);
  // The axes have a margin, so that no dot lies on an edge.
  constexpr double share = 0.04;
  const double x_margin = share * (high - low), y_margin = share * (largest - least);
  Chart chart{
      .id = fmt::format("scatter-{}", number),
      .title = fmt::format("{} by {}", figure.name, quantity.name),
      .caption = "",
      .x_column = "x",
      .x_label = quantity.name,
      .x_unit = quantity.unit,
      .y_label = std::string(figure.name),
      .y_unit = std::string(figure.unit),
      .x_home = {low - x_margin, high + x_margin},
      .x_whole = {low - x_margin, high + x_margin},
      .y_home = largest > least ? std::array{least - y_margin, largest + y_margin} : std::array{0.0, most > 0 ? most : 1.0},
      .height = 200,
      .series = {{.table = "dots", .column = "y", .label = "", .role = Role::evaluations}}};
  if (tables["medians"]["x"].size() > 1)
    chart.series.push_back({.table = "medians", .column = "y", .label = "", .role = Role::best});
  return small_picture(tables, chart);
}

std::string scatter_html(const RobustnessReport& report) {
  if (report.found.devices == 0) return {};
  const DriveRobustness& drive = report.found.drives.back();
  const std::vector<VariedQuantity> quantities = quantities_of(report);
  std::string pictures;
  int number = 0;
  for (const std::string_view key : explained_figures) {
    const Figure& figure = figure_of(key);
    std::vector<double> values;
    for (const DeviceOutcome& o : drive.outcomes) values.push_back(o.of(figure));
    for (const VariedQuantity& quantity : quantities) pictures += scatter(quantity, figure, values, number++);
  }
  if (pictures.empty()) return {};
  return fmt::format(
      "<p>Each dot is a device under {} (the first {} are shown). The line joins medians of neighbouring devices.</p>\n"
      "<div class=\"multiples\">\n{}</div>\n",
      escaped(with_article(drive.name)), std::min(most_dots, report.found.devices), pictures);
}

}  // namespace

Derived record_of(const Derivatives& derivatives, const DriveRobustness& drive) {
  Derived record{
      .drive = drive.name, .why_none = derivatives.why_none, .grazes = derivatives.grazes(), .grazing = derivatives.grazing};
  for (const Derivatives::Variable& v : derivatives.variables) record.variables[v.name] = {v.nominal, v.deviation, v.why_none};
  for (const FigureDerivatives& figure : derivatives.figures) {
    Derived::Of& one = record.figures.emplace_back(Derived::Of{.key = figure.key,
                                                               .nominal = figure.value,
                                                               .deviation = figure.deviation,
                                                               .error = figure.error,
                                                               .by = {},
                                                               .agrees = agrees(figure, drive),
                                                               .why_none = figure.why_none});
    for (std::size_t i = 0; i < figure.by_variable.size(); ++i) {
      const Derivatives::Variable& v = derivatives.variables[i];
      const double slope = figure.by_variable[i];
      one.by[v.name] = {slope, elasticity(figure, v, slope), slope * v.deviation};
    }
  }
  return record;
}

ReportSection derivatives_section(const Derived& derivatives, const RobustnessRecord::Drive& drive) {
  ReportSection section{.id = "derivatives", .heading = "First-order sensitivities", .parts = {}};
  if (derivatives.variables.empty()) return section;
  if (derivatives.figures.empty()) {
    section.parts = {Paragraph{why_no_derivatives(derivatives)}};
    return section;
  }
  ReportTable table{.head = {derivatives.grazes ? "To first order (grazing)" : "To first order", "Nominal"}, .rows = {}};
  table.head.front().html = "Figure";
  for (const auto& [name, variable] : derivatives.variables) table.head.emplace_back(name);
  table.head.insert(table.head.end(), {"First-order standard deviation", "Standard deviation of the devices"});
  for (const Derived::Of& figure : derivatives.figures) {
    const Figure& of = figure_of(figure.key);
    TableRow& row = table.rows.emplace_back(TableRow{of.name, quantity(figure.nominal, of.unit)});
    if (figure.by.empty()) {
      row.emplace_back(figure.why_none, "missing", derivatives.variables.size() + 1);
    } else {
      for (const auto& [name, variable] : derivatives.variables) row.emplace_back(derivative_cell(figure, name));
      row.emplace_back(deviation_cell(figure));
    }
    row.emplace_back(quantity(drive.figures[of].standard_deviation, of.unit));
  }
  section.parts = {std::move(table), Paragraph{.text = meaning_of(derivatives), .is_note = true}};
  return section;
}

BoxAndChaosRecord record_of(const BoxAndChaos& ways, const DriveRobustness& drive, const PreparedScene& nominal) {
  BoxAndChaosRecord record{.drive = drive.name,
                           .why_none = ways.why_none,
                           .share = box_share,
                           .half_width = ways.half_width,
                           .sampled_inside = ways.sampled_inside,
                           .left_out = ways.left_out,
                           .closings = ways.closings,
                           .ranges = {},
                           .chaos = ways.chaos};
  for (const FigureRange& r : ways.ranges)
    record.ranges.push_back({r.key, in_box(r.least, nominal), in_box(r.most, nominal), r.of_sample});
  return record;
}

std::string value_text(const RobustnessRecord::Varied& variable, double value) {
  return variable.is_factor ? fmt::format("× {:.4f}", value) : quantity(value, variable.unit, 5);
}

ReportSection box_and_chaos_section(const RobustnessRecord& record) {
  const BoxAndChaosRecord& ways = *record.box_and_chaos;
  ReportSection section{.id = "ways", .heading = "Cross-checks: worst case and polynomial chaos", .parts = {}};
  if (ways.ranges.empty()) return section;
  ReportTable figures = compared(ways, record.drives.back()), devices{.head = {"In the box", "Found"}, .rows = {}};
  for (const RobustnessRecord::Varied& v : record.spread) devices.head.emplace_back(v.name);
  for (const RangeRecord& r : ways.ranges) {
    for (const auto& [name, device] : {std::pair("Worst", &r.most), std::pair("Best", &r.least)}) {
      TableRow& line = devices.rows.emplace_back(
          TableRow{fmt::format("{} {}", name, figure_of(r.key).symbol), figure_text(device->figure, r.key)});
      for (const RobustnessRecord::Varied& v : record.spread) {
        if (const auto value = device->values.find(v.name); value != device->values.end())
          line.emplace_back(value_text(v, value->second));
      }
    }
  }
  section.parts = {Paragraph{box_prose(ways, record.devices)}, Paragraph{chaos_prose(ways)}, std::move(figures),
                   SubHeading{"Worst and best devices of the box"}, std::move(devices)};
  return section;
}

ReportSection device_scatter(const RobustnessReport& report) {
  return {.id = "scatter",
          .heading = "Figures against varied quantities",
          .parts = {Drawing{[&report](const Picture&) { return scatter_html(report); }}}};
}

}  // namespace softland::internal
