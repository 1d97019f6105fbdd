// Sections of the report of `softland robustness` beside its tables.
//
//   derivatives      figures of merit of the nominal device by the varied quantities (studies/devices/derivatives.h)
//   box and chaos    worst cases and polynomial chaos beside the simulated devices (studies/devices/box_and_chaos.h)
//   scatter          figures of merit of the simulated devices against the quantities that vary
#pragma once

#include "reports/robustness_report.h"

namespace softland::internal {

/// Makes the results on the derivatives of figures of merit by the varied quantities, for the report. `drive` has the closings
/// of the varied devices under the waveforms for which the derivatives were computed.
[[nodiscard]] RobustnessRecord::Derived record_of(const Derivatives& derivatives, const DriveRobustness& drive);
/// Makes the section on the derivatives of all figures of merit; the section is empty if no derivatives were computed.
[[nodiscard]] ReportSection derivatives_section(const RobustnessRecord::Derived& derivatives,
                                                const RobustnessRecord::Drive& drive);

/// Makes the results of the search for worst cases and of polynomial chaos, for the report.
[[nodiscard]] RobustnessRecord::BoxAndChaosRecord record_of(const BoxAndChaos& ways, const DriveRobustness& drive,
                                                            const PreparedScene& nominal);
/// Makes the section from results that include worst cases and polynomial chaos.
[[nodiscard]] ReportSection box_and_chaos_section(const RobustnessRecord& record);
/// Returns the value of a varied quantity as text: a factor as "× 1.0213", any other quantity as "2.013 µm".
[[nodiscard]] std::string value_text(const RobustnessRecord::Varied& variable, double value);

/// Draws small scatter plots of every figure of merit against every quantity that varies between devices. They show the closings
/// under the last of the compared sets of waveforms: a dot for each of at most 300 devices, and a line through the medians of
/// groups of all devices. Empty if nothing can be drawn.
[[nodiscard]] ReportSection device_scatter(const RobustnessReport& report);

}  // namespace softland::internal
