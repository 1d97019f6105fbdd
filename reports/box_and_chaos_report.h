// The other ways to the figures of a spread (studies/devices/box_and_chaos.h), beside those of the sample: a part of the report
// of `softland robustness`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "studies/devices/box_and_chaos.h"

namespace softland::internal {

[[nodiscard]] nlohmann::json other_ways_json(const BoxAndChaos& ways, const DriveRobustness& drive, const PreparedScene& nominal);
/// For a terminal.
[[nodiscard]] std::string other_ways_text(const BoxAndChaos& ways, const DriveRobustness& drive, const PreparedScene& nominal);
/// A section of the page.
[[nodiscard]] std::string other_ways_html(const BoxAndChaos& ways, const DriveRobustness& drive, const PreparedScene& nominal);

}  // namespace softland::internal
