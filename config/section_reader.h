// One section of a scene, checked against the schema key by key. Internal to config/.
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
  /// Reads [section] or [section.NAME]. Throws InvalidInput for an unknown or missing key, a value of the wrong kind, dimension
  /// or range. Keys that are not given take their defaults. `file` must outlive the reader.
  explicit SectionReader(const SceneFile::Impl& file, std::string_view section, std::string_view name = {});

  /// Returns the tables of a key in force: the one of a `table`, none where a word stands instead, or those of `tables`.
  [[nodiscard]] std::vector<SectionReader> parts(std::string_view key) const;
  /// Returns the table that holds the last key of a path below this one, as {"sections[2]", "holes", "pitch"}, and its number
  /// in the list; none where there is no such table.
  [[nodiscard]] std::optional<std::pair<SectionReader, std::size_t>> holder(std::span<const std::string> path,
                                                                            std::size_t entry = 0) const;
  [[nodiscard]] const std::vector<Key>& keys() const { return section_.keys; }

  /// True when the section stands in the file.
  [[nodiscard]] bool is_present() const { return table_ != nullptr; }
  /// True when the key stands in the file.
  [[nodiscard]] bool is_given(std::string_view key) const { return table_ && table_->contains(key); }

  /// True when the key is in force: given or with a default.
  [[nodiscard]] bool has_value(std::string_view key) const { return values_.contains(key); }
  /// Returns the schema's entry of a key, or null.
  [[nodiscard]] const Key* find(std::string_view key) const { return section_.find(key, choice_); }

  /// Returns the value or the default [SI unit]; NaN without either.
  [[nodiscard]] double number(std::string_view key) const;
  [[nodiscard]] const std::vector<Quantity>& quantities(std::string_view key) const;
  [[nodiscard]] std::vector<double> numbers(std::string_view key) const;
  [[nodiscard]] int integer(std::string_view key) const;
  /// True when a word stands where a number could.
  [[nodiscard]] bool is_word(std::string_view key) const;
  /// True when the key has a list.
  [[nodiscard]] bool is_list(std::string_view key) const { return is_given(key) && table_->get(key)->is_array(); }
  /// True when the key has a list of lists.
  [[nodiscard]] bool is_nested(std::string_view key) const;
  [[nodiscard]] bool flag(std::string_view key) const;
  /// Returns the value of a text or a choice.
  [[nodiscard]] const std::string& text(std::string_view key) const;
  [[nodiscard]] const std::vector<std::string>& texts(std::string_view key) const;

  /// Returns the keys whose values are multiples of a pull-in voltage.
  [[nodiscard]] std::vector<std::string_view> keys_in_pull_in_units() const;
  /// Returns every key in force with its TOML value: as written, or the default.
  [[nodiscard]] toml::table with_defaults() const;
  /// Returns the same with quantities in SI units: a value has one text, however it was written.
  [[nodiscard]] toml::table in_si_units() const;

  /// Sets the members of the scene that the keys in force are bound to; `entry` is the number of an electrode.
  void set_members(Scene& scene, std::size_t entry) const;

  /// Throws InvalidInput about this key unless the rule holds.
  void require(bool holds, std::string_view key, std::string_view rule) const {
    if (!holds) file_.fail(path(key), rule);
  }
  /// Throws InvalidInput about the section.
  [[noreturn]] void fail(std::string_view rule) const { file_.fail_section(path_, rule); }
  /// Throws InvalidInput about this key where [structure] lacks the key that it needs and may leave out.
  void require_of_structure(std::string_view key, std::string_view needed, const Structure& structure) const;
  /// Throws InvalidInput unless the two lengths of this key increase and lie on the beam.
  void require_on_beam(std::string_view key, const Structure& beam) const;
  /// Returns the written length of the moving structure for messages, or its value.
  [[nodiscard]] std::string written_length(const Structure& structure) const;

  [[nodiscard]] const SceneFile::Impl& file() const { return file_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string path(std::string_view key) const { return join_path(path_, key); }
  /// Returns for example `gap.electrode = "3.5 um"`.
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
