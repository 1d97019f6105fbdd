#include "reports/recording_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "base/printable.h"
#include "document/chart.h"
#include "document/document.h"
#include "document/downsample.h"
#include "document/json_number.h"
#include "document/quantity.h"
#include "document/svg.h"

namespace softland {
namespace {

using internal::json_number;
using internal::quantity;

constexpr int digits = 6;

struct ChannelFigures {
  std::size_t samples = 0;
  double first = std::numeric_limits<double>::quiet_NaN(), last = first, minimum = first,
         maximum = first;  ///< first, last, smallest and largest sample [unit of the channel]
};

ChannelFigures figures_of(const Channel& channel) {
  ChannelFigures figures;
  for (const double value : channel.values) {
    if (!std::isfinite(value)) continue;
    if (figures.samples++ == 0) figures.first = figures.minimum = figures.maximum = value;
    figures.last = value;
    figures.minimum = std::min(figures.minimum, value);
    figures.maximum = std::max(figures.maximum, value);
  }
  return figures;
}

std::string shown(double value, const Channel& channel) {
  return channel.unit.size() == 1 ? quantity(value, channel.unit, digits)
                                  : quantity(value, "", digits) + (channel.unit.empty() ? "" : " " + channel.unit);
}

// Returns the indices of the rows to draw: all but the interior of constant stretches, so that steps are drawn as steps.
std::vector<std::size_t> corners(const std::vector<double>& values) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_inside = i > 0 && i + 1 < values.size() && values[i - 1] == values[i] && values[i] == values[i + 1];
    if (!is_inside) rows.push_back(i);
  }
  return rows;
}

}  // namespace

nlohmann::json recording_json(const Recording& recording) {
  const TimeAxis axis = time_axis(recording);
  nlohmann::json channels = nlohmann::json::array();
  for (const Channel& channel : recording.channels) {
    const ChannelFigures figures = figures_of(channel);
    channels.push_back({{"name", printable_line(channel.name)},
                        {"unit", printable_line(channel.unit)},
                        {"samples", figures.samples},
                        {"first", json_number(figures.first)},
                        {"last", json_number(figures.last)},
                        {"minimum", json_number(figures.minimum)},
                        {"maximum", json_number(figures.maximum)}});
  }
  return {{"format", recording.format},
          {"time",
           {{"first_s", json_number(axis.first)},
            {"last_s", json_number(axis.last)},
            {"interval_s", json_number(axis.interval)},
            {"repeated", axis.repeated}}},
          {"channels", channels},
          {"left_out", recording.left_out},
          {"notes", recording.notes}};
}

std::string recording_text(const Recording& recording) {
  ReportTable table{.head = {"channel", "column", "samples", "first", "last", "minimum", "maximum"}, .rows = {}};
  for (const Channel& channel : recording.channels) {
    const ChannelFigures figures = figures_of(channel);
    TableRow& row = table.rows.emplace_back(
        TableRow{printable_line(channel.name), fmt::format("{}", channel.column), fmt::format("{}", figures.samples)});
    for (const double value : {figures.first, figures.last, figures.minimum, figures.maximum})
      row.emplace_back(shown(value, channel));
  }
  return terminal_text(
      {.headline = summary(recording), .sections = {{.id = "channels", .heading = "Channels", .parts = {table}}}});
}

std::string recording_svg(const Recording& recording) {
  constexpr std::size_t most_rows = 3000;
  constexpr int height = 150;
  internal::Picture drawn;
  const bool has_times = !recording.times.empty();
  std::vector<double> rows(has_times ? 0 : recording.rows());
  std::iota(rows.begin(), rows.end(), 1.0);
  const std::vector<double>& x = has_times ? recording.times : rows;
  const auto [first, last] = std::minmax_element(x.begin(), x.end());
  for (std::size_t k = 0; k < recording.channels.size(); ++k) {
    const Channel& channel = recording.channels[k];
    const std::string table = fmt::format("channel-{}", k + 1), name = printable_line(channel.name);
    const std::vector<std::size_t> turns = corners(channel.values);
    std::vector<double> values;
    for (const std::size_t row : turns) values.push_back(channel.values[row]);
    for (const std::size_t turn : internal::downsampled({&values}, most_rows)) {
      const std::size_t row = turns[turn];
      drawn.tables[table]["x"].push_back(x[row]);
      drawn.tables[table]["y"].push_back(channel.values[row] / (channel.is_voltage ? channel.per_si : 1));
    }
    internal::Chart chart;
    chart.id = table;
    chart.title = name;
    chart.x_column = "x";
    chart.x_label = has_times ? "Time" : "Row";
    chart.x_unit = has_times ? "s" : "";
    chart.y_label = name;
    chart.y_unit = channel.is_voltage ? "V" : printable_line(channel.unit);
    chart.height = height;
    chart.x_home = chart.x_whole = {*first, *last > *first ? *last : *first + 1};
    chart.series.push_back({.table = table, .column = "y", .label = "", .role = internal::Role::best});
    drawn.charts.push_back(std::move(chart));
  }
  return svg_page(printable_line(recording.file), summary(recording), drawn);
}

}  // namespace softland
