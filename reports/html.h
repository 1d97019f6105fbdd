// The report one shows around: a single HTML file that works offline.
#pragma once

#include <string>

#include "reports/result.h"

namespace softland {

/// A self-contained HTML page (< 1 MB) of a result: the finding in words, figures before and after, zoomable charts, the search,
/// confirmations, the resolved scene and how to reproduce it. The page makes no request: styles, script and data are inside.
/// Without JavaScript and in print the charts are static SVG. All text of the result is escaped. Scene texts beyond 100 kB are
/// cut, and the page says so.
[[nodiscard]] std::string html_report(const Result& result);

}  // namespace softland
