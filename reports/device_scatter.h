// Scatter plots of every figure against every quantity that varies between devices show which one decides, and in which
// direction.
#pragma once

#include "reports/robustness_report.h"

namespace softland::internal {

/// Draws small pictures of the last drive, a dot for each of at most 300 devices and a line for the medians of groups of all of
/// them; empty where nothing can be drawn.
[[nodiscard]] ReportSection device_scatter(const RobustnessReport& report);

}  // namespace softland::internal
