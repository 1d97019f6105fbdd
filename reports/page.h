// The frame of every report page, and the parts that they share.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reports/chart.h"

namespace softland::internal {

/// What stands in the frame. Texts are escaped; what is HTML already is not.
struct Page {
  std::string title;  ///< of the scene; may be empty
  std::string origin;
  std::string headline, headline_rest;
  std::string doubt = {};
  std::string keys = {};     ///< HTML
  std::string body;          ///< HTML
  std::string style = {};    ///< CSS besides that of the frame
  std::string scripts = {};  ///< HTML
};
[[nodiscard]] std::string page(const Page& parts);

/// Replaces each {{name}} of the text by its part; parts are not searched again, so they may contain anything.
[[nodiscard]] std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& parts);

/// Text cut to 100 kB at a line end, with a word about it.
[[nodiscard]] std::string shortened(const std::string& words);

/// A part of a page under a heading; `body` is HTML.
[[nodiscard]] std::string section(std::string_view id, std::string_view heading, const std::string& body);
/// The chart as an <svg> element.
[[nodiscard]] std::string still_picture(const CurveTables& tables, const Chart& chart);
/// The same, small, as one of many beside each other in an element of the class "multiples".
[[nodiscard]] std::string small_picture(const CurveTables& tables, const Chart& chart);
/// The chart in a page, with its title, its caption and the place where the script draws it.
[[nodiscard]] std::string figure_html(const CurveTables& tables, const Chart& chart);
/// The style and the scripts that draw the charts of a page.
[[nodiscard]] std::string chart_style();
[[nodiscard]] std::string chart_scripts(const Picture& drawn);
/// Sections of a result: the command lines that make it again, and its scene.
[[nodiscard]] std::string reproduce(const Result& result);
[[nodiscard]] std::string scene(const Result& result);
/// Empty without warnings.
[[nodiscard]] std::string warnings_section(const std::vector<std::string>& warnings);

}  // namespace softland::internal
