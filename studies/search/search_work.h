// The work of a search: the number of closings in a budget that the user did not give.
//
// A usual budget counts work, so that a scene whose closings are slow gets fewer of them. Work is counted in right-hand sides of
// the equations of motion, which are the same on every machine and for every number of threads:
//
//   w   right-hand sides of a closing of the nominal device, the larger number of those under the plain step and under the first
//       waveform of the search. One at p quadrature points counts as (8 + p) / 32; that of a compressible gas film counts as many
//       times more as it has pressures, whose equations are solved beside it
//   N   closings of the usual budget, n = N min(1, u / w),  u = usual_work()
//
// A closing of a device that lanes do not follow (why_not_in_lanes()) counts as many times as there are lanes.
#pragma once

#include "studies/search/search_setting.h"

namespace softland {

/// The work of one closing.
struct ClosingWork {
  double counted = 0;  ///< work w
  double seconds = 0;  ///< time on this machine [s]
};
/// Runs the closings under the plain step and under the first starting waveform of the family, as a search runs them, and
/// returns the slower one. Throws nothing: a closing that cannot be followed counts up to its failure.
[[nodiscard]] ClosingWork closing_work(const SearchSetting& setting);

/// Reference work u; the shipped scenes whose closings are quick stay below it.
[[nodiscard]] double usual_work(Shaped drives);
/// Number of devices that lanes follow in the time of one.
inline constexpr double usual_lanes = 8;

/// Time of a closing in a search over devices, over that of one closing: 0.6 to 1.3 in measurements. A slow approach takes
/// several times as long.
inline constexpr double device_share = 0.8, slow_approach = 3;

/// Closings n, at least 1.
[[nodiscard]] long within_work(long closings, double counted, double usual);

}  // namespace softland
