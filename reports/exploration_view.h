// What a page shows of an exploration, told from its points.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "reports/exploration_report.h"
#include "reports/heat_map.h"

namespace softland::internal {

/// Columns that vary, or are figures.
[[nodiscard]] std::vector<std::size_t> columns_of(const ExplorationReport& report, bool variables);

/// Points that lie on all combinations of the values of their variables, but for some that are not computed.
struct ExploredGrid {
  static constexpr std::size_t nothing = static_cast<std::size_t>(-1);

  std::vector<std::size_t> variables;       ///< columns that take more than one value
  std::vector<std::vector<double>> values;  ///< of each, ascending
  std::vector<std::size_t> points;          ///< number of the point in the report at each combination, the last variable fastest
  /// Of a point in the report, the number of its value of every variable.
  [[nodiscard]] std::vector<std::size_t> place(const ExploredPoint& point) const;
};
/// None where the points are no grid: fewer than half of the combinations of at least two variables, or a combination twice.
[[nodiscard]] std::optional<ExploredGrid> grid_of(const ExplorationReport& report);

/// The map of a figure; the other variables of the grid stand at the middle one of their values.
[[nodiscard]] HeatMap heat_map_of(const ExplorationReport& report, const ExploredGrid& grid, std::size_t x, std::size_t y,
                                  std::size_t figure);

/// How a figure is distributed over all points at one value of a variable, or in an interval of its values.
struct EffectBin {
  double at = 0;  ///< the value, or the middle one of the points there
  std::size_t points = 0;
  std::array<double, 5> quantiles{};  ///< 5, 25, 50, 75, 95 % of the figure; NaN without points
};
/// At the values of the variable where these are few, else in intervals of equally many points. Points without the figure are
/// left out.
[[nodiscard]] std::vector<EffectBin> effect_of(const ExplorationReport& report, std::size_t variable, std::size_t figure);

/// A value of a column in words: with the prefix that suits it where its unit takes one.
[[nodiscard]] std::string explored_text(const ExploredColumn& column, double value, int digits = 4);

/// The figure that is looked at first: the impact speed or the first that is known and not everywhere the same.
[[nodiscard]] std::size_t leading_figure(const ExplorationReport& report);

/// Columns and points for the script, thinned to what fits.
struct ExplorationData {
  nlohmann::json json;
  std::string thinning;  ///< how, in words; empty: all points are there
};
[[nodiscard]] ExplorationData exploration_data(const ExplorationReport& report, const std::optional<ExploredGrid>& grid,
                                               const ExploredFront& front);

}  // namespace softland::internal
