// Keeps a search from landings that belong to the modes of its scene. A beam has more modes than are kept, and a waveform must
// not ring those that are left out.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_setting.h"

namespace softland {

/// Returns the same search with slower edges: searched drives go from one end of their range to the other in one period of the
/// highest mode kept, or more slowly. Empty if that changes nothing: for a plate, which has one mode, and if every searched
/// driver has a max_slew of its own. Families that find no room for it keep their limits.
[[nodiscard]] std::vector<SearchSetting> with_gentle_edges(const std::vector<SearchSetting>& settings, Actuator actuator,
                                                           const std::string& families, const OwnWaveforms& own = {});
/// True if a search has gentle edges from the start: it shapes a piezo, whose edges ring every mode, and begins with no steeper
/// waveform.
[[nodiscard]] bool begins_gently(const std::vector<SearchSetting>& gentle, const std::vector<StartingWaveforms>& starts);
/// Returns the same search by the worst of the closings with the modes of the scene and with more of them: see
/// with_more_modes().
[[nodiscard]] SearchSetting by_the_worst_of_modes(SearchSetting setting);

}  // namespace softland
