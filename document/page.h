// Parts of the HTML pages of reports.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "document/chart.h"

namespace softland::internal {

/// Replaces each {{NAME}} in a template by the element NAME of `parts`. The inserted text is not searched for further {{NAME}}.
[[nodiscard]] std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& parts);

/// Returns the text, cut at a line end to at most 100 kB; a note then says that it was cut.
[[nodiscard]] std::string shortened(const std::string& words);

/// Draws the chart as a static <svg> element.
[[nodiscard]] std::string still_picture(const CurveTables& tables, const Chart& chart);
/// Draws the chart as a small static <svg> element, for rows of small charts in an element of CSS class "multiples".
[[nodiscard]] std::string small_picture(const CurveTables& tables, const Chart& chart);
/// Returns the HTML of a chart: title, caption, and the element in which the page's script (uPlot) draws the chart.
[[nodiscard]] std::string figure_html(const CurveTables& tables, const Chart& chart);
/// Returns the HTML that a page needs to draw charts: the CSS style and the scripts.
[[nodiscard]] std::string chart_style();
[[nodiscard]] std::string chart_scripts(const Picture& drawn);

}  // namespace softland::internal
