// The plain step, the reference for found waveforms: each voltage jumps to its hold level at t = 0.
#pragma once

#include <string>
#include <vector>

#include "studies/closing/actuator.h"
#include "studies/closing/prepared.h"
#include "waveforms/waveform.h"

namespace softland {

/// Returns the waveforms [V] of the plain step, which replace those of the scene. An actuator with electrodes steps to the hold
/// levels of the scene, as steep as the voltage source permits; electrodes that brake stay at 0 V. The piezo stays at 0 V
/// unless it is the only drive of the actuator, and then steps to its own hold level. Throws InvalidInput if no electrode pulls
/// in and one is needed.
[[nodiscard]] DriveWaveforms plain_step(const PreparedScene& prepared, Actuator actuator);

/// Returns the step of a drive from one level to another [V], as steep as its voltage source permits.
[[nodiscard]] Step step_from(const Drive& drive, double from, double level);

/// True if both lists have the same drive signals in the same order.
[[nodiscard]] bool same_drives(const std::vector<Signal>& a, const std::vector<Signal>& b);

}  // namespace softland
