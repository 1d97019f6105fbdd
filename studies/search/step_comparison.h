// Compares drive waveforms with the plain step on varied devices.
//
// The compared figures are the largest impact velocity, the highest rebound and the peak force. The waveform is worse in a figure
// if the 95th percentile is above that under the step on the same devices, and the 95 % interval of the difference, by a
// bootstrap over devices, does not contain 0. Rebounds that are not significant are equal. A device that does not close has the
// worst value of every figure.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "studies/devices/robustness.h"
#include "studies/search/robust_cost.h"

namespace softland {

/// Keys of the compared figures, which are among device_figures.
inline constexpr std::array judged_figures{key_of(&Metrics::largest_impact_velocity), key_of(&Metrics::major_bounce_height),
                                           key_of(&Metrics::peak_contact_force)};

/// Returns the keys of the figures in which the waveform of `drive` is worse. Both lists of outcomes have the same devices, up
/// to the end of the shorter list; rebounds below the height `significant` are equal [m].
[[nodiscard]] std::vector<std::string_view> worse_in(const std::vector<DeviceOutcome>& drive,
                                                     const std::vector<DeviceOutcome>& step, double significant,
                                                     std::uint64_t seed);

/// Returns a condition for each of judged_figures: at most its 95th percentile over the outcomes of the plain step; for the
/// rebound, at most `significant` [m] if that is larger. A figure without a finite percentile has no condition.
[[nodiscard]] std::vector<Condition> at_most_step(const std::vector<DeviceOutcome>& step, double significant);

}  // namespace softland
