// The content of a scene file as a table of toml++. Internal to config/; no other header includes toml++.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/scene.h"
#include "config/schema.h"
#include "config/units.h"

namespace softland::internal {

/// Largest number of parts of a key's path; "gap.contact" has two.
inline constexpr std::size_t deepest_path = 16;

/// Returns `path` extended by `key`, which is quoted if TOML requires it: spread."structure.thickness".
[[nodiscard]] std::string join_path(const std::string& path, std::string_view key);
/// Splits the text of a path of keys into its parts. Throws InvalidInput whose message states only the broken rule.
[[nodiscard]] std::vector<std::string> split_path(std::string_view path);
/// Splits "electrode.main.span[2]" into its path and 2. A name without a final number in brackets is returned as it is. Parts
/// of the path may be elements of lists of tables: structure.sections[2].width.
[[nodiscard]] std::pair<std::string, std::optional<std::size_t>> without_element(std::string_view name);
/// Returns the TOML node of a key or, for a text such as "sections[2]", of an element of its list; null if the node does not
/// exist.
[[nodiscard]] const toml::node* child_of(const toml::table& table, const std::string& key);
/// Returns true when TOML accepts this key without quotes.
[[nodiscard]] bool is_bare_key(std::string_view key);
/// Returns a basic TOML string with its quotes.
[[nodiscard]] std::string toml_string(std::string_view text);
/// Reads a text as TOML; `name` is the name of the text in messages. Throws InvalidInput.
[[nodiscard]] toml::table parse_toml(std::string_view text, const std::string& name);
/// Returns a TOML value as text on one line.
[[nodiscard]] std::string inline_text(const toml::node& node);
/// Returns a whole scene as TOML, in the order of the schema.
[[nodiscard]] std::string write_scene(const toml::table& root);
/// Returns a TOML table, list or value as JSON.
[[nodiscard]] nlohmann::json to_json(const toml::node& node);
/// Parses the text of one TOML value; returns a table with this value under the key value_key. Throws InvalidInput for any
/// other text.
[[nodiscard]] toml::table parse_value(std::string_view toml_text);
inline constexpr std::string_view value_key = "v";

/// Calls insert(node) with the TOML value of a quantity for `key`; the value reads back to the same bits.
template <class Insert>
void insert_quantity(const Key& key, const Quantity& quantity, Insert&& insert) {
  if (key.is_bare_number()) return insert(quantity.value);
  insert(quantity.dimension == dimension::none ? percent_text(quantity.value)
                                               : quantity_text(quantity.value, quantity.dimension));
}

}  // namespace softland::internal

namespace softland {

struct SceneFile::Impl {
  /// The source of a key's value: a line of a file, or a command-line option.
  struct Origin {
    std::string text;  ///< source of the key's value: "scenes/x.toml:12" or "--set gap.contact=3"
    bool is_option = false;
    std::string replaced = {};  ///< path of the alternative key (accuracy, tolerance) that was removed; empty if none
  };

  std::string name;
  std::filesystem::path directory;
  toml::table root;
  // The origins of the keys are separate from the TOML nodes, because a copy of a toml++ table loses its source positions.
  std::map<std::string, Origin, std::less<>> origins;
  /// Contact with a law that no scene file can express: see SceneFile::add_contact().
  std::optional<Contact> own_contact = {};

  /// Returns the TOML node of a key; null if the scene does not contain the key.
  [[nodiscard]] const toml::node* find(const std::vector<std::string>& path) const;
  /// Returns a key and its value as written, such as `structure.length = "250 um"`, for messages.
  [[nodiscard]] std::string written(std::string_view path) const;
  /// Throws InvalidInput about a key, with file and line (or option), key path, value as written, and rule.
  [[noreturn]] void fail(std::string_view path, std::string_view rule) const;
  /// Throws InvalidInput about a section of the scene, without a value. If an option set a key of the section, the message
  /// begins with the option.
  [[noreturn]] void fail_section(std::string_view path, std::string_view rule) const;

  /// Returns the text "; --set structure.length=1 m replaced structure.sections" for messages, if a command-line option
  /// replaced a value in the section; otherwise an empty text.
  [[nodiscard]] std::string replaced_in(std::string_view section) const;

  /// Returns the list at a path with a new value for one element, counted from 1. Throws InvalidInput, with a message that
  /// begins with `option`, if the path holds no such list.
  [[nodiscard]] toml::array with_element(const std::vector<std::string>& path, std::size_t element, const toml::node& value,
                                         const std::string& option) const;
  /// Returns NAME of every [section.NAME], sorted. Throws InvalidInput if the section holds anything else.
  [[nodiscard]] std::vector<std::string> names_in(const std::string& section) const;
  /// Returns true if the scene file has subsections [section.NAME] of this section, instead of a single [section].
  [[nodiscard]] bool is_named(const internal::Section& section) const;

  /// Sets the value at a path of keys, with `place` as the source of the value, and creates missing sections. If a quantity can
  /// be given by one of two keys, the other key is removed. Throws InvalidInput if a section cannot be created.
  void insert(const std::vector<std::string>& path, const toml::node& value, const Origin& place);
  /// Removes the recorded sources (file and line) of the keys at and below `path`.
  void forget(std::string_view path);
  [[nodiscard]] Origin origin(std::string_view path) const;
};

}  // namespace softland
