// Choices by name: one table per enumeration, with a row per enumerator that holds its name and other properties. A table that
// misses an enumerator, or has one twice, does not compile.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace softland {

/// A row of a table that holds names only. The rows of other tables also have the members `value` and `name`.
template <class E>
struct Named {
  E value;
  std::string_view name;
};

/// A list of at most 12 names, such as scene keys, as a member of a row in a table of choices. Unlike std::vector it can be a
/// compile-time constant.
class Words {
 public:
  constexpr Words(std::initializer_list<std::string_view> words) {
    for (const std::string_view word : words) words_.at(size_++) = word;
  }
  [[nodiscard]] constexpr const std::string_view* begin() const { return words_.data(); }
  [[nodiscard]] constexpr const std::string_view* end() const { return words_.data() + size_; }
  [[nodiscard]] constexpr bool contain(std::string_view word) const { return std::find(begin(), end(), word) != end(); }
  friend constexpr Words operator+(Words words, const Words& more) {
    for (const std::string_view word : more) words.words_.at(words.size_++) = word;
    return words;
  }

 private:
  std::array<std::string_view, 12> words_{};
  std::size_t size_ = 0;
};

namespace internal {
template <auto value>
[[nodiscard]] consteval bool is_enumerator() {
  // Read from the function's signature whether `value` is an enumerator: compilers print an enumerator by its name, but any
  // other value as a number in brackets or parentheses: "[value = softland::Side::far]", "[value = (softland::Side)3]".
  constexpr std::string_view text = __PRETTY_FUNCTION__, what = "value = ";
  return text[text.find(what) + what.size()] != '(';
}
}  // namespace internal

/// Returns true when the rows stand for all enumerators, in the order of the enumeration, and have distinct names. Every table
/// of choices is checked by this function in a static_assert.
template <const auto& rows>
[[nodiscard]] consteval bool is_complete() {
  using E = decltype(rows[0].value);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].value != static_cast<E>(i) || rows[i].name.empty()) return false;
    for (std::size_t k = 0; k < i; ++k) {
      if (rows[k].name == rows[i].name) return false;
    }
  }
  return internal::is_enumerator<static_cast<E>(rows.size() - 1)>() && !internal::is_enumerator<static_cast<E>(rows.size())>();
}

template <class Row, std::size_t n>
[[nodiscard]] constexpr const Row& row_of(const std::array<Row, n>& rows, decltype(Row::value) value) {
  return rows.at(static_cast<std::size_t>(value));
}

template <class Row, std::size_t n>
[[nodiscard]] constexpr std::string_view name_of(const std::array<Row, n>& rows, decltype(Row::value) value) {
  return row_of(rows, value).name;
}

/// Returns the row of a table of choices that has this name; null if no row has this name.
template <class Row, std::size_t n>
[[nodiscard]] constexpr const Row* find_named(const std::array<Row, n>& rows, std::string_view name) {
  for (const Row& row : rows) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

template <class Row, std::size_t n>
[[nodiscard]] std::vector<std::string_view> names_of(const std::array<Row, n>& rows) {
  std::vector<std::string_view> names;
  for (const Row& row : rows) names.push_back(row.name);
  return names;
}

/// Returns the names of the rows of a table of choices as one text for a message: "bounce, count or energy".
template <class Row, std::size_t n>
[[nodiscard]] std::string listed(const std::array<Row, n>& rows) {
  std::string text;
  for (std::size_t i = 0; i < n; ++i) text += (i == 0 ? "" : i + 1 == n ? " or " : ", ") + std::string(rows[i].name);
  return text;
}

/// Returns several texts as one text for a message, joined with "and": "bounce, count and energy".
template <class Texts>
[[nodiscard]] std::string in_words(const Texts& texts, const std::string& last = " and ") {
  std::string words;
  std::size_t i = 0;
  for (const auto& text : texts) words += (i == 0 ? "" : i + 1 == texts.size() ? last : ", ") + std::string(text), ++i;
  return words;
}

/// Returns the names of the rows in a table of choices that contain `key` in their list `keys`, such as the scene keys that go
/// with a choice.
template <class Row, std::size_t n>
[[nodiscard]] std::vector<std::string_view> with_key(const std::array<Row, n>& rows, std::string_view key) {
  std::vector<std::string_view> names;
  for (const Row& row : rows) {
    if (row.keys.contain(key)) names.push_back(row.name);
  }
  return names;
}

}  // namespace softland
