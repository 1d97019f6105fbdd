// Text of unknown origin made fit for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace softland {

/// Returns `text` without anything that acts on a terminal or hides content. Escapes of six characters, such as `\u001b`,
/// replace control characters (C0 except line feed and tab, DEL, C1), characters that change the direction of text, and the
/// line and paragraph separators of Unicode. Inside a string of JSON that is the same string. Bytes that are not UTF-8 become
/// U+FFFD.
[[nodiscard]] std::string printable(std::string_view text);

/// Returns the same for text on one line: line feeds and tabs are escaped too.
[[nodiscard]] std::string printable_line(std::string_view text);

}  // namespace softland
