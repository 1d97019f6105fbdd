// Formats sentences for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace softland {

/// Replaces blanks by line breaks so that lines have at most `columns` characters where words permit it. Line breaks, tabs and
/// control characters in the text, which may come from names of files and folders, are escaped.
[[nodiscard]] std::string wrapped(std::string_view paragraph, std::size_t columns = 100);

namespace internal {

/// Returns the number of columns of a UTF-8 text on a terminal.
[[nodiscard]] std::size_t display_width(std::string_view text);
/// Appends blanks to the text until it has `columns` columns.
[[nodiscard]] std::string left_aligned(const std::string& text, std::size_t columns);
[[nodiscard]] std::string right_aligned(const std::string& text, std::size_t columns);

}  // namespace internal
}  // namespace softland
