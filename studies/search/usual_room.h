// Settings of the first tournament of searches, which uses the default voltage limits even if the scene gives wider limits.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_setting.h"

namespace softland {

/// Returns settings of searches with searched electrodes within their default limits (default_limit() in config/scene.h).
/// `names` are the waveform families of the settings. The result is empty if no limit of the scene is wider, or if the hold
/// level exceeds the default limit.
[[nodiscard]] std::vector<SearchSetting> within_usual_room(const std::vector<SearchSetting>& settings, Actuator actuator,
                                                           const std::vector<std::string>& names);

}  // namespace softland
