#include "reports/device_scatter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <vector>

#include "document/escape.h"
#include "document/page.h"
#include "reports/robustness_prose.h"
#include "sampling/statistics.h"

namespace softland {
namespace {

using namespace internal;

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

ReportSection internal::device_scatter(const RobustnessReport& report) {
  return {.id = "scatter",
          .heading = "Figures against varied quantities",
          .parts = {Drawing{[&report](const Picture&) { return scatter_html(report); }}}};
}

}  // namespace softland
