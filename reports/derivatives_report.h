// How the figures of the nominal device change with what varies (studies/devices/derivatives.h): a part of the report of
// `softland robustness`.
#pragma once

#include "reports/robustness_report.h"

namespace softland::internal {

/// `drive` is the one that they are of.
[[nodiscard]] RobustnessRecord::Derived record_of(const Derivatives& derivatives, const DriveRobustness& drive);
/// With all figures. Without parts where nothing was asked for.
[[nodiscard]] ReportSection derivatives_section(const RobustnessRecord::Derived& derivatives,
                                                const RobustnessRecord::Drive& drive);

}  // namespace softland::internal
