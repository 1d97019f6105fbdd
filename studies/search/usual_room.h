// The first race: within the default limits of a driver, even if the scene gives wider ones.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_setting.h"

namespace softland {

/// Returns the same searches with searched electrodes within their default limits (default_limit() in config/scene.h). `names`
/// are those of their families. Empty if no limit is wider, or the hold level itself is beyond it.
[[nodiscard]] std::vector<SearchSetting> within_usual_room(const std::vector<SearchSetting>& settings, Actuator actuator,
                                                           const std::vector<std::string>& names);

}  // namespace softland
