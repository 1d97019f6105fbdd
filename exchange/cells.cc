#include "exchange/cells.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>
#include <system_error>

#include "base/trimmed.h"

namespace softland::internal {
namespace {

constexpr std::string_view printed_minus = "\xE2\x88\x92", infinity_sign = "\xE2\x88\x9E", no_break_space = "\xC2\xA0";

std::string_view bare(std::string_view cell) {
  cell = trimmed(cell);
  while (cell.starts_with(no_break_space)) cell = trimmed(cell.substr(no_break_space.size()));
  while (cell.ends_with(no_break_space)) cell = trimmed(cell.substr(0, cell.size() - no_break_space.size()));
  for (const char quote : {'"', '\''}) {
    if (cell.size() >= 2 && cell.front() == quote && cell.back() == quote) return trimmed(cell.substr(1, cell.size() - 2));
  }
  return cell;
}

void split_at_blanks(std::string_view line, std::vector<std::string_view>& cells) {
  constexpr std::string_view blank = " \t\r";
  for (std::size_t begin = line.find_first_not_of(blank); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blank, begin), line.size());
    cells.push_back(bare(line.substr(begin, end - begin)));
    begin = line.find_first_not_of(blank, end);
  }
}

bool is_not_finite(std::string_view cell) {
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  if (cell == infinity_sign) return true;
  const std::string word = lower_case(cell);
  constexpr std::array words{"inf",     "infinity", "nan",       "1.#inf",   "1.#ind",
                             "1.#qnan", "overflow", "overrange", "overload", "clipped"};
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Converts a text that begins with a digit, a point or a minus to a number; none if any part of the text is not part of the
// number.
std::optional<double> converted(const char* first, const char* last) {
  double value = 0;
  const auto [stop, error] = std::from_chars(first, last, value);
  if (error != std::errc() || stop != last) return std::nullopt;
  return value;
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string all(text);
  for (char& c : all) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return all;
}

void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  if (separator == ' ') return split_at_blanks(line, cells);
  const bool quoted = std::memchr(line.data(), '"', line.size()) != nullptr;
  for (std::size_t begin = 0;;) {
    std::size_t end = begin;
    if (quoted) {
      for (bool inside = false; end < line.size() && (inside || line[end] != separator); ++end) inside ^= line[end] == '"';
    } else {
      end = std::min(line.find(separator, begin), line.size());
    }
    cells.push_back(bare(line.substr(begin, end - begin)));
    if (end >= line.size()) return;
    begin = end + 1;
  }
}

std::optional<double> plain_decimal(std::string_view text) {
  std::array<char, 64> buffer;
  if (text.starts_with(printed_minus)) {
    const std::string_view digits = text.substr(printed_minus.size());
    if (digits.size() + 1 > buffer.size() || digits.starts_with('-')) return std::nullopt;
    buffer[0] = '-';
    std::copy(digits.begin(), digits.end(), buffer.begin() + 1);
    return plain_decimal({buffer.data(), digits.size() + 1});
  }
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-') || text.starts_with('+')) return std::nullopt;
  }
  if (text.empty() || (text.front() != '-' && text.front() != '.' && (text.front() < '0' || text.front() > '9')))
    return std::nullopt;
  const std::optional<double> value = converted(text.data(), text.data() + text.size());
  if (!value || !std::isfinite(*value)) return std::nullopt;
  return value;
}

Cell read_cell(std::string_view cell, DecimalSign& decimal) {
  if (cell.empty() || cell == "-" || cell == "--" || cell == "---") return {.kind = CellKind::blank};
  std::optional<double> value;
  const std::size_t comma = cell.find(',');
  const bool has_point = cell.find('.') != std::string_view::npos;
  if (comma != std::string_view::npos) {
    std::array<char, 64> buffer;
    if (cell.size() > buffer.size() || has_point || cell.find(',', comma + 1) != std::string_view::npos)
      return {.kind = CellKind::no_number};
    std::copy(cell.begin(), cell.end(), buffer.begin());
    buffer[comma] = '.';
    value = plain_decimal({buffer.data(), cell.size()});
  } else {
    value = plain_decimal(cell);
  }
  if (!value) return {.kind = is_not_finite(cell) ? CellKind::not_finite : CellKind::no_number};
  if (comma != std::string_view::npos || has_point) {
    const char sign = has_point ? '.' : ',';
    if (decimal.sign == '\0') decimal.sign = sign;
    if (decimal.sign != sign) return {.kind = CellKind::other_sign, .value = *value};
  }
  // Instruments with SCPI write 9.9E+37 for an overflow and 9.91E+37 for an unknown value: numbers from 9.9E+37 on are missing.
  constexpr double scpi_overflow = 9.9e37;
  if (std::abs(*value) >= scpi_overflow) return {.kind = CellKind::not_finite};
  return {.kind = CellKind::number, .value = *value};
}

bool looks_like_number(std::string_view cell) {
  DecimalSign any;
  return read_cell(cell, any).kind == CellKind::number;
}

int significant_digits(std::string_view cell) {
  int digits = 0;
  for (const char c : cell.substr(0, cell.find_first_of("eE"))) digits += (c >= '1' && c <= '9') || (c == '0' && digits > 0);
  return digits;
}

}  // namespace softland::internal
