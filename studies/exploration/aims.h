// What a front of an exploration is of: figures that are to be small, or large.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "store/study_store.h"

namespace softland {

/// Something that varies, or a figure.
struct ExploredColumn {
  std::string key;   ///< what options and files call it: "impact_velocity_m_s"
  std::string name;  ///< for people: "Impact speed", or the key of the scene
  std::string unit;  ///< of SI; empty: a plain number
  bool is_variable = false;
};
[[nodiscard]] std::vector<ExploredColumn> explored_columns(const StoredPlan& plan);

/// A figure that is to be small, or large.
struct ExploredAim {
  std::size_t column = 0;
  bool is_largest = false;
};
/// What stands before a figure that is to be large.
inline constexpr std::string_view largest_mark = "max:";

/// Whether this is the name of a column: its key, its key without the unit, or its name for people.
[[nodiscard]] bool goes_by(const ExploredColumn& column, const std::string& name);

/// The aims that a list names: "impact_velocity,max:bounce_free". Throws InvalidRequest of the field `pareto` for a name that is
/// no figure or stands twice, and for fewer than two.
[[nodiscard]] std::vector<ExploredAim> explored_aims(const std::vector<ExploredColumn>& columns, const std::string& list);

/// Whether a point that ended so may stand on a front: what bounces on when the window ends is no closing that others fall short
/// of.
[[nodiscard]] bool may_lead(std::string_view status);

}  // namespace softland
