// The table of all sections and keys of a scene. The table determines how scenes are read and checked, which key an error
// suggests for an unknown one, the defaults, and the order of the keys in written scenes.
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

/// Word that a scene may use instead of a position, for the far end of the beam.
inline constexpr std::string_view tip = "tip";

struct Section;

/// The type of the value of a scene's key. `table`: keys in braces; `tables`: a list of such tables.
enum class KeyType { text, texts, flag, integer, choice, quantity, quantities, table, tables };

/// Access to the member of a scene that a key sets: the function for the type of the key's value is set, the others are null. A
/// key whose value may have two types has two functions. The functions' second argument is the index of the electrode, of the
/// contact, or of the table in a list of tables; `element` is the index in a list of numbers.
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
  /// Permitted dimensions of the key's value; the first gives the SI unit. Empty for a key of [spread] whose value must have
  /// the dimension of the key that varies.
  std::vector<Dimension> dimensions = {};
  Range range = {};         ///< permitted values of the key; see range_of()
  std::size_t count = 0;    ///< type `quantities`: number of list elements; 0 for any number
  bool any_word = false;    ///< type `integer`: true if a text, such as the name of a column, may replace the number
  bool may_be_one = false;  ///< type `quantities`: true if a single quantity may replace the list
  bool is_nested = false;   ///< type `quantities`: true if the value may be a list of lists, which are read in sequence
  std::vector<std::string_view> choices = {};
  /// Words, such as "tip" for a position, that may replace an integer, a quantity, or an element of a list of quantities.
  std::vector<std::string_view> words = {};
  std::string_view fallback = {};  ///< default value of the key as TOML; empty for none
  bool required = false;
  std::vector<std::string_view> only_for = {};    ///< values of the key Section::selector with which the key exists; empty: all
  std::vector<std::string_view> instead_of = {};  ///< keys that may be given instead of this key, even if it is required
  std::string_view about = {};                    ///< description of the key, one line
  std::string_view beyond = {};                   ///< advice for a user who needs a value outside the key's range
  std::string_view why_fixed = {};                ///< reason why [spread] cannot vary this key; empty if [spread] can
  std::string_view if_list = {};                  ///< type `quantity`: advice for a user who gives a list
  std::string_view like = {};                     ///< an example value of the key as text; empty: see example_of()
  std::string_view unless = {};                   ///< another key, which makes this key optional if given
  const Section* (*part)() = nullptr;             ///< types `table` and `tables`: the keys of one table
  Bound bound = {};

  // Setters of properties of a key that the functions in config/schema/sections.h do not set.
  [[nodiscard]] Key needed() && { return required = true, std::move(*this); }
  [[nodiscard]] Key by_default(std::string_view toml) && { return fallback = toml, std::move(*this); }
  [[nodiscard]] Key of(std::vector<std::string_view> owners) && { return only_for = std::move(owners), std::move(*this); }
  [[nodiscard]] Key instead(std::string_view other) && { return instead_of.push_back(other), std::move(*this); }

  [[nodiscard]] Key fixed(std::string_view why) && { return why_fixed = why, std::move(*this); }
  [[nodiscard]] Key or_else(std::string_view advice) && { return beyond = advice, std::move(*this); }
  [[nodiscard]] Key such_as(std::string_view value) && { return like = value, std::move(*this); }

  /// Returns a valid value of this dimension for messages, such as "2 um": the example of the key, its default, or a usual
  /// value of the dimension.
  [[nodiscard]] std::string example_of(const Dimension& dimension) const;
  /// Returns the permitted range of a value of the key in this dimension. Where `range` has no bound, the smallest or largest
  /// permitted value of the dimension is the bound.
  [[nodiscard]] Range range_of(const Dimension& dimension) const;
  /// Returns true if the key has no dimension; a TOML number is then accepted as well as a text.
  [[nodiscard]] bool is_bare_number() const;
  [[nodiscard]] bool belongs_to(std::string_view choice) const;
};

/// Advice `text` for an unknown key whose name contains `word`; it names the key that the user may need.
struct Advice {
  std::string_view word, text;
};

struct Section {
  std::string_view name;         ///< name of the section of a scene; empty for the keys above the first section
  std::string_view entry = {};   ///< NAME of the [section.NAME] to which these keys apply; empty: every other NAME
  bool is_named = false;         ///< true if a scene may have any number of sections [name.NAME]
  bool may_be_named = false;     ///< true if a scene may have either one [name] or any number of [name.NAME]
  std::string_view beside = {};  ///< key that may be in [name] itself besides sections [name.NAME]; not one of `keys`
  bool required = false;
  bool always_in_force = false;    ///< true if the defaults of the keys apply even without the section
  bool may_vary = false;           ///< true when [spread] (process variation) may vary numbers of this section
  std::string_view selector = {};  ///< key whose value decides which other keys the section has
  std::vector<Key> keys = {};
  std::string_view about = {};
  std::vector<Advice> advice = {};  ///< advice for unknown keys of the section; a message shows the first that applies
  /// Creates the part of the scene that the section describes, for example an electrode; `name` is NAME of [section.NAME].
  /// Returns the index of the electrode or contact, else 0. Null for waveforms, drivers and spread: config/drives.h and
  /// config/spread_reader.h read their keys.
  std::size_t (*begin)(Scene& scene, const SectionReader& in, std::string_view name) = nullptr;
  /// Checks rules between several keys of the section, after all keys are set. Throws InvalidInput.
  void (*check)(Scene& scene, const SectionReader& in, std::size_t entry) = nullptr;

  /// Returns the description of the key of this name, or null. If several keys have the name, returns the key that exists when
  /// the value of the selector is `choice`.
  [[nodiscard]] const Key* find(std::string_view key, std::string_view choice = {}) const;
};

/// Returns the descriptions of all sections of a scene in the order of a written scene.
[[nodiscard]] const std::vector<Section>& schema();
/// Returns the description of the section [name] or [name.ENTRY], or null.
[[nodiscard]] const Section* find_section(std::string_view name, std::string_view entry = {});

/// Returns the description of the key at a path whose parts may name elements of lists, or null: {"structure", "sections[2]",
/// "width"}.
[[nodiscard]] const Key* find_key(const std::vector<std::string>& path);

/// Returns advice for an unknown word: " (did you mean 'thickness'?)" for a word close to a known one, otherwise " (known: a,
/// b, c)"; empty when `known` is empty.
[[nodiscard]] std::string hint(std::string_view word, const std::vector<std::string_view>& known);

}  // namespace softland::internal
