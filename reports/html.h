// The report one shows around: a single HTML file that works offline.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace softland {

/// A self-contained HTML page (< 1 MB) of a simulate or optimize result: the finding in words, figures before and after, zoomable
/// charts, the search, confirmations, the resolved scene and how to reproduce it. `result` is the JSON that the verbs write
/// (result.json); every part of it is optional, null stands for "not available". The page makes no request: styles, script and
/// data are inside. Without JavaScript and in print the charts are static SVG. All text of the result is escaped. Scene texts
/// beyond 100 kB are cut, and the page says so. Throws InvalidInput when `result` is not a JSON object.
[[nodiscard]] std::string html_report(const nlohmann::json& result);

}  // namespace softland
