// One section of a scene, checked key by key against the description of all sections (schema). Internal to config/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "config/scene_file_impl.h"
#include "config/schema.h"
#include "config/units.h"

namespace softland {
struct Structure;
}

namespace softland::internal {

class SectionReader {
 public:
  /// Reads [section] or [section.NAME] of a scene. Throws InvalidInput for an unknown or missing key, a value of the wrong
  /// kind, dimension or range. Keys that are not given take their defaults. `file` must outlive the reader.
  explicit SectionReader(const SceneFile::Impl& file, std::string_view section, std::string_view name = {});

  /// Returns readers of the tables in the value of a key: one for the type `table` (none if a word replaces it), all for
  /// `tables`.
  [[nodiscard]] std::vector<SectionReader> parts(std::string_view key) const;
  /// Returns the table that holds the last key of a path below this section, such as {"sections[2]", "holes", "pitch"}, and the
  /// number of the table in its list; none if there is no such table.
  [[nodiscard]] std::optional<std::pair<SectionReader, std::size_t>> holder(std::span<const std::string> path,
                                                                            std::size_t entry = 0) const;
  [[nodiscard]] const std::vector<Key>& keys() const { return section_.keys; }

  /// Returns true if the scene file contains the section.
  [[nodiscard]] bool is_present() const { return table_ != nullptr; }
  /// Returns true if the scene file gives the key in this section.
  [[nodiscard]] bool is_given(std::string_view key) const { return table_ && table_->contains(key); }

  /// Returns true if the key has a value, given or by default.
  [[nodiscard]] bool has_value(std::string_view key) const { return values_.contains(key); }
  /// Returns the description of a key of the section, or null.
  [[nodiscard]] const Key* find(std::string_view key) const { return section_.find(key, choice_); }

  /// Returns the number that a key holds, or else its default [SI unit]; NaN if the key has neither.
  [[nodiscard]] double number(std::string_view key) const;
  [[nodiscard]] const std::vector<Quantity>& quantities(std::string_view key) const;
  [[nodiscard]] std::vector<double> numbers(std::string_view key) const;
  [[nodiscard]] int integer(std::string_view key) const;
  /// Returns true if the value of the key is a word instead of a number.
  [[nodiscard]] bool is_word(std::string_view key) const;
  /// Returns true if the value of the key is a list.
  [[nodiscard]] bool is_list(std::string_view key) const { return is_given(key) && table_->get(key)->is_array(); }
  /// Returns true if the value of the key is a list of lists.
  [[nodiscard]] bool is_nested(std::string_view key) const;
  [[nodiscard]] bool flag(std::string_view key) const;
  /// Returns the value of a key that holds a text or a choice.
  [[nodiscard]] const std::string& text(std::string_view key) const;
  [[nodiscard]] const std::vector<std::string>& texts(std::string_view key) const;

  /// Returns the names of the keys whose values are multiples of a pull-in voltage (Vsp or Vdp).
  [[nodiscard]] std::vector<std::string_view> keys_in_pull_in_units() const;
  /// Returns every key that has a value, with its TOML value as written or by default.
  [[nodiscard]] toml::table with_defaults() const;
  /// Returns every key that has a value, with quantities in SI units: "2 um" and "2000 nm" become the same text.
  [[nodiscard]] toml::table in_si_units() const;

  /// Sets the members of the scene that the keys of the section describe; `entry` is the number of the electrode or contact.
  void set_members(Scene& scene, std::size_t entry) const;

  /// Throws InvalidInput about `key` with the text `rule` unless `holds`.
  void require(bool holds, std::string_view key, std::string_view rule) const {
    if (!holds) file_.fail(path(key), rule);
  }
  /// Throws InvalidInput about the section with the text `rule`.
  [[noreturn]] void fail(std::string_view rule) const { file_.fail_section(path_, rule); }
  /// Throws InvalidInput about `key` if the optional key `needed` of [structure], such as width, is missing. The caller has
  /// found that the law of this section needs that number.
  void require_of_structure(std::string_view key, std::string_view needed, const Structure& structure) const;
  /// Throws InvalidInput unless the two positions of `key` increase and are on the beam.
  void require_on_beam(std::string_view key, const Structure& beam) const;
  /// Returns the length of the moving structure for messages, as written in the file or as a value.
  [[nodiscard]] std::string written_length(const Structure& structure) const;

  [[nodiscard]] const SceneFile::Impl& file() const { return file_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string path(std::string_view key) const { return join_path(path_, key); }
  /// Returns a key and its value as written, for example `gap.electrode = "3.5 um"`.
  [[nodiscard]] std::string written(std::string_view key) const { return file_.written(path(key)); }

 private:
  struct Tables {};
  using Value = std::variant<std::vector<Quantity>, std::string, std::vector<std::string>, bool, std::int64_t, Tables>;

  SectionReader(const SceneFile::Impl& file, const Section& part, std::string path, const toml::table& table);
  void read();

  static Value parse(const Key& key, const toml::node& node);
  void check_keys() const;
  void read_selector();
  void read_key(const Key& key);
  [[nodiscard]] bool is_replaced(const Key& key) const;

  const SceneFile::Impl& file_;
  const Section& section_;
  std::string path_;
  const toml::table* table_ = nullptr;
  std::string choice_;
  std::map<std::string_view, Value> values_;
};

}  // namespace softland::internal
