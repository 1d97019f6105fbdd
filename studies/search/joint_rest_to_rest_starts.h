// Landings by a single swing in which all searched drives take part at once. They pull, and from a time on release, so that the
// contact point turns back as it arrives (swing.h); a push then keeps it on its contact. The search of several drives, or of a
// piezo, begins with them.
//
// The electrode that pulls goes to its limits. The other drives could do far more than a soft landing needs, and would ring the
// higher modes: they go through shares of their ranges. A piezo pulls and then lifts; an electrode on the far side waits and
// then brakes.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_space.h"

namespace softland {

/// Returns one landing for each share and length of the push, if it exists. None for an electrode alone, whose families begin
/// with it themselves, and none if the gas film is compressible.
[[nodiscard]] std::vector<DriveWaveforms> joint_rest_to_rest_starts(const PreparedScene& given, const SearchSpace& space);

}  // namespace softland
