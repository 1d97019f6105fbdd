// The other ways to the figures of a spread (studies/other_ways.h), beside those of the sample: a part of the report of
// `softland robustness`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "studies/other_ways.h"

namespace softland::internal {

[[nodiscard]] nlohmann::json other_ways_json(const OtherWays& ways, const DriveRobustness& drive, const PreparedScene& nominal);
/// For a terminal.
[[nodiscard]] std::string other_ways_text(const OtherWays& ways, const DriveRobustness& drive, const PreparedScene& nominal);
/// A section of the page.
[[nodiscard]] std::string other_ways_html(const OtherWays& ways, const DriveRobustness& drive, const PreparedScene& nominal);

}  // namespace softland::internal
