// Hold levels that keep devices closed: above the release voltage of each, and below the voltage from which on it is pulled
// through its contact.
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

/// The share of devices that a window of hold levels is for.
inline constexpr double held_share = 0.99;
/// Devices that a window is found from, at most: an equilibrium of each is followed up to its pull-through.
inline constexpr std::uint64_t most_held_devices = 200;

struct HoldWindow {
  /// Hold levels between which at least held_share of the devices stay closed [V]; `upper` is infinite where so many are pulled
  /// through at no voltage. NaN where there are no such levels.
  double lower = std::numeric_limits<double>::quiet_NaN(), upper = lower;
};

struct HoldWindows {
  std::map<std::string, HoldWindow> of_electrodes;  ///< that pull towards the contact
  std::size_t devices = 0;                          ///< that they are found from
};

/// The window of devices that are held within these ranges. A range without a release voltage holds nothing; one that is pulled
/// through at no voltage has no upper end.
[[nodiscard]] HoldWindow hold_window(std::span<const ClosedRange> devices);

/// Of the first devices of the spread that robustness() has judged under the same options, in volts, whatever is measured of
/// them, the other drives standing as for the pull-in voltages. A device that cannot be described is held by nothing. None where
/// the scene has no contact, or `watch` asks to stop.
[[nodiscard]] HoldWindows hold_windows(const PreparedScene& nominal, const RobustnessOptions& options, const Watch& watch = {});

}  // namespace softland
