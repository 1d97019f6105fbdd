// Sentences for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace softland {

/// Turns blanks into line breaks so that lines have at most `columns` characters where words permit it. Line breaks, tabs and
/// characters that act on a terminal are escaped: they come from names of files and folders.
[[nodiscard]] std::string wrapped(std::string_view paragraph, std::size_t columns = 100);

namespace internal {

/// Returns the number of columns of a UTF-8 text on a terminal.
[[nodiscard]] std::size_t display_width(std::string_view text);
/// Fills the text up with blanks to so many columns.
[[nodiscard]] std::string left_aligned(const std::string& text, std::size_t columns);
[[nodiscard]] std::string right_aligned(const std::string& text, std::size_t columns);

}  // namespace internal
}  // namespace softland
