// Frames around charts for SVG files, which are read without a web page.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "document/chart.h"

namespace softland {

/// Returns an SVG document with a headline, smaller words below it, and a picture. The function draw(width, top) returns the
/// elements of the picture and their lower end [px].
[[nodiscard]] std::string svg_frame(const std::string& headline, const std::string& words,
                                    const std::function<std::pair<std::string, double>(double width, double top)>& draw);

/// Returns an SVG document with a headline, smaller words below it, and the charts row by row.
[[nodiscard]] std::string svg_page(const std::string& headline, const std::string& words, const internal::Picture& drawn,
                                   std::size_t charts_per_row = 1);

}  // namespace softland
