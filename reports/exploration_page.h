// The parts of a page on an exploration, computed from its points.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "document/heat_map.h"
#include "reports/exploration_report.h"

namespace softland::internal {

/// Returns the columns that vary, or the figures.
[[nodiscard]] std::vector<std::size_t> columns_of(const ExplorationReport& report, bool variables);

/// A grid of points on all combinations of the values of their variables; some may not be computed.
struct ExploredGrid {
  static constexpr std::size_t nothing = static_cast<std::size_t>(-1);

  std::vector<std::size_t> variables;       ///< columns that take more than one value
  std::vector<std::vector<double>> values;  ///< values of each variable, ascending
  std::vector<std::size_t> points;          ///< index of the point in the report at each combination, the last variable fastest
  /// Returns the index of the point's value in the values of every variable.
  [[nodiscard]] std::vector<std::size_t> place(const ExploredPoint& point) const;
};
/// Returns none where the points are not a grid: fewer than half of the combinations of at least two variables, or a
/// combination twice.
[[nodiscard]] std::optional<ExploredGrid> grid_of(const ExplorationReport& report);

/// Makes the map of a figure; the other variables of the grid stand at the middle one of their values.
[[nodiscard]] HeatMap heat_map_of(const ExplorationReport& report, const ExploredGrid& grid, std::size_t x, std::size_t y,
                                  std::size_t figure);

/// The distribution of a figure over all points at one value of a variable, or in an interval of its values.
struct EffectBin {
  double at = 0;  ///< value, or the middle one of the points there
  std::size_t points = 0;
  std::array<double, 5> quantiles{};  ///< 5, 25, 50, 75, 95 % quantiles of the figure; NaN without points
};
/// Returns bins at the values of the variable where these are few, else in intervals of equally many points. Points without the
/// figure are left out.
[[nodiscard]] std::vector<EffectBin> effect_of(const ExplorationReport& report, std::size_t variable, std::size_t figure);

/// Returns a value of a column in words, with a suitable prefix where its unit takes one.
[[nodiscard]] std::string explored_text(const ExploredColumn& column, double value, int digits = 4);

/// Returns the figure to show first: the impact velocity, or the first that is known and not everywhere the same.
[[nodiscard]] std::size_t leading_figure(const ExplorationReport& report);

/// Columns and points for the script, thinned to what fits.
struct ExplorationData {
  nlohmann::json json;
  std::string thinning;  ///< rule of the thinning, in words; empty: all points are there
};
[[nodiscard]] ExplorationData exploration_data(const ExplorationReport& report, const std::optional<ExploredGrid>& grid,
                                               const ExploredFront& front);

}  // namespace softland::internal
