// A result as JSON, for programs: SI units in the names, non-finite numbers as null.
#pragma once

#include <nlohmann/json.hpp>

#include "reports/result.h"

namespace softland {

[[nodiscard]] nlohmann::json result_json(const Result& result);

/// What --json gives: a result without what is large (curves, the text of the scene, the log of the search) or said twice.
[[nodiscard]] nlohmann::json summary_json(nlohmann::json result);

[[nodiscard]] nlohmann::json closed_state_json(const ClosedState& state);

/// Status and figures of a run, but for those of the drives.
[[nodiscard]] nlohmann::json metrics_json(const Metrics& metrics);

}  // namespace softland
