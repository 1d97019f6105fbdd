// Hold levels that keep devices closed: above the release voltage of each, and below the voltage from which on it collapses
// onto the electrode.
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <span>
#include <string>

#include "base/watch.h"
#include "studies/closing/closed_state.h"
#include "studies/devices/robustness.h"

namespace softland {

/// Share of the devices that a window of hold levels keeps closed.
inline constexpr double held_share = 0.99;
/// Most devices for a window: an equilibrium of each is followed up to its collapse.
inline constexpr std::uint64_t most_held_devices = 200;

struct HoldWindow {
  /// Hold levels between which at least held_share of the devices stay closed [V]; `upper` is infinite if so many collapse at
  /// no voltage. NaN if no such level exists.
  double lower = std::numeric_limits<double>::quiet_NaN(), upper = lower;
};

struct HoldWindows {
  std::map<std::string, HoldWindow> of_electrodes;  ///< windows of the electrodes that pull towards the contact
  std::size_t devices = 0;                          ///< number of devices
};

/// Returns the window of devices that are held within these ranges. A range without a release voltage holds nothing; one
/// without a collapse voltage has no upper end.
[[nodiscard]] HoldWindow hold_window(std::span<const ClosedRange> devices);

/// Returns windows of the first devices that robustness() has judged under the same options, in volts, whatever their
/// calibration. The other drives stand as for the pull-in voltages. A device that cannot be described is held by nothing. None
/// if the scene has no contact, or `watch` asks to stop.
[[nodiscard]] HoldWindows hold_windows(const PreparedScene& nominal, const RobustnessOptions& options, const Watch& watch = {});

}  // namespace softland
