// Words of a command line, quoted for a shell.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "base/printable.h"

namespace softland {

/// Returns the word quoted where a shell would change it. Control characters, characters that change the direction of text, and
/// invalid UTF-8 are written as bash, ksh and zsh read them, $'\012', on one line.
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
