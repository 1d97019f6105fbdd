// Pictures and tables of studies for results/, drawn as the reports draw theirs.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "document/chart.h"

namespace softland {

using Points = std::vector<std::array<double, 2>>;  // x, y in SI units; a y that is not finite is left out

struct Curve {
  std::string label;  ///< a few words
  Points points;
  internal::Role pen = internal::Role::best;  ///< evaluations: dots
};

/// Axes with curves. Units get their SI prefix from the values; an empty unit is a plain number.
struct Panel {
  std::string title;
  std::string x_label, x_unit;
  std::string y_label, y_unit;
  std::vector<Curve> curves;
  internal::Scale scale = internal::Scale::linear;
};

/// An SVG document: a headline, smaller words, and the panels row by row.
[[nodiscard]] std::string figure(const std::string& headline, const std::string& words, const std::vector<Panel>& panels,
                                 std::size_t per_row = 2);

/// Rows of a table in Markdown; the first is the head.
[[nodiscard]] std::string markdown_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace softland
