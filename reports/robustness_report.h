// What `softland robustness` found: JSON with SI units in the names, one line per device as CSV, and a table for a terminal.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/result_maker.h"
#include "studies/robustness.h"

namespace softland {

[[nodiscard]] nlohmann::json robustness_json(const Prepared& nominal, const Robustness& found, const RobustnessOptions& options,
                                             const Provenance& provenance);
[[nodiscard]] std::string robustness_text(const Prepared& nominal, const Robustness& found, const RobustnessOptions& options);

/// A line per device: its number, the varying quantities [SI unit, or factor], and for every drive its status and figures; a
/// figure that a device does not have is empty.
[[nodiscard]] std::string robustness_csv(const Prepared& nominal, const Robustness& found, const RobustnessOptions& options);

}  // namespace softland
