#include "reports/derivatives_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "document/quantity.h"
#include "reports/robustness_prose.h"

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

}  // namespace softland::internal
