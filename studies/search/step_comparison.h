// Compares a drive with the plain step on devices.
//
// The compared figures are the largest impact speed, the highest rebound and the peak force. One is worse if its 95th
// percentile is above that of the step on the same devices, and the 95 % interval of the difference, by a bootstrap over
// devices, does not hold 0. Rebounds that are not significant are equal. A device that does not close has the worst of every
// figure.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "studies/devices/robustness.h"
#include "studies/search/robust_cost.h"

namespace softland {

/// Keys of the compared device_figures.
inline constexpr std::array judged_figures{key_of(&Metrics::largest_impact_velocity), key_of(&Metrics::major_bounce_height),
                                           key_of(&Metrics::peak_contact_force)};

/// The figures in which the drive is worse. Outcomes are by device, as far as both have them; `significant` is the height from
/// which on a rebound counts [m].
[[nodiscard]] std::vector<std::string_view> worse_in(const std::vector<DeviceOutcome>& drive,
                                                     const std::vector<DeviceOutcome>& step, double significant,
                                                     std::uint64_t seed);

/// Conditions that keep each judged figure at or below the 95th percentile of the step's outcomes, or a rebound at or below
/// `significant` [m]. A figure without a finite quantile has no condition.
[[nodiscard]] std::vector<Condition> at_most_step(const std::vector<DeviceOutcome>& step, double significant);

}  // namespace softland
