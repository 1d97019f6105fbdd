// The content of a report, from which a text for a terminal and a web page are made: both have the same sentences and tables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "document/chart.h"

namespace softland {

/// A cell of a table, or the heading of a column. A page shows a symbol such as "t_i" with a subscript.
struct TableCell {
  std::string text;
  std::string style = {};   ///< CSS class of the cell on a page; may be empty
  std::size_t columns = 1;  ///< number of columns that the cell spans
  std::string html = {};    ///< HTML that replaces the text of the cell on a page; empty: the text
  TableCell(std::string words) : text(std::move(words)) {}  // NOLINT(google-explicit-constructor): a text converts to a cell
  TableCell(const char* words) : text(words) {}             // NOLINT(google-explicit-constructor)
  TableCell(std::string_view words) : text(words) {}        // NOLINT(google-explicit-constructor)
  TableCell(std::string words, std::string name, std::size_t wide = 1)
      : text(std::move(words)), style(std::move(name)), columns(wide) {}
};
/// Makes a cell that only a page shows; `html` is not escaped.
[[nodiscard]] TableCell drawn_cell(std::string html, std::string style);

/// A row of a table; the first cell is the heading of the row.
using TableRow = std::vector<TableCell>;
struct ReportTable {
  TableRow head;
  std::vector<TableRow> rows;
};

struct Paragraph {
  std::string text;
  bool is_note = false;  ///< true if the paragraph is a note below a table
};
/// A heading within a section of a report.
struct SubHeading {
  std::string text;
};
/// Lines of text that are never wrapped, such as commands.
struct ReportList {
  std::vector<std::string> lines;
};
/// A picture that only a web page shows. The function `html` draws it when the page is written, so that a report on a terminal
/// costs no time for drawing.
struct Drawing {
  std::function<std::string(const internal::Picture&)> html;  ///< returns HTML, not escaped, from the result of Document::draw
};
[[nodiscard]] Drawing drawing_of(std::string html);

/// The media (web page, terminal) that show a section of a report.
enum class ShownIn { everywhere, page, terminal };

/// A part of a page under a heading; a terminal omits the heading.
struct ReportSection {
  std::string id, heading;
  std::vector<std::variant<Paragraph, SubHeading, ReportTable, ReportList, Drawing>> parts;
  ShownIn shown = ShownIn::everywhere;
};

/// A main result of a study, such as the impact velocity, that the top of the web page shows in large type.
struct KeyNumber {
  std::string name, value;
  std::string change = {};  ///< change of the number from its value under the plain voltage step, in words; may be empty
  std::string before = {};  ///< value of the number under the plain voltage step; may be empty
  std::string style = {};   ///< CSS class of the text `change` on the page
  bool is_words = false;    ///< true if the value is words instead of a number
};

/// The data that a user needs to compute the results of a page again: version, command, scene, seed and tolerance.
struct MadeAgain {
  std::string version, command;  ///< version of the program, and command line, that gave the results
  std::string made_with;         ///< compiler and machine that gave the results, one line; empty if unknown
  std::string scene;             ///< resolved scene (all defaults written out) as the text of a scene file; may be empty
  std::optional<std::uint64_t> seed = {};
  double tolerance = std::numeric_limits<double>::quiet_NaN();  ///< relative tolerance of the integrator that gave the results
  std::vector<std::string> reproduce = {};                      ///< commands that repeat the results; empty: `command` does
};

/// A report for the terminal and for a web page. Functions such as `draw` refer to the results of the study (for example a
/// ClosingRecord), which must outlive the document.
struct Document {
  std::string title;  ///< title of the scene that the report is about; may be empty
  std::string origin;
  std::string headline, headline_rest;
  std::string doubt;
  std::vector<KeyNumber> keys;
  std::vector<ReportSection> sections;
  std::vector<std::string> warnings;
  std::function<internal::Picture()> draw;  ///< returns the charts for the page's script; may be empty
  MadeAgain made = {};                      ///< version, command, scene and seed that gave the results
  /// CSS and HTML that the page needs for pictures other than the charts of `draw`.
  std::string style = {}, scripts = {};
};

/// Returns headline, sentences and tables of the document for a terminal, at most `screen` columns wide where words permit it.
[[nodiscard]] std::string terminal_text(const Document& document, std::size_t screen = 130);
/// Returns the document as a self-contained HTML page (< 1 MB): styles, script and data are inside, and the page loads nothing
/// else. In print and without JavaScript, the charts are static SVG. All text is escaped.
[[nodiscard]] std::string page_html(const Document& document);

namespace internal {

/// Returns the table as text. Columns that do not fit into `screen` characters are printed as a second table below, except a
/// last column of words. Lines have no trailing blanks.
[[nodiscard]] std::string table_text(const ReportTable& table, std::size_t screen = 130);
[[nodiscard]] std::string table_html(const ReportTable& table);
/// Draws every chart of the document with its title and caption.
[[nodiscard]] Drawing all_charts();
/// Returns the words as escaped HTML; a symbol such as "t_i" gets a subscript.
[[nodiscard]] std::string words_html(std::string_view words);

}  // namespace internal
}  // namespace softland
