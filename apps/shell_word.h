// Words of a command line as a shell takes them.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>

namespace softland::apps {

/// Quoted where a shell would not leave it as it is; a control character as bash, ksh and zsh read it, $'\012', which stays on
/// one line.
[[nodiscard]] inline std::string shell_word(std::string_view word) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) return std::string(word);
  const auto is_control = [](char c) { return (static_cast<unsigned char>(c) < 0x20) || c == 0x7F; };
  if (std::any_of(word.begin(), word.end(), is_control)) {
    std::string escaped = "$'";
    for (const char c : word) {
      char octal[5];
      std::snprintf(octal, sizeof octal, "\\%03o", static_cast<unsigned>(static_cast<unsigned char>(c)));
      escaped += is_control(c) ? std::string(octal) : (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
    }
    return escaped + "'";
  }
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace softland::apps
