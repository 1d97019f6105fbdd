// Cells of a line, and the numbers in them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace softland::internal {

/// The decimal sign: the first cell that has one decides for all, unless it is given.
struct DecimalSign {
  char sign = '\0';  ///< '.', ',' or not known yet
  bool is_given = false;
};

/// The cells of a line, without the blanks and quotation marks around them. A blank as separator stands for any number of them,
/// tabs included. Separators between quotation marks belong to the cell.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells);

enum class CellKind {
  number,
  blank,       ///< nothing, or a dash
  not_finite,  ///< inf, nan, overrange
  other_sign,  ///< a number with the other decimal sign
  no_number,
};
struct Cell {
  CellKind kind = CellKind::blank;
  double value = 0;
};
/// The content of a cell; a first decimal sign is kept in `decimal`.
[[nodiscard]] Cell read_cell(std::string_view cell, DecimalSign& decimal);

/// ASCII letters in lower case.
[[nodiscard]] std::string lower_case(std::string_view text);

/// A finite number with a decimal point and nothing around it, or nothing. A leading plus and the minus sign of print are read.
[[nodiscard]] std::optional<double> plain_decimal(std::string_view text);

/// True if a cell is a number with either decimal sign.
[[nodiscard]] bool looks_like_number(std::string_view cell);

/// Number of digits of a number that are written down from the first one that is not 0: of "-9.9998e+00" 5, of "0.00120" 3.
[[nodiscard]] int significant_digits(std::string_view cell);

}  // namespace softland::internal
