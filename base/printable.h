// Text of unknown origin, made safe for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace softland {

/// Returns `text` without characters that control a terminal or hide content. Escapes of six characters, such as `\u001b`,
/// replace control characters (C0 except line feed and tab, DEL, C1), characters that change the direction of text, and the
/// line and paragraph separators of Unicode. A string of JSON does not change its meaning, since JSON has the same escapes.
/// Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string printable(std::string_view text);

/// Returns printable(text) with line feeds and tabs escaped too, for text on one line.
[[nodiscard]] std::string printable_line(std::string_view text);

}  // namespace softland
