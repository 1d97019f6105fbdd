// A result as JSON, for programs: SI units in the names, non-finite numbers as null.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/result.h"

namespace softland {

/// JSON on one line, or with `indent` blanks per level; what is not UTF-8 (a path may not be) becomes U+FFFD.
[[nodiscard]] std::string json_text(const nlohmann::json& data, int indent = -1);

[[nodiscard]] nlohmann::json result_json(const Result& result);

/// What --json gives: a result without what is large (curves, the text of the scene, the log of the search) or said twice.
[[nodiscard]] nlohmann::json summary_json(nlohmann::json result);

/// The same of the record of a study.
[[nodiscard]] nlohmann::json without_curves(nlohmann::json record);

namespace internal {
/// {"5": number, "10": ..., "20": ..., "converged": number}, and back; a number that there is not is null.
[[nodiscard]] nlohmann::json by_modes_json(const ByModes& found);
[[nodiscard]] std::optional<ByModes> read_by_modes(const nlohmann::json& found);
}  // namespace internal

/// Status and figures of a run, but for those of the drives.
[[nodiscard]] nlohmann::json metrics_json(const Metrics& metrics);

}  // namespace softland
