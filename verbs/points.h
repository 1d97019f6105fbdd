// The verbs that an exploration may ask of its points, by the numbers of their records.
#pragma once

#include "studies/exploration/exploration.h"

namespace softland::verbs {

/// limit, release, effects and check. What takes lists, files and times of the machine is left out of a record.
[[nodiscard]] const OtherStudies& studies_of_points();

}  // namespace softland::verbs
