// Parts of report pages.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "document/chart.h"

namespace softland::internal {

/// Replaces each {{name}} of the text by its part; parts are not searched again, so they may contain anything.
[[nodiscard]] std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& parts);

/// Returns the text, cut to 100 kB at a line end, with a note about it.
[[nodiscard]] std::string shortened(const std::string& words);

/// Draws the chart as an <svg> element.
[[nodiscard]] std::string still_picture(const CurveTables& tables, const Chart& chart);
/// Does the same in small, as one of many beside each other in an element of the class "multiples".
[[nodiscard]] std::string small_picture(const CurveTables& tables, const Chart& chart);
/// Returns the chart in a page, with its title, its caption and the place where the script draws it.
[[nodiscard]] std::string figure_html(const CurveTables& tables, const Chart& chart);
/// Returns the style and the scripts that draw the charts of a page.
[[nodiscard]] std::string chart_style();
[[nodiscard]] std::string chart_scripts(const Picture& drawn);

}  // namespace softland::internal
