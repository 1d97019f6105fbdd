#include "document/text.h"

#include <algorithm>

#include "base/printable.h"

namespace softland {

std::string wrapped(std::string_view paragraph, std::size_t columns) {
  const std::string clean = printable_line(paragraph);
  std::string_view text = clean;
  std::string out;
  std::size_t used = 0;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (used > 0) {
      const bool fits = used + 1 + internal::display_width(word) <= columns;
      out += fits ? ' ' : '\n';
      used = fits ? used + 1 : 0;
    }
    out += word;
    used += internal::display_width(word);
  }
  return out;
}

std::size_t internal::display_width(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string internal::left_aligned(const std::string& text, std::size_t columns) {
  return text + std::string(columns - std::min(columns, display_width(text)), ' ');
}

std::string internal::right_aligned(const std::string& text, std::size_t columns) {
  return std::string(columns - std::min(columns, display_width(text)), ' ') + text;
}

}  // namespace softland
