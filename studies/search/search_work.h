// The work of a search: the number of closings in a default budget.
//
// A default budget counts work, so that a scene whose closings are slow gets fewer closings. Work is counted in evaluations of
// the right-hand side of the equations of motion, whose number is the same on every machine and for every number of threads:
//
//   w   right-hand sides of a closing of the nominal device, the larger number of those under the plain step and under the first
//       waveform of the search. A right-hand side at p quadrature points counts as (8 + p) / 32; with a compressible gas film,
//       as many times more as the film has pressures, whose equations are solved as well
//   N   closings of the default budget, n = N min(1, u / w),  u = usual_work()
//
// A closing that cannot be simulated in SIMD lanes, several devices at a time (why_not_in_lanes()), counts usual_lanes times.
#pragma once

#include "studies/search/optimize.h"
#include "studies/search/search_setting.h"

namespace softland {

/// The work of simulating one closing, as a number and as a time.
struct ClosingWork {
  double counted = 0;  ///< work w of the closing, in right-hand sides of the equations of motion
  double seconds = 0;  ///< computing time of the closing on this machine [s]
};
/// Simulates the closings under the plain step and under the first starting waveform of the waveform family, with the options
/// of a search, and returns the work of the slower one. Throws no exception: a simulation that fails counts up to its failure.
[[nodiscard]] ClosingWork closing_work(const SearchSetting& setting);

/// Returns the reference u for the work of a closing, in right-hand sides: a default budget is reduced if closings take more.
[[nodiscard]] double usual_work(Shaped drives);
/// Number of devices that SIMD lanes simulate in the time of one device.
inline constexpr double usual_lanes = 8;

/// Computing time of a closing in a search over devices, relative to that of a single closing (device_share; measured: 0.6 to
/// 1.3). Computing time of a quasi-static closing, relative to that of a quick one (slow_approach).
inline constexpr double device_share = 0.8, slow_approach = 3;

/// Returns the number of closings that a default budget of `closings` is reduced to if each takes the work `counted`, more than
/// the reference `usual` [right-hand sides]; at least 1.
[[nodiscard]] long within_work(long closings, double counted, double usual);

/// Reduces a default budget of the search on the nominal device if the closings of the scene are slow, and reports the estimated
/// work.
void fit_nominal_budget(const SearchSetting& setting, OptimizeOptions& options);

}  // namespace softland
