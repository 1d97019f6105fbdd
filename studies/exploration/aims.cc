#include "studies/exploration/aims.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/printable.h"
#include "base/require.h"
#include "base/split.h"

namespace softland {

std::vector<ExploredColumn> explored_columns(const StoredPlan& plan) {
  std::vector<ExploredColumn> columns;
  for (const StoredColumn& c : plan.columns) columns.push_back({c.key, c.name, c.unit, c.kind == ColumnKind::variable});
  return columns;
}

bool goes_by(const ExploredColumn& column, const std::string& name) {
  const std::string& key = column.key;
  const bool without_unit =
      !column.unit.empty() && key.starts_with(name + "_") && key.size() - name.size() <= column.unit.size() + 1;
  return key == name || column.name == name || without_unit;
}

std::vector<ExploredAim> explored_aims(const std::vector<ExploredColumn>& columns, const std::string& list) {
  std::vector<ExploredAim> aims;
  for (std::string name : split(list, ',')) {
    ExploredAim aim{.is_largest = name.starts_with(largest_mark)};
    if (aim.is_largest) name.erase(0, largest_mark.size());
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const ExploredColumn& c) { return !c.is_variable && goes_by(c, name); });
    std::vector<std::string> there;
    for (const ExploredColumn& c : columns) {
      if (!c.is_variable) there.push_back(c.key);
    }
    require_field(!name.empty() && found != columns.end(), "pareto", list, [&] {
      return fmt::format("\"{}\" is not among the figures: {}", printable_line(name), fmt::join(there, ", "));
    });
    aim.column = static_cast<std::size_t>(found - columns.begin());
    require_field(std::none_of(aims.begin(), aims.end(), [&](const ExploredAim& other) { return other.column == aim.column; }),
                  "pareto", list, [&] { return fmt::format("{} occurs twice", name); });
    aims.push_back(aim);
  }
  require_field(aims.size() >= 2, "pareto", list, [] { return "a front needs at least two figures"; });
  return aims;
}

bool may_lead(std::string_view status) { return status == "done"; }

}  // namespace softland
