// Settings for a first tournament of searches within the default voltage limits, if the scene's limits are wider.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_setting.h"

namespace softland {

/// Returns the settings with the limits of the searched electrodes reduced to their default (default_limit() in
/// config/scene.h). `names` are the waveform families of the settings. The result is empty if the scene's limits are not wider,
/// or if the hold level exceeds the default limit.
[[nodiscard]] std::vector<SearchSetting> within_usual_room(const std::vector<SearchSetting>& settings, Actuator actuator,
                                                           const std::vector<std::string>& names);

}  // namespace softland
