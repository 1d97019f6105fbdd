// The verbs that an exploration may run at its points, with the numbers of their records.
#pragma once

#include "studies/exploration/exploration.h"

namespace softland::verbs {

/// Returns limit, release, effects and check. A record leaves out long lists, files and times of the machine.
[[nodiscard]] const OtherStudies& studies_of_points();

}  // namespace softland::verbs
