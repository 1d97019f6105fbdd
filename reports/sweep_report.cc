#include "reports/sweep_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "reports/chart.h"
#include "reports/json_number.h"
#include "reports/quantity.h"
#include "reports/svg.h"

namespace softland {
namespace {

using internal::quantity;

std::string csv_cell(double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string(); }

std::string_view branch_name(const SweepPoint& p) { return p.is_up ? "up" : "down"; }

// The columns of one branch, in rising order of the voltage.
internal::CurveTable branch_of(std::vector<SweepPoint> points, bool is_up) {
  std::erase_if(points, [&](const SweepPoint& p) { return p.is_up != is_up || p.state == SweepState::none; });
  std::stable_sort(points.begin(), points.end(), [](const SweepPoint& a, const SweepPoint& b) { return a.voltage < b.voltage; });
  internal::CurveTable columns{{"voltage", {}}, {"deflection", {}}, {"capacitance", {}}};
  for (const SweepPoint& p : points) {
    columns["voltage"].push_back(p.voltage);
    columns["deflection"].push_back(p.deflection);
    columns["capacitance"].push_back(p.capacitance);
  }
  return columns;
}

internal::Chart sweep_chart(const std::string& column, const std::string& title, const std::string& unit, double low,
                            double high) {
  internal::Chart chart{.id = column,
                        .title = title,
                        .x_column = "voltage",
                        .x_label = "voltage",
                        .x_unit = "V",
                        .y_label = column,
                        .y_unit = unit,
                        .x_home = {low, high},
                        .x_whole = {low, high}};
  chart.series = {{.table = "up", .column = column, .label = "up"},
                  {.table = "down", .column = column, .label = "down", .role = internal::Role::baseline}};
  return chart;
}

}  // namespace

std::string sweep_csv(const std::vector<SweepPoint>& points) {
  std::string text = "voltage_V,deflection_m,capacitance_F,branch,status\n";
  for (const SweepPoint& p : points)
    text += fmt::format("{},{},{},{},{}\n", p.voltage, csv_cell(p.deflection), csv_cell(p.capacitance), branch_name(p),
                        to_string(p.state));
  return text;
}

nlohmann::json sweep_json(const std::vector<SweepPoint>& points) {
  nlohmann::json rows = nlohmann::json::array();
  for (const SweepPoint& p : points)
    rows.push_back({{"voltage_V", p.voltage},
                    {"deflection_m", internal::json_number(p.deflection)},
                    {"capacitance_F", internal::json_number(p.capacitance)},
                    {"branch", branch_name(p)},
                    {"status", to_string(p.state)}});
  return rows;
}

std::string sweep_svg(const std::vector<SweepPoint>& points, const std::string& of, const StaticPullIn& pull_in, double release) {
  const auto [least, most] = std::minmax_element(points.begin(), points.end(),
                                                 [](const SweepPoint& a, const SweepPoint& b) { return a.voltage < b.voltage; });
  internal::Picture picture{.tables = {{"up", branch_of(points, true)}, {"down", branch_of(points, false)}}, .charts = {}};
  for (const auto& [column, title, unit] : {std::array{"deflection", "Deflection of the contact point", "m"},
                                            std::array{"capacitance", "Capacitance of the electrode", "F"}})
    picture.charts.push_back(sweep_chart(column, title, unit, least->voltage, most->voltage));
  if (pull_in.voltage <= most->voltage)
    picture.charts.front().marks.push_back({pull_in.voltage, pull_in.deflection, internal::Role::best, "pull-in"});
  std::string words =
      std::isfinite(pull_in.voltage)
          ? fmt::format("Pull-in at {}, deflected by {}", quantity(pull_in.voltage, "V", 4), quantity(pull_in.deflection, "m", 4))
          : std::string("No pull-in voltage");
  if (std::isfinite(release)) words += fmt::format("; release at {}", quantity(release, "V", 4));
  return svg_page(of, words + ".", picture, 1);
}

}  // namespace softland
