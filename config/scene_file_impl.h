// The content of a SceneFile. Internal to config/: our only header that includes TOML.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/scene.h"
#include "config/schema.h"
#include "config/units.h"

namespace softland::internal {

/// Returns a path of keys as text, parts quoted where TOML needs it: spread."structure.thickness".
[[nodiscard]] std::string join_path(const std::string& path, std::string_view key);
/// Returns the parts of such a text. Throws InvalidInput with the rule only.
[[nodiscard]] std::vector<std::string> split_path(std::string_view path);
/// Returns "electrode.main.span[2]" as its path and 2; a name that ends otherwise as it is, without a number. The parts of a
/// path may be elements of lists of tables: structure.sections[2].width.
[[nodiscard]] std::pair<std::string, std::optional<std::size_t>> without_element(std::string_view name);
/// Returns the node of this key, or of an element of the list there: "sections[2]". Returns null where it does not exist.
[[nodiscard]] const toml::node* child_of(const toml::table& table, const std::string& key);
/// True when TOML accepts this key without quotes.
[[nodiscard]] bool is_bare_key(std::string_view key);
/// Returns a basic TOML string with its quotes.
[[nodiscard]] std::string toml_string(std::string_view text);
/// Reads the text as TOML; `name` stands for it in messages. Throws InvalidInput.
[[nodiscard]] toml::table parse_toml(std::string_view text, const std::string& name);
/// Returns a value as TOML on one line.
[[nodiscard]] std::string inline_text(const toml::node& node);
/// Returns a whole scene as TOML, in the order of the schema.
[[nodiscard]] std::string write_scene(const toml::table& root);
/// Returns a table that holds the value of a TOML text under `value_key`. Throws InvalidInput.
[[nodiscard]] toml::table parse_value(std::string_view toml_text);
inline constexpr std::string_view value_key = "v";

/// Calls insert(node) with the TOML value that gives `key` this quantity, which reads back to the same bits.
template <class Insert>
void insert_quantity(const Key& key, const Quantity& quantity, Insert&& insert) {
  if (key.is_bare_number()) return insert(quantity.value);
  insert(quantity.dimension == dimension::none ? percent_text(quantity.value)
                                               : quantity_text(quantity.value, quantity.dimension));
}

}  // namespace softland::internal

namespace softland {

struct SceneFile::Impl {
  /// The place where a key was written.
  struct Origin {
    std::string text;  ///< "scenes/x.toml:12" or "--set gap.contact=3"
    bool is_option = false;
    std::string replaced = {};  ///< path of a value that this one replaced; empty if none
  };

  std::string name;
  std::filesystem::path directory;
  toml::table root;
  // The origins are kept apart from the nodes, because toml++ forgets source positions when a table is copied.
  std::map<std::string, Origin, std::less<>> origins;
  /// Contact with a law that no scene file can express: see SceneFile::add_contact().
  std::optional<Contact> own_contact = {};

  /// Returns the node of a key; null where it does not exist.
  [[nodiscard]] const toml::node* find(const std::vector<std::string>& path) const;
  /// Returns `structure.length = "250 um"`, for messages.
  [[nodiscard]] std::string written(std::string_view path) const;
  /// Throws InvalidInput with place, key path, value as written, and rule.
  [[noreturn]] void fail(std::string_view path, std::string_view rule) const;
  /// Throws InvalidInput about a section: the value is not shown, and an option that set something in the section is cited
  /// first.
  [[noreturn]] void fail_section(std::string_view path, std::string_view rule) const;

  /// Returns "; --set structure.length=1 m took the place of structure.sections" for messages, if a value in this section
  /// replaced one.
  [[nodiscard]] std::string replaced_in(std::string_view section) const;

  /// Returns the list there with another value in the place of an element, counted from 1. Throws InvalidInput that begins with
  /// `option` where there is no such list.
  [[nodiscard]] toml::array with_element(const std::vector<std::string>& path, std::size_t element, const toml::node& value,
                                         const std::string& option) const;
  /// Returns NAME of every [section.NAME], sorted. Throws InvalidInput when something else stands there.
  [[nodiscard]] std::vector<std::string> names_in(const std::string& section) const;
  /// True when the keys of a section stand in [section.NAME] in this file.
  [[nodiscard]] bool is_named(const internal::Section& section) const;

  /// Puts a value at this path, which comes from `place`, and creates the sections on the way. A value that can be given in one
  /// of two ways replaces the other way. Throws InvalidInput where a section cannot be created.
  void insert(const std::vector<std::string>& path, const toml::node& value, const Origin& place);
  /// Forgets where the keys at and below `path` were written.
  void forget(std::string_view path);
  [[nodiscard]] Origin origin(std::string_view path) const;
};

}  // namespace softland
