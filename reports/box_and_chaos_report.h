// The section of the report of `softland robustness` that compares the figures of merit of the simulated devices with those of
// a search for worst cases and of polynomial chaos (studies/devices/box_and_chaos.h).
#pragma once

#include "reports/robustness_report.h"

namespace softland::internal {

[[nodiscard]] RobustnessRecord::BoxAndChaosRecord record_of(const BoxAndChaos& ways, const DriveRobustness& drive,
                                                            const PreparedScene& nominal);
/// Makes the section from results that include worst cases and polynomial chaos.
[[nodiscard]] ReportSection box_and_chaos_section(const RobustnessRecord& record);
/// Returns the value of a varied quantity as text: a factor as "× 1.0213", any other quantity as "2.013 µm".
[[nodiscard]] std::string value_text(const RobustnessRecord::Varied& variable, double value);

}  // namespace softland::internal
