// What `softland calibrate` found: JSON with SI units in the names, and a table for a terminal.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "studies/search/identification.h"

namespace softland {

[[nodiscard]] nlohmann::json measurements_json(const IdentificationStudy& study, const IdentificationOptions& options,
                                               const std::string& command);
/// Pairs that close devices no better than the better one of their figures are left out, and so are all beyond `most` rows.
[[nodiscard]] std::string measurements_text(const IdentificationStudy& study, const IdentificationOptions& options,
                                            std::size_t most = 24);

}  // namespace softland
