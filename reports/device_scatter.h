// Every figure of devices against every quantity that varies between them: which one decides, and to which side.
#pragma once

#include "reports/robustness_report.h"

namespace softland::internal {

/// Small pictures of the last drive, a dot for each of at most 300 devices and a line for the medians of groups of all of them;
/// empty where nothing can be drawn.
[[nodiscard]] ReportSection device_scatter(const RobustnessReport& report);

}  // namespace softland::internal
