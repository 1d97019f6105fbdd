// Pictures for documents that cannot run a page.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "document/chart.h"

namespace softland {

/// Draws the frame around any picture: a headline, smaller words below it, and the result of draw(width, top), which gives
/// elements and their lower end.
[[nodiscard]] std::string svg_frame(const std::string& headline, const std::string& words,
                                    const std::function<std::pair<std::string, double>(double width, double top)>& draw);

/// Draws the same frame around any charts: a headline, smaller words below it, and the charts row by row.
[[nodiscard]] std::string svg_page(const std::string& headline, const std::string& words, const internal::Picture& drawn,
                                   std::size_t charts_per_row = 1);

}  // namespace softland
