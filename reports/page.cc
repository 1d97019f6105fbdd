#include "reports/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/printable.h"
#include "reports/escape.h"
#include "reports/made_with.h"
#include "reports/page_files.h"
#include "reports/quantity.h"

namespace softland::internal {
namespace {

/// Bytes of text shown per block; more is cut.
constexpr std::size_t most_text = 100'000;
/// Rows per curve in the page: several times the pixels of a wide screen, so that zooming shows more, at about 100 kB a curve.
constexpr std::size_t rows_per_curve = 6000;
constexpr std::size_t most_warnings = 200;

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

std::string section(std::string_view id, std::string_view heading, const std::string& body) {
  return fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", id, heading, body);
}

namespace {

std::string picture_of(const CurveTables& tables, const Chart& chart, const char* style, double width) {
  return fmt::format("<svg class=\"{}\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\">\n{}</svg>\n", style, width,
                     chart_svg_height(chart), escaped(chart.title + ". " + chart.caption), chart_svg(tables, chart, width, 0));
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
                 {"js", std::string(page_file("page/words.js")) + std::string(page_file("page/page.js"))},
                 {"data", script_json(chart_json(drawn, rows_per_curve))}});
}

std::string reproduce(const Result& result) {
  std::string commands;
  for (const std::string& line : result.reproduce) commands += line + "\n";
  if (commands.empty()) commands = result.command;
  std::string with;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) with += (with.empty() ? "With " : ", ") + (name + value);
  };
  add("softland ", result.version);
  add("seed ", result.seed ? fmt::format("{}", *result.seed) : "");
  add("integrator tolerance ", std::isfinite(result.tolerance) ? plain_number(result.tolerance, 6) : "");
  if (commands.empty() && with.empty()) return {};
  const std::string made = made_with_text(result.made_with);
  return fmt::format("<section id=\"reproduce\"><h2>Reproduce it</h2>\n<p>{}</p>\n<pre><code>{}</code></pre>\n{}</section>\n",
                     with.empty() ? "" : escaped(with) + ":", escaped(shortened(commands)),
                     made.empty() ? ""
                                  : "<p>Made with " + escaped(made) +
                                        ". The same bits are to be expected of the same program on the same kind of processor; "
                                        "elsewhere rounding differs, and a search may end elsewhere.</p>\n");
}

std::string scene(const Result& result) {
  if (result.scene.text.empty()) return {};
  return "<section id=\"scene\"><h2>The switch</h2>\n<details><summary>Resolved scene</summary>\n<pre><code>" +
         escaped(shortened(result.scene.text)) + "</code></pre></details></section>\n";
}

std::string warnings_section(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return {};
  std::string lines;
  for (std::size_t i = 0; i < std::min(most_warnings, warnings.size()); ++i)
    lines += fmt::format("<li>{}</li>\n", escaped(shortened(printable_line(warnings[i]))));
  if (warnings.size() > most_warnings) lines += fmt::format("<li>… and {} more</li>\n", warnings.size() - most_warnings);
  return section("warnings", "Warnings", "<ul>\n" + lines + "</ul>\n");
}

std::string page(const Page& parts) {
  const std::string title = escaped(printable_line(parts.title));
  return filled(page_file("page/page.html"), {{"page_title", title.empty() ? "softland report" : title + " – softland"},
                                              {"style", parts.style},
                                              {"css", std::string(page_file("page/page.css"))},
                                              {"origin", escaped(parts.origin)},
                                              {"title", title},
                                              {"headline", escaped(parts.headline)},
                                              {"headline_rest", escaped(parts.headline_rest)},
                                              {"doubt", escaped(parts.doubt)},
                                              {"keys", parts.keys},
                                              {"body", parts.body},
                                              {"scripts", parts.scripts}});
}

}  // namespace softland::internal
