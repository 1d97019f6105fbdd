#include "reports/device_gaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "document/escape.h"
#include "document/page.h"
#include "document/svg.h"
#include "reports/closing_charts.h"
#include "reports/devices_report.h"
#include "sampling/statistics.h"

namespace softland {
namespace {

using namespace internal;

// Returns true if every device has a contact gap at every instant; a damaged file may lack gaps.
bool is_drawable(const DevicesFindings::Courses& courses) {
  if (!(courses.end > 0 && courses.unit > 0) || courses.step.empty() || courses.own.empty()) return false;
  const std::size_t instants = courses.step.front().size();
  const auto has_all = [instants](const std::vector<int>& gap) { return gap.size() == instants; };
  return instants > 1 && std::ranges::all_of(courses.step, has_all) && std::ranges::all_of(courses.own, has_all);
}

// Returns a table of contact gaps over time with the columns "time", "low" (5th percentile over the devices), "high" (95th),
// "median", and one for each device.
CurveTable courses_table(const DevicesFindings::Courses& courses, const std::vector<std::vector<int>>& gaps) {
  CurveTable table;
  const std::size_t instants = gaps.front().size();
  for (std::size_t i = 0; i < instants; ++i) {
    table["time"].push_back(courses.end * static_cast<double>(i) / static_cast<double>(instants - 1));
    std::vector<double> all;
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      all.push_back(courses.unit * gaps[k].at(i));
      table[std::to_string(k)].push_back(all.back());
    }
    table["median"].push_back(sample_quantile(all, 0.5));
    table["low"].push_back(sample_quantile(all, 0.05));
    table["high"].push_back(sample_quantile(all, 0.95));
  }
  return table;
}

}  // namespace

Picture internal::gaps_picture(const DevicesFindings& d) {
  Picture drawn;
  if (!d.courses || !is_drawable(*d.courses)) return drawn;
  const DevicesFindings::Courses& courses = *d.courses;
  const auto add = [&](const char* id, const char* title, const std::vector<std::vector<int>>& gaps, Role thin, Role band) {
    drawn.tables[id] = courses_table(courses, gaps);
    Chart chart{.id = id,
                .title = title,
                .caption = fmt::format("Gap of the contact on {} devices: median, and band from the 5th to the 95th percentile.",
                                       gaps.size()),
                .x_column = "time",
                .x_label = "Time",
                .x_unit = "s",
                .y_label = "Gap",
                .y_unit = "m",
                .x_home = {0, courses.end},
                .x_whole = {0, courses.end},
                .zero_line = true,
                .zero_label = "contact",
                .height = 220,
                .bands = {{.table = id, .low = "low", .high = "high", .role = band}}};
    for (std::size_t k = 0; k < gaps.size(); ++k)
      chart.series.push_back({.table = id, .column = std::to_string(k), .label = "", .role = thin});
    chart.series.push_back({.table = id, .column = "median", .label = "", .role = band});
    drawn.charts.push_back(std::move(chart));
  };
  add("devices-step", "Plain step", courses.step, Role::device_before, Role::baseline);
  add("devices-best", d.choices.empty() ? "best.toml" : "default: best.toml", courses.own, Role::device, Role::best);
  std::array<double, 2> home{0, 0};
  for (const auto& [id, table] : drawn.tables) {
    for (const auto& [name, column] : table) {
      if (name == "time") continue;
      const auto [low, high] = std::ranges::minmax(column);
      home = {std::min(home[0], low), std::max(home[1], high)};
    }
  }
  const double margin = 0.06 * (home[1] - home[0]);
  for (Chart& chart : drawn.charts) chart.y_home = {home[0] - 2 * margin, home[1] + margin};
  return drawn;
}

std::string internal::gaps_html(const DevicesFindings& d) {
  const Picture drawn = gaps_picture(d);
  if (drawn.charts.empty()) return {};
  std::string pictures;
  for (const Chart& chart : drawn.charts) pictures += small_picture(drawn.tables, chart);
  return fmt::format("<div class=\"multiples\">\n{}</div>\n<p class=\"below\">{}</p>\n", pictures,
                     escaped(drawn.charts.front().caption));
}

std::string svg_devices(const ClosingRecord& result) {
  Picture drawn = gaps_picture(*result.devices());
  const std::string words = drawn.charts.empty() ? result.title : result.title + ". " + drawn.charts.front().caption;
  // Add the waveforms of the drives below the charts of the contact gaps.
  Picture others = gap_and_drives(result);
  for (Chart& chart : others.charts) {
    if (!chart.id.starts_with("drive")) continue;
    if (result.devices()->courses) chart.x_home = {0, result.devices()->courses->end};
    for (Series& one : chart.series) {
      // A chart of half the page width is too narrow for the label of a voltage limit.
      if (one.role == Role::limit) one.label.clear();
    }
    drawn.charts.push_back(std::move(chart));
  }
  drawn.tables.merge(others.tables);
  return svg_page(devices_headline(result), words, drawn, 2);
}

}  // namespace softland
