// How much too high the modes of a scene make the static pull-in voltage of a bridge that stretches.
//
// A bridge that is bent by many of its thicknesses hangs like a membrane: straight but for its load, and curved within
// L / sqrt(N L^2 / EI) of its clamps, N the tension, EI the rigidity. The modes of bending resolve that slowly. Fewer of them
// make a stiffer bridge (Ritz), so the voltage falls with every mode towards the true one. At a gap of 33 thicknesses 4 modes
// are 9.3 % high, 20 are 0.8 %, 40 are 0.2 %.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "studies/closing/prepared.h"

namespace softland {

/// More is worth a warning.
inline constexpr double static_excess_worth_telling = 0.01;

/// Static pull-in voltage of an electrode with most_static_modes [V], under the bias of the other drives (bias_of()); NaN where
/// there is none, or the structure is no beam that stretches.
[[nodiscard]] double resolved_pull_in(const Scene& scene, std::size_t electrode);

/// By how much a static pull-in voltage found with the modes of the scene [V] is above that: 0.05 is 5 %. NaN where that is.
[[nodiscard]] double static_excess(const Scene& scene, std::size_t electrode, double voltage);

/// Sentences for the electrodes for which it is worth telling.
[[nodiscard]] std::vector<std::string> static_excess_warnings(const PreparedScene& prepared);

}  // namespace softland
