// What keeps a search from landings that belong to the modes of its scene: a beam has more of them than are kept, and a waveform
// may not ring those that are left out.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_setting.h"

namespace softland {

/// The same search where searched drives go from one end of their range to the other in one period of the highest mode kept, or
/// more slowly. Empty where that changes nothing: of a plate, whose one mode is all, and where every searched driver has a
/// max_slew of its own. Families that find no room for it are left as they are.
[[nodiscard]] std::vector<SearchSetting> with_gentle_edges(const std::vector<SearchSetting>& settings, Actuator actuator,
                                                           const std::string& families, const OwnWaveforms& own = {});
/// Whether a search is to have gentle edges from the start: it shapes a piezo, which rings every mode it has an edge for, and
/// begins with no waveform that is steeper.
[[nodiscard]] bool begins_gently(const std::vector<SearchSetting>& gentle, const std::vector<StartingWaveforms>& starts);
/// The same search by the worst of the closings with the modes of the scene and with more of them: see with_more_modes().
[[nodiscard]] SearchSetting by_the_worst_of_modes(SearchSetting setting);

}  // namespace softland
