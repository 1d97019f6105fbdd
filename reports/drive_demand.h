// The waveforms of the drives of a run, and what they demand of the voltage sources.
#pragma once

#include <string>
#include <string_view>

#include "reports/closing_record.h"

namespace softland::internal {

/// The quantity that the waveform of a drive gives.
struct DriveScale {
  std::string_view name;  ///< name that begins a sentence
  std::string_view unit;  ///< unit; empty: a plain number
  double rest = 0;        ///< level before t = 0
};
/// Returns the scale of a voltage; for the drive named "dispersion", the scale of a factor.
[[nodiscard]] DriveScale drive_scale(std::string_view drive);
[[nodiscard]] DriveLimits drive_limits(const ClosingRecord& result, const std::string& drive);
/// Returns the waveform of a drive in a run; empty if the run has none.
[[nodiscard]] const Points& waveform(const RunRecord& run, const std::string& drive);
/// The demand of a waveform on its voltage source, beginning at the level `rest`.
struct DriveDemand {
  double lowest = 0, highest = 0;  ///< extreme levels; NaN without a waveform
  double slew = 0;                 ///< largest slew rate; infinite where the waveform jumps
  [[nodiscard]] double peak() const;
};
[[nodiscard]] DriveDemand drive_demand(const Points& waveform, double rest);

}  // namespace softland::internal
