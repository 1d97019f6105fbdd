// Text of the user in messages: as much of it as a reader needs to recognise it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace softland {

/// `text`, cut to at most `longest` bytes and "…" when it is longer; never inside a UTF-8 sequence.
[[nodiscard]] inline std::string shortened(std::string_view text, std::size_t longest = 80) {
  if (text.size() <= longest) return std::string(text);
  while (longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xC0) == 0x80) --longest;
  return std::string(text.substr(0, longest)) + "…";
}

}  // namespace softland
