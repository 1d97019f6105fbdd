// What a study found, as the JSON that every other output is made from. SI units in the names, non-finite numbers as null.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "studies/optimize.h"
#include "studies/simulate.h"

namespace softland {

/// Where a result comes from: goes into every output.
struct Provenance {
  std::string command;  ///< the command line
};

/// The result of simulate. Curves have the resolution of the integration.
[[nodiscard]] nlohmann::json result_json(const Prepared& prepared, const Closing& closing, const Provenance& provenance);

/// The result of optimize. Equal for equal seeds but for wall_s and the command line.
[[nodiscard]] nlohmann::json result_json(const OptimizeResult& result, const OptimizeOptions& options,
                                         const Provenance& provenance);

/// What --json gives: a result without what is large (curves, the text of the scene, the log of the search) or said twice.
[[nodiscard]] nlohmann::json summary_json(nlohmann::json result);

/// Status and figures of a run, but for those of the drives.
[[nodiscard]] nlohmann::json metrics_json(const Metrics& metrics);
[[nodiscard]] std::string_view to_string(Actuator actuator);

}  // namespace softland
