// Lists the members of the pull-in voltages, and of the stable path by which one electrode or piezo closes the switch, for the
// verbs `pull-in` and `check`: see reports/record.h.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "reports/pull_in_report.h"
#include "reports/study_members.h"

namespace softland {

namespace internal {

/// Writes pull-in, release and collapse voltages by the number of modes; JSON is null if they were not computed.
[[nodiscard]] nlohmann::json voltages_by_modes_json(const std::optional<VoltagesByModes>& found);
[[nodiscard]] std::optional<VoltagesByModes> read_voltages_by_modes(const nlohmann::json& from);

}  // namespace internal

template <class A>
void members(A& a, PullInRecord& found) {
  a("static_V", found.static_pull_in);
  a("static_kind", internal::OrNull{found.static_kind});
  a("deflection_m", found.deflection);
  a("dynamic_V", found.dynamic_pull_in);
  a("dynamic_kind", internal::OrNull{found.dynamic_kind});
  a("release_V", found.release);
  a("pulled_through_V", found.pulled_through);
  if (a.has(std::isfinite(found.neutral))) a("neutral_V", found.neutral);
  a.custom("by_modes", found.by_modes, internal::voltages_by_modes_json, internal::read_voltages_by_modes);
}

template <class A>
void members(A& a, StablePathRecord& path) {
  std::vector<std::string> drives{path.drive};
  if (A::reads) drives.clear();
  a("drives", drives);
  if (!drives.empty()) path.drive = drives.front();
  a("reaches_V", path.reaches);
  a("limit_V", path.limit);
  a("share_of_devices", internal::OrNull{path.share});
}

}  // namespace softland
