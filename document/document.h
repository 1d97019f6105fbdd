// The content of a report, stated once: a terminal and a page show the same sentences and tables.
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

/// A cell of a table, or a heading. Symbols get their indices on a page: "t_i".
struct TableCell {
  std::string text;
  std::string style = {};                                   ///< name of a class of the page; may be empty
  std::size_t columns = 1;                                  ///< number of columns that it takes
  std::string html = {};                                    ///< replaces the text on a page
  TableCell(std::string words) : text(std::move(words)) {}  // NOLINT(google-explicit-constructor): a cell is its text
  TableCell(const char* words) : text(words) {}             // NOLINT(google-explicit-constructor)
  TableCell(std::string_view words) : text(words) {}        // NOLINT(google-explicit-constructor)
  TableCell(std::string words, std::string name, std::size_t wide = 1)
      : text(std::move(words)), style(std::move(name)), columns(wide) {}
};
/// Makes a cell that only a page shows; `html` is not escaped.
[[nodiscard]] TableCell drawn_cell(std::string html, std::string style);

/// The first cell of a row is its heading.
using TableRow = std::vector<TableCell>;
struct ReportTable {
  TableRow head;
  std::vector<TableRow> rows;
};

struct Paragraph {
  std::string text;
  bool is_note = false;  ///< true for a note below a table
};
/// The heading of a part of a section.
struct SubHeading {
  std::string text;
};
/// Lines that are not broken, such as commands.
struct ReportList {
  std::vector<std::string> lines;
};
/// A picture that only a page shows. It is made with the page: a terminal does not wait for pictures.
struct Drawing {
  std::function<std::string(const internal::Picture&)> html;  ///< makes HTML from the document's picture; not escaped
};
[[nodiscard]] Drawing drawing_of(std::string html);

/// The media that show a section.
enum class ShownIn { everywhere, page, terminal };

/// A part of a page under a heading; a terminal omits the heading.
struct ReportSection {
  std::string id, heading;
  std::vector<std::variant<Paragraph, SubHeading, ReportTable, ReportList, Drawing>> parts;
  ShownIn shown = ShownIn::everywhere;
};

/// A number that stands above everything else of a page, with its name.
struct KeyNumber {
  std::string name, value;
  std::string change = {};  ///< change in words; may be empty
  std::string before = {};  ///< value of the plain step; may be empty
  std::string style = {};   ///< style of the change, a class of the page
  bool is_words = false;    ///< true for a value without a number
};

/// The data that reproduce the contents of a page.
struct MadeAgain {
  std::string version, command;  ///< those of the program
  std::string made_with;         ///< compiler and machine, one line; empty where nothing is known
  std::string scene;             ///< resolved scene as a file; may be empty
  std::optional<std::uint64_t> seed = {};
  double tolerance = std::numeric_limits<double>::quiet_NaN();  ///< tolerance of the integrator
  std::vector<std::string> reproduce = {};                      ///< command lines; empty: the one of `command`
};

/// A document refers to the record it was made from, which must outlive it.
struct Document {
  std::string title;  ///< title of the scene; may be empty
  std::string origin;
  std::string headline, headline_rest;
  std::string doubt;
  std::vector<KeyNumber> keys;
  std::vector<ReportSection> sections;
  std::vector<std::string> warnings;
  std::vector<std::string> page_warnings = {};  ///< warnings beside those on the page alone
  std::function<internal::Picture()> draw;      ///< makes the charts for the page's script; may be empty
  MadeAgain made = {};                          ///< data that reproduce the contents
  /// CSS and HTML of pictures that `draw` does not make.
  std::string style = {}, scripts = {};
};

/// Returns headline, sentences and tables for a terminal, at most `screen` columns wide where words permit it.
[[nodiscard]] std::string terminal_text(const Document& document, std::size_t screen = 130);
/// Returns a self-contained HTML page (< 1 MB): it makes no request; styles, script and data are inside. Without JavaScript and
/// in print the charts are static SVG. All text is escaped.
[[nodiscard]] std::string page_html(const Document& document);

namespace internal {

/// Prints columns that do not fit on the screen below the others, except a last one of words. Lines have no blanks at their
/// end.
[[nodiscard]] std::string table_text(const ReportTable& table, std::size_t screen = 130);
[[nodiscard]] std::string table_html(const ReportTable& table);
/// Draws every chart of the document with its title and caption.
[[nodiscard]] Drawing all_charts();
/// Returns the words escaped, with the indices of symbols below: "t_i".
[[nodiscard]] std::string words_html(std::string_view words);

}  // namespace internal
}  // namespace softland
