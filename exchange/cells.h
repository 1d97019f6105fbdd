// Splits a line of a file into cells, and reads the numbers in cells.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace softland::internal {

/// The decimal sign of a file, point or comma. If the user does not give it, the first cell with a decimal sign decides.
struct DecimalSign {
  char sign = '\0';  ///< decimal sign of the file: '.', ',' or '\0' for not known yet
  bool is_given = false;
};

/// Splits a line into cells, without surrounding blanks and quotation marks. A blank as separator stands for any number of
/// blanks and tabs. A separator between quotation marks belongs to the cell.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells);

enum class CellKind {
  number,
  blank,       ///< the cell is empty, or a dash
  not_finite,  ///< the cell is inf, nan or overrange
  other_sign,  ///< the cell is a number with a decimal sign other than that of the file
  no_number,
};
struct Cell {
  CellKind kind = CellKind::blank;
  double value = 0;
};
/// Reads a cell as a number or as one of the other kinds. The first point or comma in a number sets `decimal`, if not known
/// yet.
[[nodiscard]] Cell read_cell(std::string_view cell, DecimalSign& decimal);

/// Returns the text with its ASCII letters in lower case.
[[nodiscard]] std::string lower_case(std::string_view text);

/// Reads a text that is a finite number with a decimal point; none for any other text. A leading plus and the typographic minus
/// sign are accepted.
[[nodiscard]] std::optional<double> plain_decimal(std::string_view text);

/// Returns true if a cell is a number, with a decimal point or a decimal comma.
[[nodiscard]] bool looks_like_number(std::string_view cell);

/// Returns the number of significant digits of a number as written: 5 for "-9.9998e+00", 3 for "0.00120".
[[nodiscard]] int significant_digits(std::string_view cell);

}  // namespace softland::internal
