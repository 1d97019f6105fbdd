// Where a race begins: within the volts that a driver has where its scene says nothing, however many more there may be.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_setting.h"

namespace softland {

/// The same searches where no searched electrode leaves the limit that it has by default (default_limit() in config/scene.h).
/// `names` are those of their families. Empty where no limit is wider, or the hold level itself is beyond it.
[[nodiscard]] std::vector<SearchSetting> within_usual_room(const std::vector<SearchSetting>& settings, Actuator actuator,
                                                           const std::vector<std::string>& names);

}  // namespace softland
