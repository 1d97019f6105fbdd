// Words of a command line as a shell takes them.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "base/printable.h"

namespace softland {

/// Quoted where a shell would not leave it as it is. Bytes that printing would change, control characters, such as change the
/// direction of text, and what is no UTF-8, as bash, ksh and zsh read them, $'\012', which stays on one line.
[[nodiscard]] inline std::string shell_word(std::string_view word) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) return std::string(word);
  if (printable_line(word) != word) {
    const auto is_plain = [](char c) { return c >= 0x20 && c < 0x7F; };
    std::string escaped = "$'";
    for (const char c : word) {
      char octal[5];
      std::snprintf(octal, sizeof octal, "\\%03o", static_cast<unsigned>(static_cast<unsigned char>(c)));
      escaped += is_plain(c) ? (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c) : std::string(octal);
    }
    return escaped + "'";
  }
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace softland
