// Scatter plots of every figure of merit against every quantity that varies between devices. They show which quantities change
// a figure, and in which direction.
#pragma once

#include "reports/robustness_report.h"

namespace softland::internal {

/// Draws small scatter plots of the closings under the last of the compared sets of waveforms: a dot for each of at most 300
/// devices, and a line through the medians of groups of all devices. Empty if nothing can be drawn.
[[nodiscard]] ReportSection device_scatter(const RobustnessReport& report);

}  // namespace softland::internal
