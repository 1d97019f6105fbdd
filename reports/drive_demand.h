// The waveforms of electrodes, piezos and dispersion force (the drives) in a run, and what they demand of the voltage sources.
#pragma once

#include <string>
#include <string_view>

#include "reports/closing_record.h"

namespace softland::internal {

/// The quantity that a waveform prescribes: the voltage of an electrode or a piezo, or the factor of the dispersion force.
struct DriveScale {
  std::string_view name;  ///< name of the quantity, as the first word of a sentence
  std::string_view unit;  ///< unit of the quantity; empty: a plain number
  double rest = 0;        ///< level of the waveform before t = 0, in the unit of the quantity
};
/// Returns the quantity that a waveform prescribes. `drive` names an electrode or a piezo (a voltage), or is "dispersion" (a
/// factor).
[[nodiscard]] DriveScale drive_scale(std::string_view drive);
[[nodiscard]] DriveLimits drive_limits(const ClosingRecord& result, const std::string& drive);
/// Returns the waveform of an electrode, a piezo or the dispersion force in a run; empty if the run has none of that name.
[[nodiscard]] const Points& waveform(const RunRecord& run, const std::string& drive);
/// The voltages and the slew rate that a waveform, which begins at the level `rest`, demands of its voltage source.
struct DriveDemand {
  double lowest = 0, highest = 0;  ///< lowest and highest level of the waveform [V]; NaN without a waveform
  double slew = 0;                 ///< largest slew rate of the waveform [V/s]; infinite where the waveform jumps
  [[nodiscard]] double peak() const;
};
[[nodiscard]] DriveDemand drive_demand(const Points& waveform, double rest);

}  // namespace softland::internal
