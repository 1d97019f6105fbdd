// One list of members serves to write and to read a record as JSON, and to describe it in the manual. `members(archive, record)`,
// a function beside the type of the record, names every member once, with its meaning (as in Drake's Serialize). The archive
// writes, reads or lists these members. Only a list uses the meaning.
//
// A non-finite number is null in JSON. An archive that reads takes the members that are present. A number that is missing or null
// becomes NaN. Any other member that is missing or of another type keeps its value in the record.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "document/json_number.h"
#include "objectives/figure_values.h"

namespace softland {

/// A member of a record of JSON, for the reference of the manual.
struct JsonMember {
  /// Key of the member. The key of a list ends in "[]", and that of members with any names in ".NAME".
  std::string key;
  std::string type;                      ///< "number", "list of texts", "record"
  std::string about;                     ///< meaning of the member; may be empty
  std::string record;                    ///< name of the C++ type of a record, which tells equal records; empty for other members
  std::vector<JsonMember> members = {};  ///< members of a record, or of each record of a list
};

namespace internal {

using nlohmann::json;

/// A count in a double, which becomes a whole number in JSON.
struct Count {
  double& value;
};
/// A number, or a map of numbers; null in JSON means infinite.
template <class T>
struct OrInfinite {
  T& value;
};
template <class T>
OrInfinite(T&) -> OrInfinite<T>;
/// A member that is null in JSON if it is not set or an empty text; without OrNull, JSON lacks a member that is not set.
template <class T>
struct OrNull {
  T& value;
};
template <class T>
OrNull(T&) -> OrNull<T>;
/// The status of a study: "interrupted" in JSON if the flag is set, otherwise "done".
struct Stopped {
  bool& interrupted;
};
/// An enumerator, which is in JSON its name in the table `rows`.
template <class Rows>
struct Chosen {
  decltype(Rows::value_type::value)& value;
  const Rows& rows;
};
template <class T, class Rows>
Chosen(T&, const Rows&) -> Chosen<Rows>;

/// Figures of merit that are members of one object, and their meaning.
struct FigureGroup {
  bool (*has)(const Figure&);
  std::string_view about;
};
/// The meaning of a member whose JSON a separate function writes as that of a T.
template <class T>
struct Like {
  std::string_view about;
};
/// The same for one T, or for several by name.
template <class T>
struct OneOrMore {
  std::string_view about;
};
/// The meaning of a member whose JSON a separate function writes, and the type of this JSON.
struct Written {
  std::string_view type, about;
};

/// Adds members to a list. A key that is there already gets only the members of its record that it lacks.
void add_members(std::vector<JsonMember>& all, std::vector<JsonMember> more);
/// Checks that JSON was read completely: throws InvalidInput with the first difference between the JSON `read` and the JSON
/// `written` from the record that was read.
void require_same(const json& written, const json& read);
/// Returns the value of a key; null if the key is missing or `object` is none.
[[nodiscard]] const json& value_at(const json& object, std::string_view key);

/// One value of JSON that is written from a value of C++, read into it, or listed for the manual. What members() of a record
/// needs is public; transfer() has an overload for each type of value.
class Archive {
 public:
  [[nodiscard]] static Archive writer() { return Archive(Task::write, nullptr); }
  /// The reader keeps a reference to `from`, which must outlive the reader.
  [[nodiscard]] static Archive reader(const json& from) { return Archive(Task::read, &from); }
  [[nodiscard]] static Archive lister() { return Archive(Task::list, nullptr); }
  [[nodiscard]] bool reads() const { return task_ == Task::read; }
  [[nodiscard]] bool lists() const { return task_ == Task::list; }
  /// Returns whether a member that exists only where `where` holds is transferred: only an archive that writes leaves it out.
  [[nodiscard]] bool has(bool where) const { return where || task_ != Task::write; }

  template <class T>
  void operator()(std::string_view key, T&& value, std::string_view about) {
    member(key, erased(value), about);
  }
  /// Transfers two numbers as a list of JSON.
  void pair(std::string_view key, double& low, double& high, std::string_view about);
  /// Transfers a value by functions of its own; `shape` is a Like, a OneOrMore or a Written.
  template <class T, class Write, class Read, class Shape>
  void custom(std::string_view key, T& value, const Write& write, const Read& read, const Shape& shape) {
    if (task_ == Task::write)
      json_[std::string(key)] = write(value);
    else if (task_ == Task::read)
      value = read(value_at(*read_, key));
    else
      list(key, shape);
  }
  /// Writes a value that is computed from other members of the record; a reader skips it.
  template <class T>
  void derived(std::string_view key, const T& value, std::string_view about) {
    if (task_ != Task::read) member(key, erased(value), about);
  }
  /// Transfers an object with the members that `inside(archive)` names.
  template <class Inside>
  void object(std::string_view key, const Inside& inside, std::string_view about) {
    if (task_ == Task::read && !value_at(*read_, key).is_object()) return;
    Archive own = opened(key);
    inside(own);
    close(key, std::move(own), about);
  }
  /// Transfers the figures of merit of a group.
  void figures(FigureValues& values, const FigureGroup& group);

  /// Returns the JSON that is read.
  [[nodiscard]] const json& from() const { return *read_; }
  /// Returns the JSON that was written.
  [[nodiscard]] json take() && { return std::move(json_); }
  /// Returns the members of the record that was listed.
  [[nodiscard]] std::vector<JsonMember> take_members() && { return std::move(listed_.members); }

  template <class T, std::size_t n>
  static void transfer(Archive& at, std::array<T, n>& all) {
    at.begin_list();
    for (std::size_t k = 0; k < n; ++k) at.item(k, erased(all[k]));
    if (at.lists()) at.list_array(n);
  }
  template <class T>
  static void transfer(Archive& at, std::vector<T>& all) {
    at.begin_list();
    if (at.lists()) {
      T one = blank<T>();
      return at.list_items(erased(all.empty() ? one : all.front()));
    }
    for (std::size_t k = 0; !at.reads() && k < all.size(); ++k) at.item(k, erased(all[k]));
    for (std::size_t k = 0, n = at.size(); k < n; ++k) at.item(k, erased(all.emplace_back(blank<T>())));
  }
  template <class T>
  static void transfer(Archive& at, std::map<std::string, T>& all) {
    at.begin_object();
    for (const std::string& key : at.keys()) all.emplace(key, blank<T>());
    for (auto& [key, value] : all) at.item(key, erased(value));
    if (!at.lists()) return;
    T one = blank<T>();
    at.list_named(erased(one));
  }
  template <class T>
  static void transfer(Archive& at, std::optional<T>& value) {
    if (at.task_ == Task::read) {
      const bool is_object = std::is_class_v<T> && !std::is_same_v<T, std::string>;
      if (at.read_->is_null() || (is_object && !at.read_->is_object())) return;
      value = blank<T>();
    }
    at.is_absent_ = at.task_ == Task::write && !value;
    if (at.is_absent_) return;
    T unset = blank<T>();
    transfer(at, value ? *value : unset);
  }
  template <class T>
  static void transfer(Archive& at, OrNull<std::optional<T>>& inner) {
    transfer(at, inner.value);
    at.is_absent_ = false;
  }
  template <class Rows>
  static void transfer(Archive& at, Chosen<Rows>& choice) {
    std::string name;
    if (at.task_ == Task::write) name = name_of(choice.rows, choice.value);
    transfer(at, name);
    if (const auto* const row = find_named(choice.rows, name); at.reads() && row) choice.value = row->value;
    for (std::size_t k = 0; at.lists() && k < choice.rows.size(); ++k) at.list_name(choice.rows[k].name);
  }
  template <class Record>
  requires std::is_class_v<Record>
  static void transfer(Archive& at, Record& record) {
    at.begin_object();
    if (at.lists()) at.listed_.type = "record", at.listed_.record = typeid(Record).name();
    members(at, record);
  }
  static void transfer(Archive& at, double& value);
  static void transfer(Archive& at, bool& value);
  static void transfer(Archive& at, int& value);
  static void transfer(Archive& at, std::int64_t& value);
  static void transfer(Archive& at, std::uint64_t& value);
  static void transfer(Archive& at, std::string& text);
  static void transfer(Archive& at, json& as_it_is);
  static void transfer(Archive& at, Stopped& study);
  static void transfer(Archive& at, Status& status);
  static void transfer(Archive& at, Count& count);
  static void transfer(Archive& at, OrInfinite<double>& number);
  static void transfer(Archive& at, OrInfinite<std::map<std::string, double>>& numbers);
  static void transfer(Archive& at, OrNull<std::string>& text);
  /// A list of numbers keeps its length: an entry that is not a number becomes NaN.
  static void transfer(Archive& at, std::vector<double>& all);
  /// Empty texts, and entries that are no texts, are left out.
  static void transfer(Archive& at, std::vector<std::string>& all);
  /// A point in JSON is a list of two entries; other entries in a list of points are skipped.
  static void transfer(Archive& at, std::vector<std::array<double, 2>>& all);
  static void transfer(Archive& at, std::map<std::string, std::array<double, 2>>& all);

  /// Returns a value of a type before it is read: NaN for a number.
  template <class T>
  [[nodiscard]] static T blank() {
    if constexpr (std::is_floating_point_v<T>) return Metrics::unset;
    return T{};
  }

 private:
  enum class Task { write, read, list };
  /// A value whose type the function knows.
  struct Erased {
    void* value;
    void (*transfer)(Archive&, void*);
  };

  Archive(Task task, const json* read) : task_(task), read_(read) {}
  // An archive that writes or lists does not change the value, so its const may be removed.
  template <class T>
  static Erased erased(const T& value) {
    return {const_cast<T*>(&value), [](Archive& at, void* one) { transfer(at, *static_cast<T*>(one)); }};
  }
  void member(std::string_view key, Erased value, std::string_view about);
  [[nodiscard]] Archive opened(std::string_view key) const;
  void close(std::string_view key, Archive own, std::string_view about);
  void begin_list();
  void begin_object();
  // The number of items, or the keys, of the JSON that is read; none unless this archive reads a list, or an object.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] std::vector<std::string> keys() const;
  void item(std::size_t k, Erased value);
  void item(const std::string& key, Erased value);
  void list(std::string_view key, const Written& written);
  template <class Shape>
  void list(std::string_view key, const Like<Shape>& like) {
    Shape shape{};
    member(key, erased(shape), like.about);
  }
  template <class Shape>
  void list(std::string_view key, const OneOrMore<Shape>& like) {
    Shape one{};
    std::map<std::string, Shape> several;
    member(key, erased(one), like.about);
    member(key, erased(several), std::string(like.about) + ", by name where there are several");
  }
  void list_member(std::string_view key, JsonMember one, std::string_view about);
  void list_array(std::size_t size);
  void list_items(Erased one);
  void list_named(Erased one);
  void list_name(std::string_view name);

  Task task_;
  const json* read_;        ///< the JSON that is read
  json json_;               ///< the JSON that is written
  bool is_absent_ = false;  ///< whether the JSON lacks the member
  JsonMember listed_{};     ///< the member that is listed; its key and meaning follow those that its record gives
};

/// Returns a record, or another value, as JSON.
template <class T>
[[nodiscard]] json record_json(const T& record) {
  Archive at = Archive::writer();
  Archive::transfer(at, const_cast<T&>(record));  // writing does not change the record, so the const may be removed
  return std::move(at).take();
}

/// Reads a record, or another value, from the JSON members that are present.
template <class T>
[[nodiscard]] T read_json(const json& from) {
  T value = Archive::blank<T>();
  Archive at = Archive::reader(from);
  Archive::transfer(at, value);
  return value;
}

/// Returns the results of a verb (a record) from their JSON. Throws InvalidInput if any part is missing, unknown, or not as
/// json_of() would write it.
template <class Record>
[[nodiscard]] Record whole_record(const json& from) {
  Record record = read_json<Record>(from);
  require_same(record_json(record), from);
  return record;
}

/// Returns the members of a record. Members that depend on values of the record are those of `record`.
template <class Record>
[[nodiscard]] std::vector<JsonMember> listed(const Record& record = {}) {
  Archive at = Archive::lister();
  Archive::transfer(at, const_cast<Record&>(record));  // a list does not change the record, so the const may be removed
  return std::move(at).take_members();
}

}  // namespace internal

}  // namespace softland
