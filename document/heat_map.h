// A heat map shows a figure over two variables as colours with contour lines.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "document/chart.h"

namespace softland::internal {

struct HeatMapAxis {
  std::string label;
  std::string unit;            ///< unit; empty: a plain number
  std::vector<double> values;  ///< ascending, at least one
};

struct HeatMap {
  HeatMapAxis x, y;
  std::string label;  ///< label of the figure
  std::string unit;
  std::vector<double> values;  ///< value of cell (i, j) at j * x.values.size() + i; NaN: no value
  /// Reason why a cell has no value, as an index into `reasons`; ignored where the cell has a value.
  std::vector<std::size_t> missing;
  std::vector<std::string> reasons;  ///< "no contact", "not computed"
};

/// Returns the map with at most `most_cells` of its cells, of values in equal distances; its axes say so.
[[nodiscard]] HeatMap thinned_map(HeatMap map, std::size_t most_cells);

/// A line through a map along which a figure has one value, in units of cells: (i, j) is the centre of cell (i, j).
using ContourLine = std::vector<std::array<double, 2>>;

/// Returns the lines of `level` in a map of `columns` cells a row, by linear interpolation between the centres of cells; beside
/// cells without a value there is no line. A closed line ends where it begins.
[[nodiscard]] std::vector<ContourLine> contour_lines(const std::vector<double>& values, std::size_t columns, double level);

/// Returns round values between the least and the largest for about `wanted` contour lines.
[[nodiscard]] std::vector<double> contour_levels(const std::vector<double>& values, int wanted);

/// Tells whether a figure jumps from cell to cell, as chaotic ones do: contour lines would cover the map.
[[nodiscard]] bool is_ragged(const std::vector<double>& values, std::size_t columns);

/// The range of the values that the colours cover, without the two per cent at either end where these stretch it to more than
/// three times its size. Empty ranges are widened.
struct ColourRange {
  double low = 0, high = 1;
  bool cut_below = false, cut_above = false;
};
[[nodiscard]] ColourRange colour_range(const std::vector<double>& values);

/// Draws the map as elements of an SVG `width` wide and heat_map_height() high, with axes, a scale of colours, and marked cells
/// without a value; text and lines carry their own colours.
[[nodiscard]] std::string heat_map_elements(const HeatMap& map, double width);
[[nodiscard]] double heat_map_height(double width);

/// Returns the colour at a part of the scale, 0 to 1, as "#rrggbb": viridis, which stays readable in grey and for the
/// colour-blind.
[[nodiscard]] std::string scale_colour(double part);

}  // namespace softland::internal
