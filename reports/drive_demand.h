// The drives of a run, and their demands on their sources.
#pragma once

#include <string>
#include <string_view>

#include "reports/closing_record.h"

namespace softland::internal {

/// The quantity that a drive's waveform gives.
struct DriveScale {
  std::string_view name;  ///< begins a sentence
  std::string_view unit;  ///< empty: a plain number
  double rest = 0;        ///< before t = 0
};
/// Volts, or the factor of the drive named "dispersion".
[[nodiscard]] DriveScale drive_scale(std::string_view drive);
[[nodiscard]] DriveLimits drive_limits(const ClosingRecord& result, const std::string& drive);
/// The waveform of a drive in a run; empty where the run is not there.
[[nodiscard]] const Points& waveform(const RunRecord& run, const std::string& drive);
/// The demand of a waveform on its source from `rest` on.
struct DriveDemand {
  double lowest = 0, highest = 0;  ///< NaN: there is no waveform
  double slew = 0;                 ///< infinite where it jumps
  [[nodiscard]] double peak() const;
};
[[nodiscard]] DriveDemand drive_demand(const Points& waveform, double rest);

}  // namespace softland::internal
