// The verbs that an exploration may run at its points, and the numbers that the exploration stores of their results.
#pragma once

#include "studies/exploration/exploration.h"

namespace softland::verbs {

/// Returns the verbs limit, release, effects and check as studies of explorations. Long lists, files and computing times are
/// not stored.
[[nodiscard]] const OtherStudies& studies_of_points();

}  // namespace softland::verbs
