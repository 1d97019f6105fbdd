#include "document/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "base/printable.h"
#include "document/chart.h"
#include "document/escape.h"

namespace softland {
namespace {

constexpr double between = 14;  // distance between the charts of a picture [px]

/// Breaks a text into lines of at most `columns` bytes; a longer word has a line of its own.
std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
  const std::string words = printable_line(text);
  std::vector<std::string> lines{""};
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    const std::string word = words.substr(begin, end - begin);
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > columns) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    begin = end + 1;
  }
  return lines;
}

// Colours of charts with their replacements for a reader whose browser prefers a dark colour scheme.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> dark_colours{{{"#fff", "#131416"},
                                                                                     {"#1b1f24", "#e6e8ea"},
                                                                                     {"#5f6b76", "#a7b0b8"},
                                                                                     {"#f1f3f4", "#1d2023"},
                                                                                     {"#e4e7ea", "#33383d"},
                                                                                     {"#0072b2", "#4da3dd"},
                                                                                     {"#2b6cb0", "#6aa5e3"},
                                                                                     {"#b83232", "#e06c6c"}}};

std::string dark_style() {
  std::string rules;
  for (const char* what : {"fill", "stroke"})
    for (const auto& [light, dark] : dark_colours) rules += fmt::format("[{0}=\"{1}\"]{{{0}:{2}}}", what, light, dark);
  return fmt::format("<style>@media (prefers-color-scheme:dark){{{}}}</style>\n", rules);
}

}  // namespace

std::string svg_frame(const std::string& headline, const std::string& words,
                      const std::function<std::pair<std::string, double>(double width, double top)>& draw) {
  using internal::escaped;
  constexpr double width = 900;
  constexpr double margin = 24;
  constexpr double line_height = 24;
  constexpr std::size_t columns = 88;

  std::string body;
  double top = margin;
  for (const std::string& line : wrapped(headline, columns)) {
    body += fmt::format("<text x=\"0\" y=\"{:.1f}\" fill=\"#1b1f24\" font-size=\"17\" font-weight=\"600\">{}</text>\n", top,
                        escaped(line));
    top += line_height;
  }
  if (!words.empty()) {
    for (const std::string& line : wrapped(words, columns + 30)) {
      body += fmt::format("<text x=\"0\" y=\"{:.1f}\" fill=\"#5f6b76\" font-size=\"13\">{}</text>\n", top, escaped(line));
      top += line_height;
    }
  }
  const auto [elements, bottom] = draw(width - 2 * margin, top + between);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" viewBox=\"0 0 {0} {1:.0f}\" role=\"img\" "
      "font-family=\"system-ui, 'Segoe UI', Helvetica, Arial, sans-serif\">\n<title>{2}</title>\n{6}<rect width=\"100%\" "
      "height=\"100%\" fill=\"#fff\"/>\n"
      "<g transform=\"translate({3} {4})\">\n{5}</g>\n</svg>\n",
      width, bottom + margin, escaped(printable_line(headline)), margin, 10, body + elements, dark_style());
}

std::string svg_page(const std::string& headline, const std::string& words, const internal::Picture& drawn,
                     std::size_t charts_per_row) {
  using namespace internal;
  return svg_frame(headline, words, [&](double width, double top) {
    const double cell = (width - between * static_cast<double>(charts_per_row - 1)) / static_cast<double>(charts_per_row);
    std::string body;
    double row_height = 0;
    for (std::size_t i = 0; i < drawn.charts.size(); ++i) {
      const std::size_t column = i % charts_per_row;
      if (column == 0) {
        top += row_height;
        row_height = 0;
      }
      const std::string chart = chart_svg(drawn.tables, drawn.charts[i], cell, top);
      row_height = std::max(row_height, chart_svg_height(drawn.charts[i], cell) + between);
      body += column == 0 ? chart
                          : fmt::format("<g transform=\"translate({:.1f} 0)\">\n{}</g>\n",
                                        static_cast<double>(column) * (cell + between), chart);
    }
    return std::pair{body, top + row_height};
  });
}

}  // namespace softland
