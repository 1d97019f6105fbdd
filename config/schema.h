// Every section and key a scene may have, in one table: it drives reading, checking, hints, defaults and the order of written
// scenes.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "config/units.h"

namespace softland::internal {

enum class KeyType { text, flag, integer, choice, quantity, quantities };

/// An interval in SI units; an end that is open is not part of it.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_open = false;
  bool most_open = false;

  [[nodiscard]] bool contains(double value) const;
  /// "must be in [1 pm, 1 m]", "must be in [0, 1)"
  [[nodiscard]] std::string rule(std::string_view unit) const;
};

struct Key {
  std::string_view name;
  KeyType type = KeyType::quantity;
  /// quantity, quantities: the dimensions a value may have; empty: decided by another key. The first one names the key's SI unit.
  std::vector<Dimension> dimensions = {};
  Range range = {};       ///< see range_of()
  std::size_t count = 0;  ///< quantities: how many; 0: any number
  std::vector<std::string_view> choices = {};
  std::vector<std::string_view> words = {};  ///< integer: what may stand instead of a number
  std::string_view fallback = {};            ///< the default as TOML; empty: none
  bool required = false;
  std::vector<std::string_view> only_for = {};    ///< choices of the section's selector this key belongs to; empty: all
  std::vector<std::string_view> instead_of = {};  ///< keys this one excludes; any of them satisfies `required`
  std::string_view about = {};                    ///< one line for people

  /// The range for a value of this dimension: ends that `range` leaves open are those of the dimension.
  [[nodiscard]] Range range_of(const Dimension& dimension) const;
  /// No dimension is due: a TOML number is accepted as well.
  [[nodiscard]] bool is_bare_number() const;
  [[nodiscard]] bool belongs_to(std::string_view choice) const;
};

struct Section {
  std::string_view name;        ///< empty: the keys above the first section
  std::string_view entry = {};  ///< of a named section: the one NAME these keys are for; empty: every other one
  bool is_named = false;        ///< [name.NAME], any number of them
  bool required = false;
  bool always_in_force = false;    ///< its defaults hold when the section is absent
  bool may_vary = false;           ///< [spread] may name its numbers
  std::string_view selector = {};  ///< the key whose choice decides which other keys there are
  std::vector<Key> keys = {};
  std::string_view about = {};

  /// Null when there is none. Of keys with the same name the one that belongs to `choice` of the selector wins.
  [[nodiscard]] const Key* find(std::string_view key, std::string_view choice = {}) const;
};

/// In the order of a written scene.
[[nodiscard]] const std::vector<Section>& schema();
/// [name] or [name.ENTRY]. Null when there is none.
[[nodiscard]] const Section* find_section(std::string_view name, std::string_view entry = {});

/// " (did you mean 'thickness'?)" for a near miss, else " (known: a, b, c)"; empty when nothing is known.
[[nodiscard]] std::string hint(std::string_view word, const std::vector<std::string_view>& known);

}  // namespace softland::internal
