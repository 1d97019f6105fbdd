// How the figures of the nominal device change with what varies (studies/devices/derivatives.h): a part of the report of
// `softland robustness`.
#pragma once

#include <nlohmann/json.hpp>

#include "reports/document.h"
#include "studies/devices/derivatives.h"
#include "studies/devices/robustness.h"

namespace softland::internal {

/// `drive` is the one that they are of.
[[nodiscard]] nlohmann::json derivatives_json(const Derivatives& derivatives, const DriveRobustness& drive);
/// With all figures. Without parts where nothing was asked for.
[[nodiscard]] ReportSection derivatives_section(const Derivatives& derivatives, const DriveRobustness& drive);

}  // namespace softland::internal
