// A field of a parameter struct, described once for keys of scenes, their checks, written scenes, messages and tests.
//
// A part of a switch, such as the contact, is a variant of the parameter structs of its laws. A law is a parameter struct with
//
//   static constexpr std::string_view name;      its name in a scene
//   static consteval auto fields();              an array of Field, in the order of a written scene
//   static constexpr Law example();              values that a switch may have, for tests
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/range.h"

namespace softland {

/// The value of a number that a scene does not give.
inline constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

/// A field of the parameter struct `Owner`: a number, a flag, or an enumerator that a word chooses. A field with neither `in`,
/// `count`, `flag` nor `words` is a number that sets no member: separate code reads it.
template <class Owner>
struct Field {
  std::string_view key;             ///< key of the field in a scene and in messages
  std::string_view unit = {};       ///< SI unit of the field; empty for a plain number and for a word
  std::string_view about = {};      ///< description of the field for people, one line
  double& (*in)(Owner&) = nullptr;  ///< number of the struct that the field sets, see reach(); null for other fields
  int& (*count)(Owner&) = nullptr;  ///< whole number of the struct that the field sets; null for other fields
  bool& (*flag)(Owner&) = nullptr;  ///< flag of the struct that the field sets; null for other fields
  std::string_view or_word = {};    ///< word that a scene may give instead of a whole number
  bool required = false;            ///< true when a scene must give this field; an absent field has the value of an Owner{}
  Range range = positive;           ///< allowed range of the number; in a scene, the widest range of the unit bounds open ends
  /// Value of the field in a default Owner{} as a scene writes it; empty where an absent field means "none".
  std::string_view fallback = {};
  std::string_view instead_of = {};  ///< key of another field of the law that excludes this field
  std::string_view unless = {};      ///< key of another field whose presence makes this field optional
  std::string_view not_below = {};   ///< key of another field of the law, whose value is the lower bound of this field
  std::string_view such_as = {};    ///< example value of the field for messages, where the usual example of the unit does not fit
  std::string_view beyond = {};     ///< advice for a value outside the range; the range then applies to scenes only
  std::string_view why_fixed = {};  ///< reason why process variation cannot vary this field; empty where it can
  std::string_view if_list = {};    ///< advice in the message when a scene gives a list instead of the number
  std::vector<std::string_view> (*words)() = nullptr;    ///< words that the field accepts
  void (*choose)(Owner&, std::string_view) = nullptr;    ///< sets the member of the struct to the enumerator that a word names
  std::string_view refused_word = {}, why_refused = {};  ///< word that users may expect for this field, and why it is refused
};

/// Returns the member of a struct at the end of a path of members: reach<Law, &Law::summits, &Summits::radius>.
template <class Owner, auto... path>
[[nodiscard]] constexpr auto& reach(Owner& owner) {
  return (owner.*....*path);
}

/// Returns one array with the fields of several arrays of fields, one after the other.
template <class Law, std::size_t... n>
[[nodiscard]] consteval auto joined(const std::array<Field<Law>, n>&... arrays) {
  std::array<Field<Law>, (n + ...)> all{};
  auto to = all.begin();
  ((to = std::copy(arrays.begin(), arrays.end(), to)), ...);
  return all;
}

/// The array of the fields of a law, computed at compile time.
template <class Law>
inline constexpr auto fields_of = Law::fields();

/// Returns true when a scene can name the law; a law that declares `is_of_scenes = false` cannot be named.
template <class Law>
[[nodiscard]] consteval bool is_of_scenes() {
  if constexpr (requires { Law::is_of_scenes; }) return Law::is_of_scenes;
  return true;
}
/// Calls f(std::type_identity<Law>()) for every law of a variant that a scene can name.
template <class Variant, class F>
constexpr void for_each_law(F&& f) {
  const auto call = [&]<class Law>(std::type_identity<Law> law) {
    if constexpr (is_of_scenes<Law>()) f(law);
  };
  [&]<std::size_t... i>(std::index_sequence<i...>) { (call(std::type_identity<std::variant_alternative_t<i, Variant>>()), ...); }
  (std::make_index_sequence<std::variant_size_v<Variant>>());
}

/// Returns the name of the law that the variant holds.
template <class... Laws>
[[nodiscard]] constexpr std::string_view name_of(const std::variant<Laws...>& law) {
  constexpr std::array names{Laws::name...};
  return names[law.index()];
}

/// Returns the law of this name with its defaults; none for an unknown name.
template <class Variant>
[[nodiscard]] std::optional<Variant> law_named(std::string_view name) {
  std::optional<Variant> found;
  for_each_law<Variant>([&]<class Law>(std::type_identity<Law>) {
    if (Law::name == name) found = Law{};
  });
  return found;
}

template <class Variant>
[[nodiscard]] std::vector<std::string_view> names_of_laws() {
  std::vector<std::string_view> names;
  for_each_law<Variant>([&]<class Law>(std::type_identity<Law>) { names.push_back(Law::name); });
  return names;
}
/// Returns the names of the laws of a variant as words: "strip, veijola or linear".
template <class Variant>
[[nodiscard]] std::string listed_laws() {
  const std::vector<std::string_view> names = names_of_laws<Variant>();
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + std::string(names[i]);
  return text;
}

/// Returns the field with this key if it is a number, else null.
template <class Owner>
[[nodiscard]] constexpr const Field<Owner>* find_field(std::span<const Field<Owner>> fields, std::string_view key) {
  for (const Field<Owner>& field : fields) {
    if (field.key == key && field.in != nullptr) return &field;
  }
  return nullptr;
}

/// Returns a pointer to the number that a law has under this key; null when the law has no such number.
template <class Law>
[[nodiscard]] double* number_of(Law& law, std::string_view key) {
  const Field<Law>* const field = find_field<Law>(fields_of<Law>, key);
  return field == nullptr ? nullptr : &field->in(law);
}
template <class... Laws>
[[nodiscard]] double* number_of(std::variant<Laws...>& law, std::string_view key) {
  return std::visit([&](auto& own) { return number_of(own, key); }, law);
}
/// Returns the number that a law has under this key; `otherwise` when the law has no such number.
template <class... Laws>
[[nodiscard]] double number_of(std::variant<Laws...> law, std::string_view key, double otherwise) {
  const double* const number = number_of(law, key);
  return number == nullptr ? otherwise : *number;
}

/// Returns the law `other` with the numbers of the law `own`, for all keys that both laws have.
template <class... Laws>
[[nodiscard]] std::variant<Laws...> under(std::variant<Laws...> own, std::variant<Laws...> other) {
  std::visit(
      [&]<class Law>(Law& law) {
        for (const Field<Law>& field : fields_of<Law>) {
          if (field.in == nullptr) continue;
          if (const double* known = number_of(own, field.key)) field.in(law) = *known;
        }
      },
      other);
  return other;
}

/// Returns true when the law that the variant holds has this key.
template <class... Laws>
[[nodiscard]] bool has_key(const std::variant<Laws...>& law, std::string_view key) {
  return std::visit(
      [&]<class Law>(const Law&) {
        return std::ranges::any_of(fields_of<Law>, [&](const Field<Law>& field) { return field.key == key; });
      },
      law);
}

}  // namespace softland
