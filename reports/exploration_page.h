// The parts of a page on an exploration of a design space, computed from its points, the simulated variants of a scene.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "document/heat_map.h"
#include "reports/exploration_report.h"

namespace softland::internal {

/// Returns the columns of an exploration's varying variables if `variables` is true, else the columns of its figures of merit.
[[nodiscard]] std::vector<std::size_t> columns_of(const ExplorationReport& report, bool variables);

/// A grid of points: all combinations of the values of several variables; some points may not be computed.
struct ExploredGrid {
  static constexpr std::size_t nothing = static_cast<std::size_t>(-1);

  std::vector<std::size_t> variables;       ///< columns of the variables that take more than one value
  std::vector<std::vector<double>> values;  ///< values of each variable of the grid, ascending
  std::vector<std::size_t> points;          ///< index in the report of the point at each combination, the last variable fastest
  /// Returns the position of a point in the grid: an index into the values of each variable.
  [[nodiscard]] std::vector<std::size_t> place(const ExploredPoint& point) const;
};
/// Returns the grid of the points; none if the points are no grid: fewer than half of the combinations of at least two
/// variables, or a combination that occurs twice.
[[nodiscard]] std::optional<ExploredGrid> grid_of(const ExplorationReport& report);

/// Makes the map of a figure of merit over two variables; each other variable of the grid has the middle one of its values.
[[nodiscard]] HeatMap heat_map_of(const ExplorationReport& report, const ExploredGrid& grid, std::size_t x, std::size_t y,
                                  std::size_t figure);

/// The distribution of a figure of merit over all points at one value of a variable, or in an interval of its values.
struct EffectBin {
  double at = 0;  ///< value of the variable at the bin, or the middle one of the points in its interval
  std::size_t points = 0;
  std::array<double, 5> quantiles{};  ///< 5, 25, 50, 75, 95 % quantiles of the figure in the bin; NaN without points
};
/// Returns the distribution of a figure of merit over a variable: one bin per value of the variable if the values are few,
/// otherwise intervals with equally many points. Points without the figure are left out.
[[nodiscard]] std::vector<EffectBin> effect_of(const ExplorationReport& report, std::size_t variable, std::size_t figure);

/// Returns a value of a column as text, with an SI prefix if its unit has prefixes.
[[nodiscard]] std::string explored_text(const ExploredColumn& column, double value, int digits = 4);

/// Returns the figure of merit to show first: the impact velocity, or else the first figure with two different values.
[[nodiscard]] std::size_t leading_figure(const ExplorationReport& report);

/// Columns and points for the script of a page, thinned to the size limit of the page.
struct ExplorationData {
  nlohmann::json json;
  std::string thinning;  ///< rule by which points were left out, in words; empty: no point was left out
};
[[nodiscard]] ExplorationData exploration_data(const ExplorationReport& report, const std::optional<ExploredGrid>& grid,
                                               const ExploredFront& front);

}  // namespace softland::internal
