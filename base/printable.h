// Text of unknown origin made fit for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace softland {

/// `text` without anything that acts on a terminal or hides what is written. Control characters (C0 but line feed and tab, DEL,
/// C1), the characters that change the direction of text and the line and paragraph separators of Unicode become the six
/// characters of their escape, such as `\u001b`; inside a string of JSON that is the same string. Bytes that are not UTF-8 become
/// U+FFFD.
[[nodiscard]] std::string printable(std::string_view text);

/// The same for what is to stand on one line: line feeds and tabs are escaped too.
[[nodiscard]] std::string printable_line(std::string_view text);

}  // namespace softland
