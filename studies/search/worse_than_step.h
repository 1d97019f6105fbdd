// Whether a drive does worse on devices than the plain step.
//
// Of the largest impact speed, the highest rebound and the peak force: worse where the 95 % quantile is above that of the step on
// the same devices, and the 95 % interval of the difference, by a bootstrap over devices, does not hold 0. Rebounds that are not
// significant are equal. A device that does not close has the worst of every figure.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "studies/devices/robustness.h"
#include "studies/search/robust_cost.h"

namespace softland {

/// Keys of device_figures that are compared.
inline constexpr std::array judged_figures{key_of(&Metrics::largest_impact_velocity), key_of(&Metrics::major_bounce_height),
                                           key_of(&Metrics::peak_contact_force)};

/// The figures in which the drive is worse, of outcomes by device, as far as both have them; `significant`: height of a rebound
/// from which on it counts [m].
[[nodiscard]] std::vector<std::string_view> worse_in(const std::vector<DeviceOutcome>& drive,
                                                     const std::vector<DeviceOutcome>& step, double significant,
                                                     std::uint64_t seed);

/// Conditions that no judged figure is above the 95 % quantile of the step's outcomes, or for a rebound above `significant` [m].
/// There is none on a figure whose quantile is not finite.
[[nodiscard]] std::vector<Criterion> no_harder_than(const std::vector<DeviceOutcome>& step, double significant);

}  // namespace softland
