// Waveforms of all searched drives that close the switch by a single swing: the drives pull, then release, so that the contact
// point reaches the contact with zero velocity (swing.h). A pull after contact then keeps the switch closed. The search of
// several drives, or of a piezo, begins with these waveforms.
//
// The pulling electrode goes to its limits. The other drives use only shares of their ranges, since their full range would
// excite the higher modes. A piezo pulls and then lifts; an electrode on the far side (away from the contact) waits and then
// brakes.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_space.h"

namespace softland {

/// Returns one waveform per drive for every share of the voltage ranges and every duration of the pull after contact for which
/// a single swing to the contact exists. None for a single electrode, whose waveform families have such starts themselves, and
/// none if the gas film is compressible.
[[nodiscard]] std::vector<DriveWaveforms> joint_rest_to_rest_starts(const PreparedScene& given, const SearchSpace& space);

}  // namespace softland
