// Lists the members of the pull-in voltages, and of the stable path by which one electrode or piezo closes the switch, for the
// verbs `pull-in` and `check`: see reports/record.h.
#pragma once

#include <cmath>
#include <map>
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

inline void members(internal::Archive& a, PullInRecord& found) {
  a("static_V", found.static_pull_in, "static pull-in voltage");
  a("static_kind", internal::OrNull{found.static_kind}, "how the stable equilibrium ends: `fold` or `contact`");
  a("deflection_m", found.deflection, "deflection of the contact point at the static voltage");
  a("dynamic_V", found.dynamic_pull_in, "dynamic pull-in voltage");
  a("dynamic_kind", internal::OrNull{found.dynamic_kind},
    "`overshoot`; `overdamped`: equals the static voltage; `unstable_rest`: no step moves the switch");
  a("release_V", found.release, "release voltage");
  a("pulled_through_V", found.pulled_through, "voltage at which the closed structure collapses onto the electrode");
  if (a.has(std::isfinite(found.neutral))) a("neutral_V", found.neutral, "voltage without a field, for a charged dielectric");
  a.custom("by_modes", found.by_modes, internal::voltages_by_modes_json, internal::read_voltages_by_modes,
           internal::Like<std::map<std::string, std::map<std::string, double>>>{
               "each voltage by number of modes, `converged`: extrapolated; null for a plate and a table of modes"});
}

inline void members(internal::Archive& a, StablePathRecord& path) {
  std::vector<std::string> drives{path.drive};
  if (a.reads()) drives.clear();
  a("drives", drives, "drive that moves the switch to its contact");
  if (!drives.empty()) path.drive = drives.front();
  a("reaches_V", path.reaches, "level at which the nominal design touches");
  a("limit_V", path.limit, "limit of the voltage source");
  a("share_of_devices", internal::OrNull{path.share},
    "share of the devices of [spread] that reach the contact by this drive alone");
}

}  // namespace softland
