// Tables for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace softland::internal {

/// What a UTF-8 text takes on a terminal.
[[nodiscard]] std::size_t display_width(std::string_view text);
/// Filled up with blanks to so many columns.
[[nodiscard]] std::string left_aligned(const std::string& text, std::size_t columns);
[[nodiscard]] std::string right_aligned(const std::string& text, std::size_t columns);

struct TextColumn {
  std::string head;
  std::size_t width = 0;  ///< at the least; a longer cell shifts the rest of its row
  bool is_words = false;  ///< to the left, else to the right
  std::size_t gap = 0;    ///< blanks before it
  bool grows = false;     ///< as wide as its widest cell, if that is more
};

using TextRow = std::vector<std::string>;

/// The heads and a line for each row, without blanks at its end. Rows may be shorter than the heads.
[[nodiscard]] std::string text_table(std::vector<TextColumn> columns, const std::vector<TextRow>& rows);

/// Columns of numbers of the same width.
[[nodiscard]] std::vector<TextColumn> number_columns(const std::vector<std::string>& heads, std::size_t width);

}  // namespace softland::internal
