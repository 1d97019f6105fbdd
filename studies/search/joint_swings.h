// Landings by a single swing in which all searched drives take part at once: pull, and from a time on release, so that the
// contact point turns back as it arrives (swing.h); then a push that keeps it on its contact. Where a search of several drives,
// or of a piezo, begins.
//
// The electrode that pulls goes to its limits. The others, which could do far more than a soft landing asks for and ring the
// higher modes, go through shares of their ranges: a piezo pulls and then lifts, an electrode on the far side stands by and then
// brakes.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_space.h"

namespace softland {

/// One for each share and length of the push, where there is such a landing. None of an electrode alone, whose families begin
/// with it themselves, and none where the gas film is compressible.
[[nodiscard]] std::vector<DriveWaveforms> joint_swings(const PreparedScene& given, const SearchSpace& space);

}  // namespace softland
