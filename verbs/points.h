// The verbs that an exploration may run at its points, and the numbers that it stores of them.
#pragma once

#include "studies/exploration/exploration.h"

namespace softland::verbs {

/// Returns the verbs limit, release, effects and check. The stored numbers exclude long lists, files and computing times.
[[nodiscard]] const OtherStudies& studies_of_points();

}  // namespace softland::verbs
