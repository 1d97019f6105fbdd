// A picture of a result for documents that cannot run a page.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "reports/chart.h"

namespace softland {

/// Returns a static SVG document, 900 px wide: the finding in words, gap against time of baseline and winner (the whole closing
/// and the landing enlarged) and the drive waveforms below. Parts that the result lacks are left out.
[[nodiscard]] std::string svg_gap_chart(const ClosingRecord& result);
/// Returns the charts of that document.
[[nodiscard]] internal::Picture gap_and_drives(const ClosingRecord& result);

/// Draws the frame around any picture: a headline, smaller words below it, and the result of draw(width, top), which gives
/// elements and their lower end.
[[nodiscard]] std::string svg_frame(const std::string& headline, const std::string& words,
                                    const std::function<std::pair<std::string, double>(double width, double top)>& draw);

/// Draws the same frame around any charts: a headline, smaller words below it, and the charts row by row.
[[nodiscard]] std::string svg_page(const std::string& headline, const std::string& words, const internal::Picture& drawn,
                                   std::size_t charts_per_row = 1);

}  // namespace softland
