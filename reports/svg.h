// A picture of a result for documents that cannot run a page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/chart.h"

namespace softland {

/// A static SVG document, 900 px wide: the finding in words, gap against time of baseline and winner (the whole closing and the
/// landing enlarged) and the drive waveforms below. `result` is the JSON that simulate and optimize write; what it lacks is left
/// out. Throws InvalidInput when `result` is not a JSON object.
[[nodiscard]] std::string svg_gap_chart(const nlohmann::json& result);

/// The same frame around any charts: a headline, smaller words below it, and the charts row by row.
[[nodiscard]] std::string svg_page(const std::string& headline, const std::string& words, const internal::Picture& drawn,
                                   std::size_t charts_per_row = 1);

}  // namespace softland
