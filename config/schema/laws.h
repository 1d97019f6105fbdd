// Makes the keys of a section that selects a law of contact, force or gas. Each law is a struct of parameters, whose fields
// (base/field.h) describe the keys.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/field.h"
#include "config/scene.h"
#include "config/schema.h"
#include "config/section_reader.h"

namespace softland::internal {

/// Returns the member of a scene that holds field i, a number, of `Law`; `part` returns the variant of laws in the scene.
template <auto part, class Law, std::size_t i>
[[nodiscard]] double& bound_number(Scene& scene, std::size_t entry) {
  return *number_of(part(scene, entry), fields_of<Law>[i].key);
}
/// Sets field i of law `Law` in a scene, an enumeration, to the enumerator whose name is `word`.
template <auto part, class Law, std::size_t i>
void bound_word(Scene& scene, std::size_t entry, std::string_view word) {
  std::visit(
      [&]<class Own>(Own& law) {
        for (const Field<Own>& field : fields_of<Own>) {
          if (field.key == fields_of<Law>[i].key && field.choose != nullptr) field.choose(law, word);
        }
      },
      part(scene, entry));
}

/// Returns the scene key that a field of a law describes; the caller sets Key::bound, the access to the member of the scene.
template <class Owner>
[[nodiscard]] Key described(const Field<Owner>& field) {
  Key key{.name = field.key,
          .range = field.range,
          .fallback = field.fallback,
          .required = field.required,
          .about = field.about,
          .beyond = field.beyond,
          .why_fixed = field.why_fixed,
          .if_list = field.if_list,
          .like = field.such_as,
          .unless = field.unless};
  if (!field.instead_of.empty()) key.instead_of.push_back(field.instead_of);
  if (field.words != nullptr) {
    key.type = KeyType::choice;
    key.range = {};
    key.choices = field.words();
    if (!field.refused_word.empty()) key.choices.push_back(field.refused_word);
  } else if (field.flag != nullptr) {
    key.type = KeyType::flag;
    key.range = {};
  } else if (field.count != nullptr) {
    key.type = KeyType::integer;
    if (!field.or_word.empty()) key.words.push_back(field.or_word);
  } else {
    key.dimensions = {field.unit.empty() ? dimension::none : parse_quantity("1 " + std::string(field.unit)).dimension};
  }
  return key;
}

template <auto part, class Law, std::size_t i>
[[nodiscard]] Key key_of_field() {
  Key key = described(fields_of<Law>[i]);
  if (key.type == KeyType::choice) {
    key.bound.choose = bound_word<part, Law, i>;
  } else {
    key.bound.number = bound_number<part, Law, i>;
  }
  return key;
}

/// Returns the key `model`, then the keys of all laws, each with the laws to which the key belongs. The keys of every law keep
/// their order.
template <class Variant, auto part>
[[nodiscard]] std::vector<Key> keys_of_laws(std::string_view about) {
  Key model{.name = "model", .type = KeyType::choice, .required = true, .about = about};
  std::vector<Key> keys;
  for_each_law<Variant>([&]<class Law>(std::type_identity<Law>) {
    model.choices.push_back(Law::name);
    std::size_t place = 0;
    const auto add = [&](Key key) {
      auto found = std::ranges::find(keys, key.name, &Key::name);
      if (found == keys.end()) found = keys.insert(keys.begin() + static_cast<std::ptrdiff_t>(place), std::move(key));
      found->only_for.push_back(Law::name);
      place = static_cast<std::size_t>(found - keys.begin()) + 1;
    };
    [&]<std::size_t... i>(std::index_sequence<i...>) { (add(key_of_field<part, Law, i>()), ...); }
    (std::make_index_sequence<fields_of<Law>.size()>());
  });
  keys.insert(keys.begin(), std::move(model));
  return keys;
}

/// Returns the law that the key `model` of a section names, with default parameters. Throws InvalidInput if a key of the
/// section has the word that its law refuses (Field::refused_word).
template <class Variant>
[[nodiscard]] Variant law_of(const SectionReader& in) {
  const Variant law = *law_named<Variant>(in.text("model"));
  std::visit(
      [&]<class Law>(const Law&) {
        for (const Field<Law>& field : fields_of<Law>) {
          if (field.refused_word.empty()) continue;
          in.require(!in.has_value(field.key) || in.text(field.key) != field.refused_word, field.key, field.why_refused);
        }
      },
      law);
  return law;
}

/// Throws InvalidInput if a parameter of the law is below the parameter that Field::not_below names as its lower bound.
template <class... Laws>
void check_bounds(std::variant<Laws...> law, const SectionReader& in) {
  std::visit(
      [&]<class Law>(Law& own) {
        for (const Field<Law>& field : fields_of<Law>) {
          if (field.not_below.empty() || !in.has_value(field.key)) continue;
          in.require(field.in(own) >= *number_of(own, field.not_below), field.key,
                     "must not be below " + in.written(field.not_below));
        }
      },
      law);
}

}  // namespace softland::internal
