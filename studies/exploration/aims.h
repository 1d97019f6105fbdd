// The aims of an exploration that searches a Pareto front: figures to minimise or to maximise.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "store/study_store.h"

namespace softland {

/// A variable or a figure of an exploration: a column of its table.
struct ExploredColumn {
  std::string key;   ///< key of the column in options and files, such as "impact_velocity_m_s"
  std::string name;  ///< displayed name of the column, such as "Impact velocity", or the key of the scene
  std::string unit;  ///< SI unit of the column; empty for a dimensionless number
  bool is_variable = false;
};
[[nodiscard]] std::vector<ExploredColumn> explored_columns(const StoredPlan& plan);

/// A figure of an exploration that is minimised or maximised.
struct ExploredAim {
  std::size_t column = 0;
  bool is_largest = false;
};
/// Prefix of the name of a figure that is maximised, in a list of figures.
inline constexpr std::string_view largest_mark = "max:";

/// True if `name` identifies the column: it is the column's key, the key without the unit, or the displayed name.
[[nodiscard]] bool goes_by(const ExploredColumn& column, const std::string& name);

/// Returns the figures to minimise or maximise (aims) in a list such as "impact_velocity,max:bounce_free". Throws
/// InvalidRequest about the field `pareto` for a name that is not a figure or occurs twice, and for fewer than two aims.
[[nodiscard]] std::vector<ExploredAim> explored_aims(const std::vector<ExploredColumn>& columns, const std::string& list);

/// True if a point with this status may be on a Pareto front. A closing that still bounces at the end of its simulated time may
/// not.
[[nodiscard]] bool may_lead(std::string_view status);

}  // namespace softland
