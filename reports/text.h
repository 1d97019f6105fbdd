// The same findings for a terminal.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace softland {

/// Headline, table of figures (baseline and winner side by side for optimize; value and error for simulate), confirmations and
/// warnings of a result.json.
[[nodiscard]] std::string text_report(const nlohmann::json& result);

}  // namespace softland
