// Windows of hold levels that keep devices closed: above the release voltage of each device, and below its collapse voltage,
// above which the beam collapses onto the electrode.
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <span>
#include <string>

#include "base/progress.h"
#include "studies/closing/closed_state.h"
#include "studies/devices/robustness.h"

namespace softland {

/// Share of the devices that a window of hold levels must keep closed.
inline constexpr double held_share = 0.99;
/// Largest number of devices for a window of hold levels: computing the collapse voltage of a device takes long.
inline constexpr std::uint64_t most_held_devices = 200;

struct HoldWindow {
  /// Hold levels between which at least held_share of the devices stay closed [V]. Both are NaN if no such level exists.
  /// `upper` is infinite if at least held_share of the devices do not collapse at any voltage.
  double lower = std::numeric_limits<double>::quiet_NaN(), upper = lower;
};

struct HoldWindows {
  std::map<std::string, HoldWindow> of_electrodes;  ///< windows of hold levels by electrode that pulls towards the contact
  std::size_t devices = 0;                          ///< number of devices from which the windows are computed
};

/// Returns the window of hold levels for devices with these ranges between release and collapse voltage. No level keeps a
/// device without a release voltage closed. A device without a collapse voltage has no upper limit.
[[nodiscard]] HoldWindow hold_window(std::span<const ClosedRange> devices);

/// Returns the windows of hold levels [V] for the first devices of robustness() under the same options; calibrations are
/// ignored. Every other drive is at its bias for pull-in voltages. A device with impossible values counts as not held at any
/// level. Returns no windows if the scene has no contact, or if `progress` asks to stop.
[[nodiscard]] HoldWindows hold_windows(const PreparedScene& nominal, const RobustnessOptions& options,
                                       const Progress& progress = {});

}  // namespace softland
