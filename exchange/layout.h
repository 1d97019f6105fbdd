// Divides the lines of a file into columns. Internal to exchange/.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace softland::internal {

using CellList = std::vector<std::string_view>;

/// A line of the file; `text` is a view of the file's content.
struct Line {
  std::string_view text;
  std::size_t number = 0;
};

/// Throws InvalidInput with the name of the file that is read, and the line and column where they are known.
class Refusals {
 public:
  explicit Refusals(std::string file) : file_(std::move(file)) {}
  /// Throws InvalidInput "file:line: column 2: rule"; column 0: the message names no column.
  [[noreturn]] void fail(std::size_t line, std::size_t column, const std::string& rule) const;
  /// Throws InvalidInput with the text "file: rule".
  [[noreturn]] void fail(const std::string& rule) const;
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::string file_;
};

/// Returns the text of a cell, shortened for a message.
[[nodiscard]] std::string shown_cell(std::string_view cell);
/// Splits a line into cells at the separator. A number and its unit, "5.0 V", are one cell even if blanks separate the cells.
void split_row(std::string_view line, char separator, CellList& cells);
[[nodiscard]] bool is_blank(const CellList& cells);
/// Returns true if a cell is a number, with or without a unit.
[[nodiscard]] bool holds_number(std::string_view cell);
/// Returns true if a cell is a number with or without a unit, blank, or a word that instruments write for a missing number.
[[nodiscard]] bool may_be_value(std::string_view cell);
[[nodiscard]] std::size_t numbers_in(const CellList& cells);

/// Returns the last dozen lines of a text that are not blank, from the last line upwards; the first `skip` lines of the text
/// are left out. A last line without a line end may be incomplete and is put at the end of the list. In a long text, only its
/// end is read, and the line numbers do not count from its beginning.
[[nodiscard]] std::vector<Line> last_lines(std::string_view text, std::size_t skip);

/// Returns the separator with which most of the lines split into cells of numbers only. If no separator does so, returns the
/// one with which most lines have several cells, one of them a number; by default a comma.
[[nodiscard]] char separator_of(const std::vector<Line>& lines);

/// Returns for each column of the lines `last` true if it has more numbers than words. If there are lines without words, only
/// those lines count. The columns end with the last column of numbers; none if there are no numbers.
[[nodiscard]] std::vector<bool> numeric_columns(const std::vector<Line>& last, char separator);

}  // namespace softland::internal
