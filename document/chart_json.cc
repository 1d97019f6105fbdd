// Writes charts as JSON for the script of a page.
#include "document/chart_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "document/downsample.h"
#include "document/quantity.h"

namespace softland::internal {
namespace {

using nlohmann::json;

const char* role_name(Role role) {
  switch (role) {
    case Role::best:
      return "best";
    case Role::baseline:
      return "baseline";
    case Role::third:
      return "third";
    case Role::fourth:
      return "fourth";
    case Role::fifth:
      return "fifth";
    case Role::limit:
      return "limit";
    case Role::evaluations:
    case Role::measured:
    case Role::device:
    case Role::device_before:
      break;
  }
  return "evaluations";
}

const char* scale_name(AxisScale scale) { return scale == AxisScale::linear ? "linear" : "log"; }

// Returns the values of a column in the given rows as JSON: integer steps from packed(), or numbers of six digits if
// `logarithmic`. On a logarithmic axis, rounding to steps of equal size would hide small values.
json rows_json(const std::vector<double>& column, const std::vector<std::size_t>& rows, bool logarithmic) {
  std::vector<double> kept;
  double largest = 0;
  for (const std::size_t row : rows) {
    kept.push_back(column[row]);
    if (std::isfinite(column[row])) largest = std::max(largest, std::abs(column[row]));
  }
  constexpr double resolution = 1e-7;
  if (!logarithmic) return packed(kept, largest * resolution);
  json values = json::array();
  for (const double value : kept) values.push_back(std::isfinite(value) ? json::parse(fmt::format("{:.6g}", value)) : json());
  return {{"values", values}};
}

}  // namespace

json packed(const std::vector<double>& column, double unit) {
  if (!(unit > 0)) unit = 1;
  json steps = json::array();
  long long before = 0;
  for (const double value : column) {
    if (!std::isfinite(value)) {
      steps.push_back(nullptr);
      continue;
    }
    const long long now = std::llround(value / unit);
    steps.push_back(now - before);
    before = now;
  }
  return {{"unit", unit}, {"steps", steps}};
}

json chart_json(const Picture& picture, std::size_t rows) {
  json tables = json::object();
  std::set<std::string> logarithmic;  // names of the curve tables in charts with a logarithmic x axis
  for (const Chart& chart : picture.charts) {
    if (chart.x_scale == AxisScale::linear) continue;
    for (const Series& one : chart.series) logarithmic.insert(one.table);
  }
  for (const auto& [name, table] : picture.tables) {
    std::vector<const std::vector<double>*> columns;
    for (const auto& [key, column] : table) columns.push_back(&column);
    const std::vector<std::size_t> kept = downsampled(columns, rows);
    for (const auto& [key, column] : table)
      tables[name][key] =
          rows_json(column, kept, logarithmic.contains(name) || key == "value" || key == "contact_resistance_ohm");
  }
  json charts = json::array();
  for (const Chart& chart : picture.charts) {
    json series = json::array();
    for (const Series& one : chart.series) {
      series.push_back({{"table", one.table}, {"column", one.column}, {"label", one.label}, {"role", role_name(one.role)}});
    }
    json marks = json::array();
    for (const Mark& mark : chart.marks)
      marks.push_back({{"x", mark.x}, {"y", mark.y}, {"role", role_name(mark.role)}, {"text", mark.text}});
    charts.push_back({{"id", chart.id},
                      {"group", chart.group},
                      {"height", chart.height},
                      {"x",
                       {{"column", chart.x_column},
                        {"label", chart.x_label},
                        {"unit", chart.x_unit},
                        {"least", resolution(chart.x_unit)},
                        {"scale", scale_name(chart.x_scale)},
                        {"home", chart.x_home},
                        {"whole", chart.x_whole}}},
                      {"y",
                       {{"label", chart.y_label},
                        {"unit", chart.y_unit},
                        {"least", resolution(chart.y_unit)},
                        {"scale", scale_name(chart.scale)}}},
                      {"bars", chart.is_of_bars},
                      {"steps", chart.is_of_steps},
                      {"zero", chart.zero_line},
                      {"zeroLabel", chart.zero_label},
                      {"zeroLabelLeft", chart.zero_label_left},
                      {"series", series},
                      {"marks", marks}});
    if (chart.y_home) charts.back()["y"]["home"] = *chart.y_home;
  }
  return {{"tables", tables}, {"charts", charts}};
}

}  // namespace softland::internal
