#include "base/printable.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>

namespace softland {
namespace {

/// The code point at the beginning of `text` and its number of bytes; 0 bytes when the text does not begin with well-formed
/// UTF-8.
struct CodePoint {
  char32_t value = 0;
  std::size_t bytes = 0;
};

CodePoint first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {};
  char32_t value = lead & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {};
    value = value << 6 | (byte(i) & 0x3FU);
  }
  constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  return value < least[bytes] || surrogate || value > 0x10FFFF ? CodePoint{} : CodePoint{value, bytes};
}

bool acts_on_a_terminal(char32_t c) {
  const auto within = [c](char32_t first, char32_t last) { return c >= first && c <= last; };
  return c < 0x20 || within(0x7F, 0x9F) ||         // control characters: the Unicode sets C0 and C1, and DEL
         c == 0x061C || within(0x200E, 0x200F) ||  // characters that set the direction of text
         // Separators of lines and of paragraphs; characters that embed or override a direction of text.
         within(0x2028, 0x202E) || within(0x2066, 0x2069);  // characters that isolate text of another direction
}

std::string cleaned(std::string_view text, std::string_view kept) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const CodePoint c = first_of(text);
    if (c.bytes == 0) {
      out += "\uFFFD";
    } else if (acts_on_a_terminal(c.value) && !(c.bytes == 1 && kept.find(text.front()) != std::string_view::npos)) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", static_cast<unsigned>(c.value));
      out += escape;
    } else {
      out += text.substr(0, c.bytes);
    }
    text.remove_prefix(c.bytes == 0 ? 1 : c.bytes);
  }
  return out;
}

}  // namespace

std::string printable(std::string_view text) { return cleaned(text, "\n\t"); }
std::string printable_line(std::string_view text) { return cleaned(text, ""); }

}  // namespace softland
