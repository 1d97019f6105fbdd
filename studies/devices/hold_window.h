// Windows of hold levels that keep devices closed: above the release voltage of each device, and below its collapse voltage,
// from which on the beam collapses onto the electrode.
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

/// Share of the devices that a window of hold levels keeps closed.
inline constexpr double held_share = 0.99;
/// Largest number of devices for a window: finding the collapse voltage of a device takes long.
inline constexpr std::uint64_t most_held_devices = 200;

struct HoldWindow {
  /// Hold levels between which at least held_share of the devices stay closed [V]. NaN if there is no such level. `upper` is
  /// infinite if at least held_share of the devices do not collapse at any voltage.
  double lower = std::numeric_limits<double>::quiet_NaN(), upper = lower;
};

struct HoldWindows {
  std::map<std::string, HoldWindow> of_electrodes;  ///< windows of the electrodes that pull towards the contact
  std::size_t devices = 0;                          ///< number of devices
};

/// Returns the window of devices with these ranges. A device without a release voltage is held by no level. One without a
/// collapse voltage has no upper limit.
[[nodiscard]] HoldWindow hold_window(std::span<const ClosedRange> devices);

/// Returns the windows of the first devices of robustness() under the same options, in volts, whatever their calibration. The
/// other drives have the levels that they have for pull-in voltages. No level holds a device that cannot be described. No
/// windows are returned if the scene has no contact, or if `progress` asks to stop.
[[nodiscard]] HoldWindows hold_windows(const PreparedScene& nominal, const RobustnessOptions& options,
                                       const Progress& progress = {});

}  // namespace softland
