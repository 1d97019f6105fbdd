// The plain step, with which found waveforms are compared: each voltage steps to its hold level at once.
#pragma once

#include <string>
#include <vector>

#include "studies/closing/actuator.h"
#include "studies/closing/prepared.h"
#include "waveforms/waveform.h"

namespace softland {

/// Returns the waveforms [V] that take the place of the scene's. An actuator with electrodes steps to the hold levels that the
/// scene describes, as steep as the driver permits; electrodes that brake stay at 0 V. The piezo stays at 0 V unless it is the
/// only drive, and steps to its own level then. Throws InvalidInput if an electrode is needed and none pulls in.
[[nodiscard]] DriveWaveforms plain_step(const PreparedScene& prepared, Actuator actuator);

/// Returns the step of a drive from one level to another [V], as steep as its driver permits.
[[nodiscard]] Step step_from(const Drive& drive, double from, double level);

/// True if the signals are the same, one by one.
[[nodiscard]] bool same_drives(const std::vector<Signal>& a, const std::vector<Signal>& b);

}  // namespace softland
