// The drives of a run, and their demands on their sources.
#pragma once

#include <string>
#include <string_view>

#include "reports/closing_record.h"

namespace softland::internal {

/// The quantity that a drive's waveform gives.
struct DriveScale {
  std::string_view name;  ///< name that begins a sentence
  std::string_view unit;  ///< unit; empty: a plain number
  double rest = 0;        ///< level before t = 0
};
/// Returns volts, or the factor of the drive named "dispersion".
[[nodiscard]] DriveScale drive_scale(std::string_view drive);
[[nodiscard]] DriveLimits drive_limits(const ClosingRecord& result, const std::string& drive);
/// Returns the waveform of a drive in a run; empty where the run is not there.
[[nodiscard]] const Points& waveform(const RunRecord& run, const std::string& drive);
/// The demand of a waveform on its source from `rest` on.
struct DriveDemand {
  double lowest = 0, highest = 0;  ///< extreme levels; NaN without a waveform
  double slew = 0;                 ///< largest slew rate; infinite where the waveform jumps
  [[nodiscard]] double peak() const;
};
[[nodiscard]] DriveDemand drive_demand(const Points& waveform, double rest);

}  // namespace softland::internal
