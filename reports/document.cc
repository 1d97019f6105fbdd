#include "reports/document.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/printable.h"
#include "objectives/figures.h"
#include "reports/escape.h"
#include "reports/page.h"
#include "reports/text.h"

namespace softland {

using namespace internal;

namespace {

constexpr std::string_view words_style = "words", missing_style = "missing", part_style = "part";
constexpr std::size_t gap = 2;  // blanks between columns of a terminal

// Numbers stand to the right, words to the left.
bool is_words(const TableCell& cell) { return cell.style == words_style || cell.style == missing_style || cell.columns > 1; }

std::string_view shown_text(const TableCell& cell, std::string& indented) {
  if (cell.style != part_style) return cell.text;
  return indented = "  " + cell.text;
}

// Calls `use(cell, place)` for every cell of a row with the column at which it begins.
template <class Use>
void each_cell(const TableRow& row, Use use) {
  std::size_t place = 0;
  for (const TableCell& cell : row) {
    use(cell, place);
    place += cell.columns;
  }
}

std::vector<std::size_t> widths_of(const ReportTable& table) {
  std::vector<std::size_t> widths(table.head.size(), 0);
  const auto measure = [&](const TableRow& row) {
    each_cell(row, [&](const TableCell& cell, std::size_t place) {
      std::string indented;
      if (cell.columns == 1) widths[place] = std::max(widths[place], display_width(shown_text(cell, indented)));
    });
  };
  measure(table.head);
  for (const TableRow& row : table.rows) measure(row);
  return widths;
}

// The columns from `first` to before `last`, beside that of the headings.
std::string line_of(const TableRow& row, const ReportTable& table, const std::vector<std::size_t>& widths, std::size_t first,
                    std::size_t last) {
  std::string line;
  each_cell(row, [&](const TableCell& cell, std::size_t place) {
    std::string indented;
    const std::string text(shown_text(cell, indented));
    if (place == 0) line += left_aligned(text, widths[0]);
    if (place < first || place >= last) return;
    std::size_t width = widths[place];
    for (std::size_t i = place + 1; i < std::min(place + cell.columns, last); ++i) width += gap + widths[i];
    const bool left = is_words(cell) || table.head[place].style == words_style;
    line += std::string(gap, ' ') + (left ? left_aligned(text, width) : right_aligned(text, width));
  });
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string symbol_html(std::string_view symbol) {
  const std::size_t at = symbol.find('_');
  return fmt::format("{}<sub>{}</sub>", symbol.substr(0, at), symbol.substr(at + 1));
}

bool has_index(std::string_view word) {
  return word.find('_') != std::string_view::npos &&
         std::any_of(figure_table.begin(), figure_table.end(), [&](const Figure& f) { return f.symbol == word; });
}

std::string cell_html(const TableCell& cell, const TableCell* column, std::string_view tag, std::string_view scope) {
  const bool is_column_of_words = column != nullptr && column->style == words_style;
  const std::string_view style = cell.style.empty() && is_column_of_words ? words_style : std::string_view(cell.style);
  std::string out = fmt::format("<{}", tag);
  if (!scope.empty()) out += fmt::format(" scope=\"{}\"", scope);
  if (!style.empty()) out += fmt::format(" class=\"{}\"", style);
  if (cell.columns > 1) out += fmt::format(" colspan=\"{}\"", cell.columns);
  return out + fmt::format(">{}</{}>", cell.html.empty() ? words_html(cell.text) : cell.html, tag);
}

// Parts as a terminal shows them, a blank line between two, none below a heading.
struct OnTerminal {
  std::size_t screen;
  std::string text = {};
  bool is_below_heading = false;

  void add(const std::string& part) {
    if (part.empty()) return;
    if (!text.empty() && !is_below_heading) text += "\n";
    text += part;
    is_below_heading = false;
  }
  void words(const std::string& all) { add(all.empty() ? all : wrapped(all) + "\n"); }
  void operator()(const Paragraph& part) { words(part.text); }
  void operator()(const SubHeading& part) {
    words(part.text + ":");
    is_below_heading = true;
  }
  void operator()(const ReportTable& part) { add(table_text(part, screen)); }
  void operator()(const ReportList& part) {
    std::string lines;
    for (const std::string& line : part.lines) lines += "  " + printable_line(line) + "\n";
    add(lines);
  }
  void operator()(const Drawing& /*part*/) {}
};

struct OnPage {
  std::string operator()(const Paragraph& part) const {
    if (part.text.empty()) return {};
    return fmt::format("<p{}>{}</p>\n", part.is_note ? " class=\"below\"" : "", words_html(part.text));
  }
  std::string operator()(const SubHeading& part) const { return "<h3>" + words_html(part.text) + "</h3>\n"; }
  std::string operator()(const ReportTable& part) const { return table_html(part); }
  std::string operator()(const ReportList& part) const {
    std::string lines;
    for (const std::string& line : part.lines) lines += "<li>" + words_html(shortened(line)) + "</li>\n";
    return "<ul>\n" + lines + "</ul>\n";
  }
  std::string operator()(const Drawing& part) const { return part.html; }
};

}  // namespace

TableCell drawn_cell(std::string html, std::string style) {
  TableCell cell("", std::move(style));
  cell.html = std::move(html);
  return cell;
}

std::string internal::words_html(std::string_view words) {
  constexpr std::string_view ends = " ,:;()";
  std::string out;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find_first_of(ends), words.size());
    const std::size_t stop = end > 0 && words[end - 1] == '.' ? end - 1 : end;  // of a sentence
    const std::string_view word = words.substr(0, stop);
    out += has_index(word) ? symbol_html(word) : escaped(word);
    out += escaped(words.substr(stop, std::min(end + 1, words.size()) - stop));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return out;
}

std::string internal::key_html(const KeyNumber& key) {
  const auto part = [](std::string_view style, const std::string& html) {
    return fmt::format("<span class=\"{}\">{}</span> ", style, html);
  };
  std::string shown;
  if (!key.before.empty()) shown += part("before", words_html(key.before) + " <span aria-label=\"becomes\">→</span>");
  shown += part(key.is_words ? "after words" : "after", words_html(key.value));
  if (!key.change.empty()) shown += part(key.style.empty() ? "change" : "change " + key.style, words_html(key.change));
  return fmt::format("<div class=\"key\"><dt>{}</dt><dd>{}</dd></div>\n", words_html(key.name), shown);
}

std::string internal::table_text(const ReportTable& table, std::size_t screen) {
  const std::vector<std::size_t> widths = widths_of(table);
  std::string text;
  std::size_t first = 1;
  do {
    std::size_t last = first, used = widths.front();
    const auto fits = [&](std::size_t column) {
      const bool is_last_words = column + 1 == widths.size() && table.head[column].style == words_style;
      return column == first || is_last_words || used + gap + widths[column] <= screen;
    };
    while (last < widths.size() && fits(last)) used += gap + widths[last++];
    if (!text.empty()) text += "\n";
    text += line_of(table.head, table, widths, first, last);
    for (const TableRow& row : table.rows) text += line_of(row, table, widths, first, last);
    first = last;
  } while (first < widths.size());
  return text;
}

std::string internal::table_html(const ReportTable& table) {
  std::string out = "<div class=\"scroll\"><table><thead><tr>";
  for (const TableCell& cell : table.head) out += cell_html(cell, nullptr, "th", "col");
  out += "</tr></thead><tbody>\n";
  for (const TableRow& row : table.rows) {
    out += "<tr>";
    each_cell(row, [&](const TableCell& cell, std::size_t place) {
      out += place == 0 ? cell_html(cell, nullptr, "th", "row") : cell_html(cell, &table.head[place], "td", "");
    });
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

Drawing internal::charts_of(const Picture& drawn) {
  Drawing all;
  for (const Chart& chart : drawn.charts) all.html += figure_html(drawn.tables, chart);
  return all;
}

std::string terminal_text(const Document& document, std::size_t screen) {
  OnTerminal shown{.screen = screen};
  shown.words(document.headline + document.headline_rest);
  shown.words(document.doubt);
  for (const ReportSection& section : document.sections) {
    if (section.is_page_only) continue;
    for (const auto& part : section.parts) std::visit(shown, part);
  }
  for (const std::string& warning : document.warnings) shown.words("warning: " + warning);
  return shown.text;
}

std::string page_html(const Document& document) {
  std::string keys, body;
  for (const KeyNumber& key : document.keys) keys += key_html(key);
  for (const ReportSection& one : document.sections) {
    std::string parts;
    for (const auto& part : one.parts) parts += std::visit(OnPage{}, part);
    if (!parts.empty()) body += section(one.id, escaped(one.heading), parts);
  }
  body += warnings_section(document.warnings);
  return page({.title = document.title,
               .origin = document.origin,
               .headline = document.headline,
               .headline_rest = document.headline_rest,
               .doubt = document.doubt,
               .keys = keys,
               .body = body + reproduce(document.made) + scene(document.made),
               .style = document.style.empty() ? chart_style() : document.style,
               .scripts = document.scripts.empty() ? chart_scripts(document.drawn) : document.scripts});
}

}  // namespace softland
