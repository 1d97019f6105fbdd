// The aims of a front of an exploration: figures that are to be small, or large.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "store/study_store.h"

namespace softland {

/// A variable or a figure of an exploration.
struct ExploredColumn {
  std::string key;   ///< key in options and files: "impact_velocity_m_s"
  std::string name;  ///< name for people: "Impact speed", or the key of the scene
  std::string unit;  ///< SI unit; empty: a plain number
  bool is_variable = false;
};
[[nodiscard]] std::vector<ExploredColumn> explored_columns(const StoredPlan& plan);

/// A figure that is to be small, or large.
struct ExploredAim {
  std::size_t column = 0;
  bool is_largest = false;
};
/// Prefix of a figure that is to be large.
inline constexpr std::string_view largest_mark = "max:";

/// True if this is the name of a column: its key, its key without the unit, or its name for people.
[[nodiscard]] bool goes_by(const ExploredColumn& column, const std::string& name);

/// The aims that a list names: "impact_velocity,max:bounce_free". Throws InvalidRequest of the field `pareto` for a name that
/// is not a figure or occurs twice, and for fewer than two.
[[nodiscard]] std::vector<ExploredAim> explored_aims(const std::vector<ExploredColumn>& columns, const std::string& list);

/// True if a point with this status may lead a front: a closing that still bounces when the window ends must not beat others.
[[nodiscard]] bool may_lead(std::string_view status);

}  // namespace softland
