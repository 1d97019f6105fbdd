// Keeps a search from closings that are bounce-free only with the number of modes in its scene. A real beam has more modes,
// which a waveform must not excite.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_setting.h"

namespace softland {

/// Returns the settings of a search with slower voltage edges: searched drives need at least one period of the highest mode of
/// the model from one end of their range to the other. Empty if no edge changes: for a plate, which has one mode, and if all
/// searched voltage sources have their own max_slew. Waveform families that cannot have such slow edges keep their limits.
[[nodiscard]] std::vector<SearchSetting> with_gentle_edges(const std::vector<SearchSetting>& settings, Actuator actuator,
                                                           const std::string& families, const OwnWaveforms& own = {});
/// True if the search may use slower voltage edges from its start: it varies a piezo, whose edges excite every mode, and no
/// starting waveform has quicker edges.
[[nodiscard]] bool begins_gently(const std::vector<SearchSetting>& gentle, const std::vector<StartingWaveforms>& starts);
/// Returns a setting whose cost is the worst over closings with the scene's number of modes and with more modes: see
/// with_more_modes().
[[nodiscard]] SearchSetting by_the_worst_of_modes(SearchSetting setting);

}  // namespace softland
