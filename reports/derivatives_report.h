// The section of the report of `softland robustness` on the derivatives of the figures of merit of the nominal device by the
// quantities that process variation changes (studies/devices/derivatives.h).
#pragma once

#include "reports/robustness_report.h"

namespace softland::internal {

/// Makes the results on the derivatives of figures of merit by the varied quantities, for the report. `drive` has the closings
/// of the varied devices under the waveforms for which the derivatives were computed.
[[nodiscard]] RobustnessRecord::Derived record_of(const Derivatives& derivatives, const DriveRobustness& drive);
/// Makes the section on the derivatives of all figures of merit; the section is empty if no derivatives were computed.
[[nodiscard]] ReportSection derivatives_section(const RobustnessRecord::Derived& derivatives,
                                                const RobustnessRecord::Drive& drive);

}  // namespace softland::internal
