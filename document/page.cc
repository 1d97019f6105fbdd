#include "document/page.h"

#include <fmt/format.h>

#include "document/chart_json.h"
#include "document/escape.h"
#include "document/page_files.h"

namespace softland::internal {
namespace {

/// largest number of bytes in a block of text on a page; the rest is cut
constexpr std::size_t most_text = 100'000;
/// Number of rows of a curve in a page: several times the pixels of a wide screen, so that zooming shows more detail, at about
/// 100 kB per curve.
constexpr std::size_t rows_per_curve = 6000;

}  // namespace

std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& parts) {
  std::string out;
  for (;;) {
    const std::size_t begin = text.find("{{");
    if (begin == std::string_view::npos) break;
    const std::size_t end = text.find("}}", begin);
    out += text.substr(0, begin);
    out += parts.find(text.substr(begin + 2, end - begin - 2))->second;
    text.remove_prefix(end + 2);
  }
  return out + std::string(text);
}

std::string shortened(const std::string& words) {
  if (words.size() <= most_text) return words;
  return words.substr(0, words.rfind('\n', most_text)) +
         fmt::format("\n... cut: {} of {} bytes are not shown", words.size() - most_text, words.size());
}

namespace {

std::string picture_of(const CurveTables& tables, const Chart& chart, const char* style, double width) {
  return fmt::format("<svg class=\"{}\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\">\n{}</svg>\n", style, width,
                     chart_svg_height(chart, width), escaped(chart.title + ". " + chart.caption),
                     chart_svg(tables, chart, width, 0));
}

}  // namespace

std::string still_picture(const CurveTables& tables, const Chart& chart) { return picture_of(tables, chart, "still", 960); }
std::string small_picture(const CurveTables& tables, const Chart& chart) { return picture_of(tables, chart, "small", 440); }

std::string figure_html(const CurveTables& tables, const Chart& chart) {
  return fmt::format("<figure id=\"figure-{0}\"><h3>{1}</h3>\n<div class=\"live\" data-chart=\"{0}\"></div>\n", chart.id,
                     escaped(chart.title)) +
         still_picture(tables, chart) + fmt::format("<figcaption>{}</figcaption></figure>\n", escaped(chart.caption));
}

std::string chart_style() { return std::string(page_file("uplot/uPlot.min.css")); }

std::string chart_scripts(const Picture& drawn) {
  return filled(page_file("page/scripts.html"),
                {{"chart_js", std::string(page_file("uplot/uPlot.iife.min.js"))},
                 {"chart_licence", std::string(page_file("uplot/LICENSE"))},
                 {"js", std::string(page_file("page/words.js")) + std::string(page_file("page/page.js")) +
                            std::string(page_file("page/animation.js"))},
                 {"data", script_json(chart_json(drawn, rows_per_curve))}});
}

}  // namespace softland::internal
