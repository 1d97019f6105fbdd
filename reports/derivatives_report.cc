#include "reports/derivatives_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "reports/json_number.h"
#include "reports/quantity.h"

namespace softland::internal {
namespace {

using nlohmann::json;

const FigureStatistics& statistics_of(const DriveRobustness& drive, std::string_view key) {
  return drive.figures[figure_of(key)];
}

// Per cent of the figure for one per cent of the quantity; NaN where one of them is 0.
double elasticity(const FigureDerivatives& figure, const Derivatives::Variable& variable, double derivative) {
  const double size = figure.value / variable.nominal;
  return size != 0 && std::isfinite(size) ? derivative / size : Metrics::unset;
}

std::string with_sign(const std::string& number, double value) { return (value > 0 ? "+" : "") + number; }

// By how much the spread of the sample and that of first order differ, at the most, where derivatives say something of the
// devices.
constexpr double most_apart = 2;

bool agrees(const FigureDerivatives& figure, const DriveRobustness& drive) {
  const double sampled = statistics_of(drive, figure.key).standard_deviation;
  if (!figure.is_known() || !std::isfinite(sampled)) return figure.is_known();
  return figure.deviation <= most_apart * sampled && sampled <= most_apart * figure.deviation;
}

// "+0.52 %/%, +1.2 µs"
std::string derivative_cell(const Derivatives& derivatives, const DriveRobustness& drive, const FigureDerivatives& figure,
                            std::size_t i) {
  if (!agrees(figure, drive) || !std::isfinite(figure.by_variable[i])) return "—";
  const Derivatives::Variable& variable = derivatives.variables[i];
  const double relative = elasticity(figure, variable, figure.by_variable[i]), step = figure.by_variable[i] * variable.deviation;
  const std::string change = with_sign(quantity(step, figure_of(figure.key).unit), step);
  return std::isfinite(relative) ? with_sign(plain_number(relative), relative) + " %/%, " + change : change;
}

std::string deviation_cell(const FigureDerivatives& figure, double deviation) {
  const bool none = std::ranges::none_of(figure.by_variable, [](double slope) { return std::isfinite(slope); });
  return figure.is_known() && !none ? quantity(deviation, figure_of(figure.key).unit) : "—";
}

// What a derivative says, and what it does not.
std::string meaning_of(const Derivatives& derivatives, const DriveRobustness& drive) {
  std::string words = fmt::format(
      "Exact derivatives at the nominal device under {}: per cent of the figure for one per cent of the quantity, and its change "
      "for one standard deviation. To first order these add up to the spread; a rebound that comes or goes is no small change, "
      "and where the two spreads differ the sample is to be believed.",
      drive.name);
  std::vector<std::string> apart;
  for (const FigureDerivatives& figure : derivatives.figures) {
    if (figure.is_known() && !agrees(figure, drive)) apart.emplace_back(figure_of(figure.key).symbol);
  }
  if (!apart.empty()) {
    words +=
        fmt::format(" Those of {} are not shown: their spread is off by more than a factor of {:g} from that of the devices.",
                    fmt::join(apart, ", "), most_apart);
  }
  if (derivatives.grazes()) {
    words += fmt::format(
        " Grazing: the slowest crossing of the contact plane has {} of the speed of the first touch, so that a touch nearly "
        "comes "
        "or goes, and figures after the first touch keep these derivatives for much smaller changes only.",
        percent(derivatives.grazing));
  }
  for (const Derivatives::Variable& v : derivatives.variables) {
    if (!v.why_none.empty()) words += fmt::format(" {} is left out: {}.", v.name, v.why_none);
  }
  return words;
}

std::string why_no_derivatives(const Derivatives& derivatives) {
  return fmt::format("The figures have no derivatives here: {}.", derivatives.why_none);
}

}  // namespace

json derivatives_json(const Derivatives& derivatives, const DriveRobustness& drive) {
  json variables = json::object(), figures = json::object();
  for (const Derivatives::Variable& v : derivatives.variables) {
    variables[v.name] = {{"nominal", v.nominal}, {"standard_deviation", v.deviation}};
    if (!v.why_none.empty()) variables[v.name]["why_none"] = v.why_none;
  }
  for (const FigureDerivatives& figure : derivatives.figures) {
    json by = json::object();
    for (std::size_t i = 0; i < figure.by_variable.size(); ++i) {
      const Derivatives::Variable& v = derivatives.variables[i];
      by[v.name] = {{"derivative", json_number(figure.by_variable[i])},
                    {"relative", json_number(elasticity(figure, v, figure.by_variable[i]))},
                    {"per_standard_deviation", json_number(figure.by_variable[i] * v.deviation)}};
    }
    json& one = figures[std::string(figure.key)] = {{"nominal", json_number(figure.value)},
                                                    {"by", std::move(by)},
                                                    {"standard_deviation", json_number(figure.deviation)},
                                                    {"error", json_number(figure.error)},
                                                    {"agrees_with_devices", agrees(figure, drive)}};
    if (!figure.why_none.empty()) one["why_none"] = figure.why_none;
  }
  json j{{"drive", drive.name},
         {"grazes", derivatives.grazes()},
         {"slowest_crossing", json_number(derivatives.grazing)},
         {"variables", std::move(variables)},
         {"figures", std::move(figures)}};
  if (!derivatives.why_none.empty()) j["why_none"] = derivatives.why_none;
  return j;
}

ReportSection derivatives_section(const Derivatives& derivatives, const DriveRobustness& drive) {
  ReportSection section{.id = "derivatives", .heading = "To first order", .parts = {}};
  if (derivatives.variables.empty()) return section;
  if (derivatives.figures.empty()) {
    section.parts = {Paragraph{why_no_derivatives(derivatives)}};
    return section;
  }
  ReportTable table{.head = {derivatives.grazes() ? "To first order (grazing)" : "To first order", "Nominal"}, .rows = {}};
  table.head.front().html = "Figure";
  for (const Derivatives::Variable& v : derivatives.variables) table.head.emplace_back(v.name);
  table.head.insert(table.head.end(), {"Standard deviation", "of the devices"});
  for (const FigureDerivatives& figure : derivatives.figures) {
    const Figure& of = figure_of(figure.key);
    TableRow& row = table.rows.emplace_back(TableRow{of.name, quantity(figure.value, of.unit)});
    if (!figure.is_known()) {
      row.emplace_back(figure.why_none, "missing", derivatives.variables.size() + 1);
    } else {
      for (std::size_t i = 0; i < derivatives.variables.size(); ++i)
        row.emplace_back(derivative_cell(derivatives, drive, figure, i));
      row.emplace_back(deviation_cell(figure, figure.deviation));
    }
    row.emplace_back(quantity(statistics_of(drive, figure.key).standard_deviation, of.unit));
  }
  section.parts = {std::move(table), Paragraph{.text = meaning_of(derivatives, drive), .is_note = true}};
  return section;
}

}  // namespace softland::internal
