// What several reports read off a result.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reports/result.h"

namespace softland::internal {

/// A number as a chart takes it: NaN beyond 1e100 and 0 within 1e-100 of 0. Nothing of a switch is like that, and what a damaged
/// file holds would overflow on its way to the picture.
[[nodiscard]] double drawable(double value);
/// The points whose coordinates can be drawn.
[[nodiscard]] Points drawable(const Points& points);

/// The simulated time [s]: the last time of any curve; NaN without curves.
[[nodiscard]] double window_end(const Result& result);
/// Indices of the listed evaluations of a search, ascending; they may have gaps.
[[nodiscard]] std::vector<double> evaluation_indices(const ResultSearch& search);
/// How many evaluations had been made up to and with the one of this index; the index itself where none are listed.
[[nodiscard]] double evaluations_until(const std::vector<double>& indices, double index);
/// What a drive's waveform is made of.
struct DriveScale {
  std::string_view name;  ///< at the beginning of a sentence
  std::string_view unit;  ///< empty: a plain number
  double rest = 0;        ///< before t = 0
};
/// Volts, or the factor of the drive named "dispersion".
[[nodiscard]] DriveScale drive_scale(std::string_view drive);
[[nodiscard]] DriveLimits drive_limits(const Result& result, const std::string& drive);
/// What a drive does in a run; empty where the run is not there.
[[nodiscard]] const Points& waveform(const ResultRun& run, const std::string& drive);
/// What a waveform demands of its source from `rest` on.
struct DriveDemand {
  double lowest = 0, highest = 0;  ///< NaN: there is no waveform
  double slew = 0;                 ///< infinite where it jumps
  [[nodiscard]] double peak() const;
};
[[nodiscard]] DriveDemand drive_demand(const Points& waveform, double rest);

}  // namespace softland::internal
