// The drive that every other one is compared with: each voltage at its hold level at once.
#pragma once

#include <string>
#include <vector>

#include "studies/closing/actuator.h"
#include "studies/closing/prepared.h"
#include "waveforms/waveform.h"

namespace softland {

/// The waveforms [V] that take the place of the scene's: for an actuator with electrodes, steps to the hold levels that the scene
/// describes, as steep as the driver permits, and electrodes that brake at 0 V; the piezo at 0 V, unless nothing else drives,
/// when it steps to its own. Throws InvalidInput where an electrode is needed and there is none that pulls in.
[[nodiscard]] DriveWaveforms plain_step(const PreparedScene& prepared, Actuator actuator);

/// A step of a drive from where it stands to a level [V], as steep as its driver permits.
[[nodiscard]] Step step_from(const Drive& drive, double from, double level);

/// Whether the signals are the same, one by one.
[[nodiscard]] bool same_drives(const std::vector<Signal>& a, const std::vector<Signal>& b);

}  // namespace softland
