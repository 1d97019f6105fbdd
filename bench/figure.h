// Charts and tables of studies for results/, in the style of the reports.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "document/chart.h"

namespace softland {

using Points = std::vector<std::array<double, 2>>;  // x, y in SI units; a y that is not finite is left out

struct Curve {
  std::string label;  ///< name in the legend
  Points points;
  internal::Role pen = internal::Role::best;  ///< colour of the curve; evaluations are drawn as dots
};

/// Axes with curves. Units get their SI prefix from the values; an empty unit is a plain number.
struct Panel {
  std::string title;
  std::string x_label, x_unit;
  std::string y_label, y_unit;
  std::vector<Curve> curves;
  internal::AxisScale scale = internal::AxisScale::linear;
};

/// Returns an SVG document: a headline, a subtitle, and the panels row by row.
[[nodiscard]] std::string figure(const std::string& headline, const std::string& words, const std::vector<Panel>& panels,
                                 std::size_t per_row = 2);

/// Returns a table in Markdown; the first row is its head.
[[nodiscard]] std::string markdown_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace softland
