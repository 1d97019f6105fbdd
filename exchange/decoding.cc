#include "exchange/decoding.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace softland::internal {
namespace {

void append_utf8(std::string& out, std::uint32_t point) {
  const auto put = [&](std::uint32_t byte) { out.push_back(static_cast<char>(byte)); };
  if (point < 0x80) {
    put(point);
  } else if (point < 0x800) {
    put(0xC0 | point >> 6);
    put(0x80 | (point & 0x3F));
  } else if (point < 0x10000) {
    put(0xE0 | point >> 12);
    put(0x80 | (point >> 6 & 0x3F));
    put(0x80 | (point & 0x3F));
  } else {
    put(0xF0 | point >> 18);
    put(0x80 | (point >> 12 & 0x3F));
    put(0x80 | (point >> 6 & 0x3F));
    put(0x80 | (point & 0x3F));
  }
}

std::string from_utf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t i) {
    const auto a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(big_endian ? a << 8 | b : b << 8 | a);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t point = unit(i);
    const bool is_high = point >= 0xD800 && point < 0xDC00;
    if (is_high && i + 3 < bytes.size() && unit(i + 2) >= 0xDC00 && unit(i + 2) < 0xE000) {
      point = 0x10000 + ((point - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
      i += 2;
    } else if (point >= 0xD800 && point < 0xE000) {
      point = 0xFFFD;
    }
    append_utf8(text, point);
  }
  return text;
}

// ASCII text in UTF-16 has a zero in every other byte. Returns 0 if the first byte of each pair is zero, 1 if the second one is,
// and -1 otherwise.
int zero_bytes(std::string_view bytes) {
  constexpr std::size_t enough = 64;
  const std::size_t count = std::min(enough, bytes.size() / 2);
  if (count < 2) return -1;
  std::size_t first = 0, second = 0;
  for (std::size_t i = 0; i < count; ++i) {
    first += bytes[2 * i] == '\0';
    second += bytes[2 * i + 1] == '\0';
  }
  const std::size_t most = count - count / 8;  // UTF-16 is recognised if seven of eight characters are ASCII
  if (second >= most && first == 0) return 1;
  if (first >= most && second == 0) return 0;
  return -1;
}

}  // namespace

std::string_view decoded(std::string_view content, std::string& storage, std::vector<std::string>& left_out) {
  if (content.starts_with("\xEF\xBB\xBF")) return content.substr(3);
  const bool little_mark = content.starts_with("\xFF\xFE"), big_mark = content.starts_with("\xFE\xFF");
  const int zeros = little_mark || big_mark ? -1 : zero_bytes(content);
  if (!little_mark && !big_mark && zeros < 0) return content;
  if (little_mark || big_mark) content.remove_prefix(2);
  if (content.size() % 2 != 0) left_out.emplace_back("the last byte, which is half a character of UTF-16");
  storage = from_utf16(content, big_mark || zeros == 0);
  return storage;
}

bool is_binary(std::string_view text) {
  constexpr std::size_t enough = 1 << 20;
  return std::memchr(text.data(), '\0', std::min(text.size(), enough)) != nullptr;
}

bool Lines::next() {
  if (rest_.empty()) return false;
  ++number_;
  const char* const begin = rest_.data();
  const auto* end = static_cast<const char*>(std::memchr(begin, '\n', rest_.size()));
  const std::size_t to_feed = end == nullptr ? rest_.size() : static_cast<std::size_t>(end - begin);
  // A carriage return ends a line even without a subsequent line feed.
  const auto* carriage = static_cast<const char*>(std::memchr(begin, '\r', to_feed));
  const std::size_t length = carriage == nullptr ? to_feed : static_cast<std::size_t>(carriage - begin);
  line_ = rest_.substr(0, length);
  is_unended_ = length == rest_.size();
  std::size_t taken = length + 1;
  if (carriage != nullptr && length + 1 < rest_.size() && rest_[length + 1] == '\n') ++taken;
  rest_.remove_prefix(std::min(taken, rest_.size()));
  return true;
}

}  // namespace softland::internal
