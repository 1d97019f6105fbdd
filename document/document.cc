#include "document/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/printable.h"
#include "document/escape.h"
#include "document/page.h"
#include "document/page_files.h"
#include "document/quantity.h"
#include "document/text.h"

namespace softland {

using namespace internal;

namespace {

constexpr std::string_view words_style = "words", missing_style = "missing", part_style = "part";
constexpr std::size_t most_warnings = 200;  // largest number of warnings that a page shows
constexpr std::size_t gap = 2;              // blanks between columns of a table on a terminal

// Returns the heading of the table's column with index `place`; null if the column has no heading.
const TableCell* head_of(const ReportTable& table, std::size_t place) {
  return place < table.head.size() ? &table.head[place] : nullptr;
}

bool is_of_words(const TableCell* head) { return head != nullptr && head->style == words_style; }

// Returns the text of a cell for a terminal. Control characters, which names in a scene may contain, are escaped.
std::string shown_text(const TableCell& cell) { return (cell.style == part_style ? "  " : "") + printable_line(cell.text); }

// Calls `use(cell, place)` for every cell of a row; `place` is the first column that the cell spans.
template <class Use>
void each_cell(const TableRow& row, Use use) {
  std::size_t place = 0;
  for (const TableCell& cell : row) {
    use(cell, place);
    place += cell.columns;
  }
}

std::vector<std::size_t> widths_of(const ReportTable& table) {
  std::vector<std::size_t> widths(std::max<std::size_t>(table.head.size(), 1), 0);
  const auto measure = [&](const TableRow& row) {
    each_cell(row, [&](const TableCell& cell, std::size_t place) {
      widths.resize(std::max(widths.size(), place + cell.columns), 0);
      if (cell.columns == 1) widths[place] = std::max(widths[place], display_width(shown_text(cell)));
    });
  };
  measure(table.head);
  for (const TableRow& row : table.rows) measure(row);
  return widths;
}

// Returns a row of a table as a line of text: the first cell, which is the row's heading, and the columns with indices from
// `first` to `last` - 1. Numbers are right-aligned, words left-aligned.
std::string line_of(const TableRow& row, const ReportTable& table, const std::vector<std::size_t>& widths, std::size_t first,
                    std::size_t last) {
  std::string line;
  each_cell(row, [&](const TableCell& cell, std::size_t place) {
    const std::string text = shown_text(cell);
    if (place == 0) line += left_aligned(text, widths[0]);
    if (place < first || place >= last) return;
    std::size_t width = widths[place];
    for (std::size_t i = place + 1; i < std::min(place + cell.columns, last); ++i) width += gap + widths[i];
    const bool is_words = cell.columns > 1 || cell.style == missing_style || is_of_words(head_of(table, place));
    line += std::string(gap, ' ') + (is_words ? left_aligned(text, width) : right_aligned(text, width));
  });
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string symbol_html(std::string_view symbol) {
  const std::size_t at = symbol.find('_');
  return fmt::format("{}<sub>{}</sub>", symbol.substr(0, at), symbol.substr(at + 1));
}

// Returns true for a symbol with a subscript, such as "t_i" or "v_max".
bool has_index(std::string_view word) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (word.size() < 3 || !is_letter(word[0]) || word[1] != '_') return false;
  const std::string_view index = word.substr(2);
  return index == "max" || index == "min" || (index.size() == 1 && (is_letter(index[0]) || (index[0] >= '0' && index[0] <= '9')));
}

std::string cell_html(const TableCell& cell, const TableCell* head, std::string_view tag, std::string_view scope) {
  const std::string_view style = cell.style.empty() && is_of_words(head) ? words_style : std::string_view(cell.style);
  std::string out = fmt::format("<{}", tag);
  if (!scope.empty()) out += fmt::format(" scope=\"{}\"", scope);
  if (!style.empty()) out += fmt::format(" class=\"{}\"", style);
  if (cell.columns > 1) out += fmt::format(" colspan=\"{}\"", cell.columns);
  return out + fmt::format(">{}</{}>", cell.html.empty() ? words_html(cell.text) : cell.html, tag);
}

// Prints the parts of a document on a terminal, with a blank line between two parts, but none below a heading.
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
  const Picture& drawn;

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
  std::string operator()(const Drawing& part) const { return part.html(drawn); }
};

std::string section_html(std::string_view id, std::string_view heading, const std::string& body) {
  return fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", id, heading, body);
}

std::string key_html(const KeyNumber& key) {
  const auto part = [](std::string_view style, const std::string& html) {
    return fmt::format("<span class=\"{}\">{}</span> ", style, html);
  };
  std::string shown;
  if (!key.before.empty()) shown += part("before", words_html(key.before) + " <span aria-label=\"becomes\">→</span>");
  shown += part(key.is_words ? "after words" : "after", words_html(key.value));
  if (!key.change.empty()) shown += part(key.style.empty() ? "change" : "change " + key.style, words_html(key.change));
  return fmt::format("<div class=\"key\"><dt>{}</dt><dd>{}</dd></div>\n", words_html(key.name), shown);
}

std::string reproduce(const MadeAgain& made) {
  std::string commands;
  for (const std::string& line : made.reproduce) commands += line + "\n";
  if (commands.empty()) commands = made.command;
  std::string with;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) with += (with.empty() ? "With " : ", ") + (name + value);
  };
  add("softland ", made.version);
  add("seed ", made.seed ? fmt::format("{}", *made.seed) : "");
  add("integrator tolerance ", std::isfinite(made.tolerance) ? plain_number(made.tolerance, 6) : "");
  if (commands.empty() && with.empty()) return {};
  return fmt::format(
      "<section id=\"reproduce\"><h2>How to reproduce this result</h2>\n<p>{}</p>\n<pre><code>{}</code></pre>\n{}</section>\n",
      with.empty() ? "" : escaped(with) + ":", escaped(shortened(commands)),
      made.made_with.empty() ? ""
                             : "<p>Made with " + escaped(made.made_with) +
                                   ". The same program on the same kind of processor gives the same bits. Elsewhere rounding "
                                   "differs, and a search may find another result.</p>\n");
}

std::string scene_of(const MadeAgain& made) {
  if (made.scene.empty()) return {};
  return "<section id=\"scene\"><h2>Scene</h2>\n<details><summary>Resolved scene</summary>\n<pre><code>" +
         escaped(shortened(made.scene)) + "</code></pre></details></section>\n";
}

std::string warnings_section(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return {};
  std::string lines;
  for (std::size_t i = 0; i < std::min(most_warnings, warnings.size()); ++i)
    lines += fmt::format("<li>{}</li>\n", escaped(shortened(printable_line(warnings[i]))));
  if (warnings.size() > most_warnings) lines += fmt::format("<li>… and {} more</li>\n", warnings.size() - most_warnings);
  return section_html("warnings", "Warnings", "<ul>\n" + lines + "</ul>\n");
}

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
    // The full stop at the end of a sentence is not part of a symbol such as t_i.
    const std::size_t stop = end > 0 && words[end - 1] == '.' ? end - 1 : end;
    const std::string_view word = words.substr(0, stop);
    out += has_index(word) ? symbol_html(word) : escaped(word);
    out += escaped(words.substr(stop, std::min(end + 1, words.size()) - stop));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return out;
}

std::string internal::table_text(const ReportTable& table, std::size_t screen) {
  const std::vector<std::size_t> widths = widths_of(table);
  std::string text;
  std::size_t first = 1;
  do {
    std::size_t last = first, used = widths.front();
    const auto fits = [&](std::size_t column) {
      const bool is_last_words = column + 1 == widths.size() && is_of_words(head_of(table, column));
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
      out += place == 0 ? cell_html(cell, nullptr, "th", "row") : cell_html(cell, head_of(table, place), "td", "");
    });
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

Drawing drawing_of(std::string html) {
  return {[html = std::move(html)](const Picture&) { return html; }};
}

Drawing internal::all_charts() {
  return {[](const Picture& drawn) {
    std::string all;
    for (const Chart& chart : drawn.charts) all += figure_html(drawn.tables, chart);
    return all;
  }};
}

std::string terminal_text(const Document& document, std::size_t screen) {
  OnTerminal shown{.screen = screen};
  shown.words(document.headline + document.headline_rest);
  shown.words(document.doubt);
  for (const ReportSection& section : document.sections) {
    if (section.shown == ShownIn::page) continue;
    for (const auto& part : section.parts) std::visit(shown, part);
  }
  for (const std::string& warning : document.warnings) shown.words("warning: " + warning);
  return shown.text;
}

std::string page_html(const Document& document) {
  const Picture drawn = document.draw ? document.draw() : Picture();
  std::string keys, body;
  for (const KeyNumber& key : document.keys) keys += key_html(key);
  for (const ReportSection& section : document.sections) {
    if (section.shown == ShownIn::terminal) continue;
    std::string parts;
    for (const auto& part : section.parts) parts += std::visit(OnPage{drawn}, part);
    if (!parts.empty()) body += section_html(section.id, escaped(section.heading), parts);
  }
  body += warnings_section(document.warnings) + reproduce(document.made) + scene_of(document.made);
  const std::string title = escaped(printable_line(document.title));
  return filled(page_file("page/page.html"), {{"page_title", title.empty() ? "softland report" : title + " – softland"},
                                              {"style", document.style.empty() ? chart_style() : document.style},
                                              {"css", std::string(page_file("page/page.css"))},
                                              {"origin", escaped(document.origin)},
                                              {"title", title},
                                              {"headline", escaped(document.headline)},
                                              {"headline_rest", escaped(document.headline_rest)},
                                              {"doubt", escaped(document.doubt)},
                                              {"keys", keys},
                                              {"body", body},
                                              {"scripts", document.scripts.empty() ? chart_scripts(drawn) : document.scripts}});
}

}  // namespace softland
