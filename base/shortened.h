// Shortens text of the user in messages to what a reader needs to recognise it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace softland {

/// Returns `text`, cut to at most `longest` bytes and "…" when it is longer; a UTF-8 sequence is never cut.
[[nodiscard]] inline std::string shortened(std::string_view text, std::size_t longest = 80) {
  if (text.size() <= longest) return std::string(text);
  while (longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xC0) == 0x80) --longest;
  return std::string(text.substr(0, longest)) + "…";
}

/// Returns the text, or '' for an empty text.
[[nodiscard]] inline std::string visible(const std::string& text) { return text.empty() ? "''" : text; }

/// Returns `text` with every word of more than 1000 bytes cut short, so that a message stays readable.
[[nodiscard]] inline std::string with_words_shortened(std::string_view text) {
  constexpr std::size_t longest_word = 1000;
  std::string out;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    out += word.size() > longest_word ? shortened(word) : std::string(word);
    text.remove_prefix(word.size());
    const std::size_t blanks = std::min(text.find_first_not_of(' '), text.size());
    out += text.substr(0, blanks);
    text.remove_prefix(blanks);
  }
  return out;
}

}  // namespace softland
