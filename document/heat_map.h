// A heat map: colours and contour lines show a figure of merit of the switch over two variables, such as length and gap.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "document/chart.h"

namespace softland::internal {

struct HeatMapAxis {
  std::string label;
  std::string unit;            ///< unit of the variable on an axis of the map; empty: a number without unit
  std::vector<double> values;  ///< values of the variable on an axis of the map, ascending, at least one
};

struct HeatMap {
  HeatMapAxis x, y;
  std::string label;  ///< name of the figure of merit whose values the map shows
  std::string unit;
  std::vector<double> values;  ///< value of cell (i, j) at j * x.values.size() + i; NaN: no value
  /// Reason why a cell has no value, as an index into `reasons`; ignored where the cell has a value.
  std::vector<std::size_t> missing;
  std::vector<std::string> reasons;  ///< texts of the reasons: "no contact", "not computed"
};

/// Returns the map with every n-th column and every m-th row, at most `most_cells` cells; the labels of the axes say so.
[[nodiscard]] HeatMap thinned_map(HeatMap map, std::size_t most_cells);

/// A contour line: points in units of cells, where (i, j) is the centre of cell (i, j).
using ContourLine = std::vector<std::array<double, 2>>;

/// Returns the contour lines of the value `level` in a map with `columns` cells per row. The lines are interpolated linearly
/// between the centres of cells, and end beside cells without a value. A closed line ends where it begins.
[[nodiscard]] std::vector<ContourLine> contour_lines(const std::vector<double>& values, std::size_t columns, double level);

/// Returns about `wanted` round values between the smallest and the largest value, for contour lines.
[[nodiscard]] std::vector<double> contour_levels(const std::vector<double>& values, int wanted);

/// Returns true if the values jump from cell to cell, as figures of chaotic bouncing do. Contour lines would then cover the
/// map.
[[nodiscard]] bool is_ragged(const std::vector<double>& values, std::size_t columns);

/// The range of values that the colour scale covers: all values or, if this would be more than three times as wide, the values
/// without the lowest and the highest 2 %. If all values are equal, the range is widened.
struct ColourRange {
  double low = 0, high = 1;
  bool cut_below = false, cut_above = false;
};
[[nodiscard]] ColourRange colour_range(const std::vector<double>& values);

/// Draws the map as elements of an SVG, `width` wide and heat_map_height() high [px], with axes, a colour scale, and hatched
/// cells where a value is missing. Text and lines carry their own colours.
[[nodiscard]] std::string heat_map_elements(const HeatMap& map, double width);
[[nodiscard]] double heat_map_height(double width);

/// Returns the colour at the position `part`, 0 to 1, of the colour scale viridis, as "#rrggbb". Viridis stays readable in grey
/// and for the colour-blind.
[[nodiscard]] std::string scale_colour(double part);

}  // namespace softland::internal
