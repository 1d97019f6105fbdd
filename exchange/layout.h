// Divides the lines of a file into columns. Internal to exchange/.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace softland::internal {

using CellList = std::vector<std::string_view>;

/// A line of the file; its cells are views of it.
struct Line {
  std::string_view text;
  std::size_t number = 0;
};

/// Messages about a file.
class Refusals {
 public:
  explicit Refusals(std::string file) : file_(std::move(file)) {}
  /// Throws InvalidInput "file:line: column 2: rule"; column 0: none is meant.
  [[noreturn]] void fail(std::size_t line, std::size_t column, const std::string& rule) const;
  /// Throws InvalidInput "file: rule".
  [[noreturn]] void fail(const std::string& rule) const;
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::string file_;
};

/// The part of a cell that a message shows.
[[nodiscard]] std::string shown_cell(std::string_view cell);
/// The cells of a line; a unit behind a number belongs to its cell, "5.0 V", where blanks separate, too.
void split_row(std::string_view line, char separator, CellList& cells);
[[nodiscard]] bool is_blank(const CellList& cells);
/// True if a cell is a number, with or without a unit.
[[nodiscard]] bool holds_number(std::string_view cell);
/// True if a cell is such a number, blank, or the word that instruments write for a number that they do not have.
[[nodiscard]] bool may_be_value(std::string_view cell);
[[nodiscard]] std::size_t numbers_in(const CellList& cells);

/// The last lines of a text that are not blank, from the last one up, beyond `skip` lines. A last line that the end of the file
/// may have cut comes last of all. Their numbers count from some line on.
[[nodiscard]] std::vector<Line> last_lines(std::string_view text, std::size_t skip);

/// The separator of the cells of these lines: that with which most of them are numbers alone, or else hold one.
[[nodiscard]] char separator_of(const std::vector<Line>& lines);

/// The columns that hold numbers: those with more of them than words in the last lines, as far up as lines hold any. Numbers of
/// lines without words decide if there are such lines. The last one is true; empty where there are no numbers.
[[nodiscard]] std::vector<bool> numeric_columns(const std::vector<Line>& last, char separator);

}  // namespace softland::internal
