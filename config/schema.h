// Every section and key of a scene, in one table: it drives reading, checking, hints, defaults and the order of written scenes.
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

/// The word for the end of the beam, in the place of a position.
inline constexpr std::string_view tip = "tip";

struct Section;

/// The type of a key's value. `table`: keys in braces; `tables`: a list of such.
enum class KeyType { text, texts, flag, integer, choice, quantity, quantities, table, tables };

/// The member of a scene that a key sets, by its kind. At most one is set, except that a word may stand for a table. The second
/// argument selects the electrode, or the table of a list, `element` the element of a list.
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
  /// Dimensions of a quantity or quantities; empty if another key decides. The first one names the key's SI
  /// unit.
  std::vector<Dimension> dimensions = {};
  Range range = {};         ///< see range_of()
  std::size_t count = 0;    ///< quantities: their number; 0 for any number
  bool any_word = false;    ///< integer: true when any text may stand instead of a number
  bool may_be_one = false;  ///< quantities: true when a single one may stand instead of a list
  bool is_nested = false;   ///< quantities: true when it may be a list of such lists, read one after the other
  std::vector<std::string_view> choices = {};
  /// Words that may stand instead of an integer, a quantity, or an element of quantities.
  std::vector<std::string_view> words = {};
  std::string_view fallback = {};  ///< default as TOML; empty for none
  bool required = false;
  std::vector<std::string_view> only_for = {};    ///< choices of the section's selector this key belongs to; empty for all
  std::vector<std::string_view> instead_of = {};  ///< keys this one excludes; any of them satisfies `required`
  std::string_view about = {};                    ///< one line of description for people
  std::string_view beyond = {};                   ///< advice where a value must lie outside the range
  std::string_view why_fixed = {};                ///< reason why varied devices cannot vary it; empty where they can
  std::string_view if_list = {};                  ///< quantity: advice where a list is wanted
  std::string_view like = {};                     ///< a value that a switch may have; empty: see example_of()
  std::string_view unless = {};                   ///< key in whose presence it is not required
  const Section* (*part)() = nullptr;             ///< table, tables: the keys of one table
  Bound bound = {};

  // Properties that the makers of keys (config/schema/sections.h) leave open.
  [[nodiscard]] Key needed() && { return required = true, std::move(*this); }
  [[nodiscard]] Key by_default(std::string_view toml) && { return fallback = toml, std::move(*this); }
  [[nodiscard]] Key of(std::vector<std::string_view> owners) && { return only_for = std::move(owners), std::move(*this); }
  [[nodiscard]] Key instead(std::string_view other) && { return instead_of.push_back(other), std::move(*this); }

  [[nodiscard]] Key fixed(std::string_view why) && { return why_fixed = why, std::move(*this); }
  [[nodiscard]] Key or_else(std::string_view advice) && { return beyond = advice, std::move(*this); }
  [[nodiscard]] Key such_as(std::string_view value) && { return like = value, std::move(*this); }

  /// Returns a valid value of this dimension for messages, such as "2 um": the key's own example, its default, or a usual value
  /// of the dimension.
  [[nodiscard]] std::string example_of(const Dimension& dimension) const;
  /// Returns the range for a value of this dimension: ends that `range` leaves open are those of the dimension.
  [[nodiscard]] Range range_of(const Dimension& dimension) const;
  /// True when the key has no dimension: a TOML number is accepted as well.
  [[nodiscard]] bool is_bare_number() const;
  [[nodiscard]] bool belongs_to(std::string_view choice) const;
};

/// An answer to an unknown key that contains this word: the key that describes such a thing.
struct Advice {
  std::string_view word, text;
};

struct Section {
  std::string_view name;         ///< name of the section; empty for the keys above the first section
  std::string_view entry = {};   ///< NAME of a named section that these keys are for; empty: every other one
  bool is_named = false;         ///< true for [name.NAME], any number of them
  bool may_be_named = false;     ///< true for [name], or [name.NAME] of several
  std::string_view beside = {};  ///< a key that stands among the NAMEs and is read by separate code
  bool required = false;
  bool always_in_force = false;    ///< true when its defaults hold while the section is absent
  bool may_vary = false;           ///< true when [spread] may name its numbers
  std::string_view selector = {};  ///< key whose choice decides which other keys exist
  std::vector<Key> keys = {};
  std::string_view about = {};
  std::vector<Advice> advice = {};  ///< answers to unknown keys; the first that fits counts
  /// Creates the part of the scene that the keys set, [section.NAME] being its name, and returns the number of an electrode.
  /// Null where the keys set no member: separate code reads waveforms, drivers and spread.
  std::size_t (*begin)(Scene& scene, const SectionReader& in, std::string_view name) = nullptr;
  /// Checks what one key alone cannot decide, after the keys are set. Throws InvalidInput.
  void (*check)(Scene& scene, const SectionReader& in, std::size_t entry) = nullptr;

  /// Returns the key, or null. The key that belongs to `choice` of the selector wins over others of its name.
  [[nodiscard]] const Key* find(std::string_view key, std::string_view choice = {}) const;
};

/// Returns all sections in the order of a written scene.
[[nodiscard]] const std::vector<Section>& schema();
/// Returns [name] or [name.ENTRY], or null.
[[nodiscard]] const Section* find_section(std::string_view name, std::string_view entry = {});

/// Returns the key at a path whose parts may name elements of lists, or null: {"structure", "sections[2]", "width"}.
[[nodiscard]] const Key* find_key(const std::vector<std::string>& path);

/// Returns " (did you mean 'thickness'?)" for a near miss, else " (known: a, b, c)"; empty when nothing is known.
[[nodiscard]] std::string hint(std::string_view word, const std::vector<std::string_view>& known);

}  // namespace softland::internal
