// The section on how the figures of the nominal device change with the varying quantities (studies/devices/derivatives.h): a
// part of the report of `softland robustness`.
#pragma once

#include "reports/robustness_report.h"

namespace softland::internal {

/// Makes the record; `drive` is the drive that the derivatives belong to.
[[nodiscard]] RobustnessRecord::Derived record_of(const Derivatives& derivatives, const DriveRobustness& drive);
/// Makes the section with all figures; it has no parts where nothing was asked for.
[[nodiscard]] ReportSection derivatives_section(const RobustnessRecord::Derived& derivatives,
                                                const RobustnessRecord::Drive& drive);

}  // namespace softland::internal
