// Columns of tables and stores that hold figures of merit and searched parameters.
#pragma once

#include <string>

#include "objectives/figures.h"

namespace softland {

/// A column of figures.
struct PointFigure {
  std::string quantity;  ///< "impact_velocity"
  std::string name;      ///< name for people: "Impact speed"
  std::string unit;      ///< SI unit; empty for a count, a share, yes or no (1 or 0)
};

/// Column of a searched parameter: "main.level_1_V" is "main.level_1" in V.
[[nodiscard]] PointFigure parameter_figure(const std::string& name);
/// Column of a figure of merit, with prefixes of its quantity and additions to its name.
[[nodiscard]] PointFigure figure_column(const Figure& figure, const std::string& before = {}, const std::string& words = {});

}  // namespace softland
