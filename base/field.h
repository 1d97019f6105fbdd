// Descriptions of the numbers, flags and words in parameter structs. The keys of scene files, the checks of their values, the
// scenes that the program writes, messages and tests all follow from one description.
//
// A part of a switch, such as the contact, is a std::variant of parameter structs, one per law. Each of these structs has
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

/// Value of a number that a scene file leaves out.
inline constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

/// The description of one field of the parameter struct `Owner`: a number, a flag, or an enumerator that a word chooses. The
/// reader of scene files stores the value in the member of `Owner` that `in`, `count`, `flag` or `choose` names; without any of
/// them, separate code uses the number.
template <class Owner>
struct Field {
  std::string_view key;             ///< key of the field in scene files and in messages
  std::string_view unit = {};       ///< SI unit of the field; empty for a plain number and for a word
  std::string_view about = {};      ///< description of the field for people, one line
  double& (*in)(Owner&) = nullptr;  ///< member of the struct that stores the number, see reach(); null for other fields
  int& (*count)(Owner&) = nullptr;  ///< member of the struct that stores the whole number; null for other fields
  bool& (*flag)(Owner&) = nullptr;  ///< member of the struct that stores the flag; null for other fields
  std::string_view or_word = {};    ///< word that a scene file may give instead of a whole number, such as "auto"
  bool required = false;            ///< true when a scene file must give this field; otherwise Owner{} has the default
  /// Allowed range. For scene files an infinite end, or an open end at 0, is replaced by the largest or smallest value that a
  /// scene may have in this unit.
  Range range = positive;
  /// Default value of the field in the notation of scene files; empty when a field that is left out has no value.
  std::string_view fallback = {};
  std::string_view instead_of = {};  ///< key of another field of the law; a scene must not give both fields
  std::string_view unless = {};      ///< key of another field, with which this required field may be left out
  std::string_view not_below = {};   ///< key of another field of the law, whose value is the lower bound of this field
  std::string_view such_as = {};     ///< example value in messages, where the usual example of the unit does not fit
  std::string_view beyond = {};      ///< advice for a value outside the range; with advice, only scene files check the range
  std::string_view why_fixed = {};   ///< reason why process variation cannot vary this field; empty where it can
  std::string_view if_list = {};     ///< advice in the message when a scene file gives a list instead of a number
  std::vector<std::string_view> (*words)() = nullptr;    ///< returns the words that a scene file may give; null if none
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

/// Returns true when scene files can choose the law by its name; false for a law that declares `is_of_scenes = false`.
template <class Law>
[[nodiscard]] consteval bool is_of_scenes() {
  if constexpr (requires { Law::is_of_scenes; }) return Law::is_of_scenes;
  return true;
}
/// Calls f(std::type_identity<Law>()) for every law of a variant that scene files can choose.
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

/// Returns the law of this name with default parameters; none for an unknown name.
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
/// Returns the names of the laws of a variant as one text for a message: "strip, veijola or linear".
template <class Variant>
[[nodiscard]] std::string listed_laws() {
  const std::vector<std::string_view> names = names_of_laws<Variant>();
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + std::string(names[i]);
  return text;
}

/// Returns the field with this key if it describes a number, else null.
template <class Owner>
[[nodiscard]] constexpr const Field<Owner>* find_field(std::span<const Field<Owner>> fields, std::string_view key) {
  for (const Field<Owner>& field : fields) {
    if (field.key == key && field.in != nullptr) return &field;
  }
  return nullptr;
}

/// Returns a pointer to the number that a law stores for this key; null when the law has no field, or no number, of this key.
template <class Law>
[[nodiscard]] double* number_of(Law& law, std::string_view key) {
  const Field<Law>* const field = find_field<Law>(fields_of<Law>, key);
  return field == nullptr ? nullptr : &field->in(law);
}
template <class... Laws>
[[nodiscard]] double* number_of(std::variant<Laws...>& law, std::string_view key) {
  return std::visit([&](auto& own) { return number_of(own, key); }, law);
}
/// Returns the number that a law stores for this key; `otherwise` when the law has no field, or no number, of this key.
template <class... Laws>
[[nodiscard]] double number_of(std::variant<Laws...> law, std::string_view key, double otherwise) {
  const double* const number = number_of(law, key);
  return number == nullptr ? otherwise : *number;
}

/// Returns the law `other` after the numbers of all keys that both laws have were copied from the law `own`.
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

/// Returns true when the law that the variant holds has a field with this key.
template <class... Laws>
[[nodiscard]] bool has_key(const std::variant<Laws...>& law, std::string_view key) {
  return std::visit(
      [&]<class Law>(const Law&) {
        return std::ranges::any_of(fields_of<Law>, [&](const Field<Law>& field) { return field.key == key; });
      },
      law);
}

}  // namespace softland
