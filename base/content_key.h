// A hash by which equal inputs of a computation are recognised.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

namespace softland {

/// A hash of 128 bits of the input of a computation. Equal content has equal keys on every machine.
struct ContentKey {
  std::uint64_t high = 0, low = 0;
  auto operator<=>(const ContentKey&) const = default;
  [[nodiscard]] std::string hexadecimal() const;
};
[[nodiscard]] ContentKey content_key(std::string_view text);

}  // namespace softland
