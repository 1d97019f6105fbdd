// Columns of tables and database files: figures of merit and searched parameters.
#pragma once

#include <cmath>
#include <string>

#include "objectives/figures.h"

namespace softland {

/// A column of numbers in a table: a figure of merit or a searched parameter.
struct PointFigure {
  std::string quantity;  ///< key of the figure or parameter: "impact_velocity"
  std::string name;      ///< displayed name of the figure or parameter: "Impact velocity"
  std::string unit;      ///< SI unit of the figure or parameter; empty for a count, a share, and true or false (1 or 0)
};

/// Returns the column of a searched parameter: "main.level_1_V" gives "main.level_1" in V.
[[nodiscard]] PointFigure parameter_figure(const std::string& name);
/// Returns the column of a figure of merit, with the prefix `before` for `quantity` and the suffix `words` for `name`.
[[nodiscard]] PointFigure figure_column(const Figure& figure, const std::string& before = {}, const std::string& words = {});
/// Returns a value as a store keeps it: one that is not finite becomes Metrics::unset.
[[nodiscard]] inline double stored_value(double value) { return std::isfinite(value) ? value : Metrics::unset; }

}  // namespace softland
