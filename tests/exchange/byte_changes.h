// Files in which one byte is changed, added or removed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/random.h"

namespace softland::test {

/// A change of one byte at position `at`.
struct ByteChange {
  std::string content;
  std::size_t at = 0;
};
inline ByteChange changed_by_a_byte(std::string content, std::uint64_t seed) {
  constexpr std::string_view nasty("0159.,;:+-eE\"'#%@* \t\n\rxXVswui()\0\x80\xFF", 34);
  const std::size_t at = split_mix_64(seed, 0) % content.size();
  const char c = nasty[split_mix_64(seed, 1) % nasty.size()];
  switch (split_mix_64(seed, 2) % 3) {
    case 0:
      content[at] = c;
      break;
    case 1:
      content.erase(at, 1);
      break;
    default:
      content.insert(at, 1, c);
  }
  return {std::move(content), at};
}

}  // namespace softland::test
