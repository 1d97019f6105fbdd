// The other ways to the figures of a spread (studies/devices/box_and_chaos.h), beside those of the sample: a part of the report
// of `softland robustness`.
#pragma once

#include <nlohmann/json.hpp>

#include "reports/document.h"
#include "studies/devices/box_and_chaos.h"

namespace softland::internal {

[[nodiscard]] nlohmann::json other_ways_json(const BoxAndChaos& ways, const DriveRobustness& drive, const PreparedScene& nominal);
[[nodiscard]] ReportSection other_ways_section(const BoxAndChaos& ways, const DriveRobustness& drive,
                                               const PreparedScene& nominal);

}  // namespace softland::internal
