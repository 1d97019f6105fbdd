// Every section and key a scene may have, in one table: it drives reading, checking, hints, defaults and the order of written
// scenes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/range.h"
#include "config/units.h"

namespace softland {

struct Place;
struct Scene;
}  // namespace softland

namespace softland::internal {

class SectionReader;

/// What may stand for the end of the beam where a place is due.
inline constexpr std::string_view tip = "tip";

struct Section;

/// `table`: keys in braces; `tables`: a list of such.
enum class KeyType { text, texts, flag, integer, choice, quantity, quantities, table, tables };

/// The member of a scene that a key sets, by its kind: of these at most one is there, but that a table may be a word instead. The
/// second argument tells which electrode, or which table of a list, is meant, `element` which element of a list.
struct Bound {
  double& (*number)(Scene&, std::size_t) = nullptr;
  Place& (*place)(Scene&, std::size_t, std::size_t element) = nullptr;
  double& (*element)(Scene&, std::size_t, std::size_t element) = nullptr;
  bool& (*flag)(Scene&, std::size_t) = nullptr;
  int& (*integer)(Scene&, std::size_t) = nullptr;
  std::string& (*text)(Scene&, std::size_t) = nullptr;
  void (*choose)(Scene&, std::size_t, std::string_view) = nullptr;
};

struct Key {
  std::string_view name;
  KeyType type = KeyType::quantity;
  /// quantity, quantities: the dimensions a value may have; empty: decided by another key. The first one names the key's SI unit.
  std::vector<Dimension> dimensions = {};
  Range range = {};         ///< see range_of()
  std::size_t count = 0;    ///< quantities: how many; 0: any number
  bool any_word = false;    ///< integer: any text may stand instead of a number
  bool may_be_one = false;  ///< quantities: a single one may stand instead of a list
  bool is_nested = false;   ///< quantities: may be a list of such lists, read one after the other
  std::vector<std::string_view> choices = {};
  std::vector<std::string_view> words = {};  ///< integer, quantity, an element of quantities: what may stand instead of a number
  std::string_view fallback = {};            ///< the default as TOML; empty: none
  bool required = false;
  std::vector<std::string_view> only_for = {};    ///< choices of the section's selector this key belongs to; empty: all
  std::vector<std::string_view> instead_of = {};  ///< keys this one excludes; any of them satisfies `required`
  std::string_view about = {};                    ///< one line for people
  std::string_view beyond = {};                   ///< what to do where a value must lie outside the range
  std::string_view why_fixed = {};                ///< why devices cannot differ by it; empty: they can
  std::string_view if_list = {};                  ///< quantity: what to do where a list is wanted
  std::string_view like = {};                     ///< a value that a switch may have; empty: see example_of()
  std::string_view unless = {};                   ///< the key in whose presence it is not required
  const Section* (*part)() = nullptr;             ///< table, tables: the keys of one
  Bound bound = {};

  // What the makers of keys (config/schema/sections.h) leave open.
  [[nodiscard]] Key needed() && { return required = true, std::move(*this); }
  [[nodiscard]] Key by_default(std::string_view toml) && { return fallback = toml, std::move(*this); }
  [[nodiscard]] Key of(std::vector<std::string_view> owners) && { return only_for = std::move(owners), std::move(*this); }
  [[nodiscard]] Key instead(std::string_view other) && { return instead_of.push_back(other), std::move(*this); }

  [[nodiscard]] Key fixed(std::string_view why) && { return why_fixed = why, std::move(*this); }
  [[nodiscard]] Key or_else(std::string_view advice) && { return beyond = advice, std::move(*this); }
  [[nodiscard]] Key such_as(std::string_view value) && { return like = value, std::move(*this); }

  /// For messages: a value of this dimension that the key may have, such as "2 um": its own, or its default, or what is usual of
  /// the dimension.
  [[nodiscard]] std::string example_of(const Dimension& dimension) const;
  /// The range for a value of this dimension: ends that `range` leaves open are those of the dimension.
  [[nodiscard]] Range range_of(const Dimension& dimension) const;
  /// No dimension is due: a TOML number is accepted as well.
  [[nodiscard]] bool is_bare_number() const;
  [[nodiscard]] bool belongs_to(std::string_view choice) const;
};

/// An answer to an unknown key that has this word in it: the key that describes such a thing.
struct Advice {
  std::string_view word, text;
};

struct Section {
  std::string_view name;         ///< empty: the keys above the first section
  std::string_view entry = {};   ///< of a named section: the one NAME these keys are for; empty: every other one
  bool is_named = false;         ///< [name.NAME], any number of them
  bool may_be_named = false;     ///< [name], or [name.NAME] of several
  std::string_view beside = {};  ///< a key that stands among the NAMEs and is read by code of its own
  bool required = false;
  bool always_in_force = false;    ///< its defaults hold when the section is absent
  bool may_vary = false;           ///< [spread] may name its numbers
  std::string_view selector = {};  ///< the key whose choice decides which other keys there are
  std::vector<Key> keys = {};
  std::string_view about = {};
  std::vector<Advice> advice = {};  ///< answers to unknown keys; the first that fits counts
  /// Makes the part of the scene that the keys set, [section.NAME] being its name, and tells the number of an electrode. Null
  /// where the keys set no member: waveforms, drivers and spread are read by code of their own.
  std::size_t (*begin)(Scene& scene, const SectionReader& in, std::string_view name) = nullptr;
  /// Looks at what one key alone cannot decide, when the keys are set. Throws InvalidInput.
  void (*check)(Scene& scene, const SectionReader& in, std::size_t entry) = nullptr;

  /// Null when there is none. Of keys with the same name the one that belongs to `choice` of the selector wins.
  [[nodiscard]] const Key* find(std::string_view key, std::string_view choice = {}) const;
};

/// In the order of a written scene.
[[nodiscard]] const std::vector<Section>& schema();
/// [name] or [name.ENTRY]. Null when there is none.
[[nodiscard]] const Section* find_section(std::string_view name, std::string_view entry = {});

/// The key at a path whose parts may name elements of lists: {"structure", "sections[2]", "width"}. Null when there is none.
[[nodiscard]] const Key* find_key(const std::vector<std::string>& path);

/// " (did you mean 'thickness'?)" for a near miss, else " (known: a, b, c)"; empty when nothing is known.
[[nodiscard]] std::string hint(std::string_view word, const std::vector<std::string_view>& known);

}  // namespace softland::internal
