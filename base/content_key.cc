#include "base/content_key.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

// MurmurHash3_x64_128 of Austin Appleby (public domain), seed 0: 128 bits, the same on every machine, and ten times as quick as
// a cryptographic hash. It does not resist an attacker who constructs two inputs with the same key.
namespace softland {
namespace {

constexpr std::uint64_t c1 = 0x87C37B91114253D5, c2 = 0x4CF5AD432745937F;

std::uint64_t little_endian(const char* bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
  return value;
}

std::uint64_t mixed_first(std::uint64_t k) { return std::rotl(k * c1, 31) * c2; }
std::uint64_t mixed_second(std::uint64_t k) { return std::rotl(k * c2, 33) * c1; }

std::uint64_t finished(std::uint64_t k) {
  k = (k ^ k >> 33) * 0xFF51AFD7ED558CCD;
  k = (k ^ k >> 33) * 0xC4CEB9FE1A85EC53;
  return k ^ k >> 33;
}

}  // namespace

ContentKey content_key(std::string_view text) {
  std::uint64_t h1 = 0, h2 = 0;
  const std::size_t length = text.size();
  for (; text.size() >= 16; text.remove_prefix(16)) {
    h1 = (std::rotl(h1 ^ mixed_first(little_endian(text.data(), 8)), 27) + h2) * 5 + 0x52DCE729;
    h2 = (std::rotl(h2 ^ mixed_second(little_endian(text.data() + 8, 8)), 31) + h1) * 5 + 0x38495AB5;
  }
  if (text.size() > 8) h2 ^= mixed_second(little_endian(text.data() + 8, text.size() - 8));
  h1 ^= mixed_first(little_endian(text.data(), std::min<std::size_t>(text.size(), 8)));
  h1 ^= length;
  h2 ^= length;
  h1 += h2;
  h2 += h1;
  h1 = finished(h1);
  h2 = finished(h2);
  h1 += h2;
  return {h1, h2 + h1};
}

std::string ContentKey::hexadecimal() const { return fmt::format("{:016x}{:016x}", high, low); }

}  // namespace softland
