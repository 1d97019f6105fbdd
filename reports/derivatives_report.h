// How the figures of the nominal device change with what varies (studies/devices/derivatives.h): a part of the report of
// `softland robustness`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "studies/devices/derivatives.h"
#include "studies/devices/robustness.h"

namespace softland::internal {

/// `drive` is the one that they are of.
[[nodiscard]] nlohmann::json derivatives_json(const Derivatives& derivatives, const DriveRobustness& drive);
/// For a terminal: explained_figures. Empty where nothing was asked for.
[[nodiscard]] std::string derivatives_text(const Derivatives& derivatives, const DriveRobustness& drive);
/// A section of the page, with all figures.
[[nodiscard]] std::string derivatives_html(const Derivatives& derivatives, const DriveRobustness& drive);

}  // namespace softland::internal
