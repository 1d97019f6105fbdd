// One list of members serves to write and to read a record as JSON, and to describe it in the manual. `members(archive, record)`,
// a function template beside the type of the record, names every member once, with its meaning. JsonWriter, JsonReader and
// MemberLister (reports/member_lister.h) are archives, as in Drake's Serialize. Only the lister uses the meaning.
//
// A non-finite number is null in JSON. JsonReader reads the members that are present. A number that is missing or null becomes
// NaN. Any other member that is missing or of another type keeps its value in the record.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "document/json_number.h"
#include "objectives/figure_values.h"

namespace softland::internal {

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

template <class Record>
[[nodiscard]] json record_json(const Record& record);
/// Checks that JSON was read completely: throws InvalidInput with the first difference between the JSON `read` and the JSON
/// `written` from the record that was read.
void require_same(const json& written, const json& read);

class JsonWriter {
 public:
  static constexpr bool reads = false, lists = false;
  /// Returns whether the writer writes members of a record that exist only if `where` holds.
  [[nodiscard]] static bool has(bool where) { return where; }

  template <class T>
  void operator()(std::string_view key, const T& value, std::string_view) {
    json_[std::string(key)] = of(value);
  }
  template <class T>
  void operator()(std::string_view key, const std::optional<T>& value, std::string_view about) {
    if (value) (*this)(key, *value, about);
  }
  /// Writes two numbers as a list of JSON.
  void pair(std::string_view key, double low, double high, std::string_view) {
    json_[std::string(key)] = {json_number(low), json_number(high)};
  }
  /// Writes a value that a separate function converts to JSON; `shape` is a Like, a OneOrMore or a Written.
  template <class T, class Write, class Read, class Shape>
  void custom(std::string_view key, const T& value, const Write& write, const Read&, const Shape&) {
    json_[std::string(key)] = write(value);
  }
  /// Writes a value that is computed from other members of the record; a reader skips it.
  template <class T>
  void derived(std::string_view key, const T& value, std::string_view about) {
    (*this)(key, value, about);
  }
  /// Writes an object with the members that `inside(archive)` names.
  template <class Inside>
  void object(std::string_view key, const Inside& inside, std::string_view) {
    JsonWriter own;
    inside(own);
    json_[std::string(key)].update(own.json_);
  }
  /// Writes the figures of merit of a group.
  void figures(const FigureValues& values, const FigureGroup& group) {
    for (const Figure& figure : all_figures) {
      if (group.has(figure) && figure.is_asked(values.asked)) json_[std::string(figure.key)] = of(figure, values[figure]);
    }
  }
  [[nodiscard]] json take() && { return std::move(json_); }

 private:
  static json of(double value) { return json_number(value); }
  static json of(bool value) { return value; }
  static json of(const std::string& text) { return text; }
  static json of(const json& as_it_is) { return as_it_is; }
  static json of(Stopped study) { return study.interrupted ? "interrupted" : "done"; }
  static json of(Status status) { return to_string(status); }
  template <class Rows>
  static json of(const Chosen<Rows>& choice) {
    return name_of(choice.rows, choice.value);
  }
  template <std::integral Whole>
  static json of(Whole value) {
    return value;
  }
  static json of(const Count& count) { return std::isfinite(count.value) ? json(std::llround(count.value)) : json(); }
  template <class T>
  static json of(const OrInfinite<T>& inner) {
    return of(inner.value);
  }
  static json of(const OrNull<std::string>& text) { return text.value.empty() ? json() : json(text.value); }
  template <class T>
  static json of(const OrNull<std::optional<T>>& inner) {
    return inner.value ? of(*inner.value) : json();
  }
  static json of(const Figure& figure, double value) {
    if (!std::isfinite(value)) return nullptr;
    if (figure.is_yes_or_no()) return value != 0;
    return figure.is_count() ? json(std::llround(value)) : json(value);
  }
  template <class T, std::size_t n>
  static json of(const std::array<T, n>& all) {
    return list(all);
  }
  template <class T>
  static json of(const std::vector<T>& all) {
    return list(all);
  }
  template <class T>
  static json of(const std::map<std::string, T>& all) {
    json object = json::object();
    for (const auto& [key, value] : all) object[key] = of(value);
    return object;
  }
  template <class Record>
  requires std::is_class_v<Record>
  static json of(const Record& record) { return record_json(record); }
  template <class List>
  static json list(const List& all) {
    json values = json::array();
    for (const auto& one : all) values.push_back(of(one));
    return values;
  }

  json json_ = json::object();
};

class JsonReader {
 public:
  static constexpr bool reads = true, lists = false;
  [[nodiscard]] static bool has(bool) { return true; }

  /// The reader keeps a reference to `json`, which must outlive the reader.
  explicit JsonReader(const json& json) : json_(&json) {}

  template <class T>
  void operator()(std::string_view key, T&& value, std::string_view) {
    take(at(key), value);
  }
  void pair(std::string_view key, double& low, double& high, std::string_view) {
    const json& list = at(key);
    if (!list.is_array() || list.size() != 2) return;
    take(list[0], low);
    take(list[1], high);
  }
  template <class T, class Write, class Read, class Shape>
  void custom(std::string_view key, T& value, const Write&, const Read& read, const Shape&) {
    value = read(at(key));
  }
  template <class T>
  void derived(std::string_view, const T&, std::string_view) const {}
  template <class Inside>
  void object(std::string_view key, const Inside& inside, std::string_view) {
    if (!at(key).is_object()) return;
    JsonReader own(at(key));
    inside(own);
  }
  void figures(FigureValues& values, const FigureGroup&) {
    for (const Figure& figure : all_figures) {
      if (figure.asked != nullptr && json_->contains(figure.key)) values.asked.*figure.asked = true;
      take(figure, at(figure.key), values[figure]);
    }
  }
  /// Reads a value of a type with members(), from the JSON members that are present.
  template <class T>
  [[nodiscard]] static T read(const json& from) {
    T value = blank<T>();
    take(from, value);
    return value;
  }
  /// Returns the JSON that this reader reads.
  [[nodiscard]] const json& whole() const { return *json_; }
  /// Returns the JSON value of a key; null if the key is missing.
  [[nodiscard]] const json& at(std::string_view key) const {
    static const json nothing;
    if (!json_->is_object()) return nothing;
    const auto found = json_->find(key);
    return found == json_->end() ? nothing : *found;
  }

 private:
  static void take(const json& from, double& value) {
    if (from.is_number()) value = from.get<double>();
    if (from.is_null()) value = Metrics::unset;
  }
  static void take(const json& from, json& as_it_is) { as_it_is = from; }
  static void take(const json& from, Stopped study) { study.interrupted = from == "interrupted"; }
  static void take(const json& from, Status& status) {
    for (int k = 0; k <= static_cast<int>(Status::interrupted); ++k) {
      if (from == to_string(static_cast<Status>(k))) status = static_cast<Status>(k);
    }
  }
  template <class Rows>
  static void take(const json& from, Chosen<Rows> choice) {
    if (!from.is_string()) return;
    if (const auto* const row = find_named(choice.rows, from.get<std::string>())) choice.value = row->value;
  }
  static void take(const json& from, bool& value) {
    if (from.is_boolean()) value = from.get<bool>();
  }
  static void take(const json& from, std::string& text) {
    if (from.is_string()) text = from.get<std::string>();
  }
  static void take(const json& from, std::uint64_t& value) {
    if (from.is_number_integer() && from >= 0) value = from.get<std::uint64_t>();
  }
  template <std::signed_integral Whole>
  static void take(const json& from, Whole& value) {
    const double number = from.is_number() ? from.get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (std::abs(number) <= static_cast<double>(std::numeric_limits<int>::max())) value = static_cast<Whole>(number);
  }
  static void take(const json& from, Count count) { take(from, count.value); }
  static void take(const json& from, OrInfinite<double> number) {
    number.value = std::numeric_limits<double>::infinity();
    if (!from.is_null()) number.value = from.is_number() ? from.get<double>() : Metrics::unset;
  }
  static void take(const json& from, OrInfinite<std::map<std::string, double>> numbers) {
    if (!from.is_object()) return;
    for (const auto& [key, value] : from.items()) take(value, OrInfinite<double>{numbers.value[key]});
  }
  template <class T>
  static void take(const json& from, OrNull<T> inner) {
    take(from, inner.value);
  }
  static void take(const Figure& figure, const json& from, double& value) {
    value = figure.is_yes_or_no() && from.is_boolean() ? from.get<bool>() : Metrics::unset;
    take(from, value);
  }
  template <class T>
  static void take(const json& from, std::optional<T>& value) {
    if (from.is_null() || (std::is_class_v<T> && !from.is_object() && !std::is_same_v<T, std::string>)) return;
    value = read<T>(from);
  }
  // Reads a list of numbers and keeps its length: an entry that is not a number becomes NaN.
  template <class T>
  static void take(const json& from, std::vector<T>& all) {
    if (!from.is_array()) return;
    all.reserve(from.size());
    for (const json& one : from) all.push_back(read<T>(one));
  }
  static void take(const json& from, std::vector<std::string>& all) {
    if (!from.is_array()) return;
    for (const json& one : from) {
      if (one.is_string() && one != "") all.push_back(one.get<std::string>());
    }
  }
  // A point in JSON is a list of two entries; other entries in a list of points are skipped.
  static bool is_point(const json& from) { return from.is_array() && from.size() == 2; }
  static std::array<double, 2> point(const json& from) {
    std::array<double, 2> both{Metrics::unset, Metrics::unset};
    for (std::size_t k = 0; k < 2; ++k) take(from[k], both[k]);
    return both;
  }
  static void take(const json& from, std::vector<std::array<double, 2>>& all) {
    if (!from.is_array()) return;
    for (const json& one : from) {
      if (is_point(one) && one[0].is_number()) all.push_back(point(one));
    }
  }
  static void take(const json& from, std::map<std::string, std::array<double, 2>>& all) {
    if (!from.is_object()) return;
    for (const auto& [key, value] : from.items()) {
      if (is_point(value)) all[key] = point(value);
    }
  }
  template <class T>
  static void take(const json& from, std::map<std::string, T>& all) {
    if (!from.is_object()) return;
    for (const auto& [key, value] : from.items()) take(value, all.emplace(key, blank<T>()).first->second);
  }
  template <class Record>
  requires std::is_class_v<Record>
  static void take(const json& from, Record& record) {
    JsonReader own(from);
    members(own, record);
  }
  template <class T>
  static T blank() {
    if constexpr (std::is_floating_point_v<T>) return Metrics::unset;
    return T{};
  }

  const json* json_;
};

template <class Record>
json record_json(const Record& record) {
  JsonWriter archive;
  members(archive, const_cast<Record&>(record));  // writing does not change the record, so the const may be removed
  return std::move(archive).take();
}

/// Returns the results of a verb (a record) from their JSON. Throws InvalidInput if any part is missing, unknown, or not as
/// json_of() would write it.
template <class Record>
[[nodiscard]] Record whole_record(const json& from) {
  Record record = JsonReader::read<Record>(from);
  require_same(record_json(record), from);
  return record;
}

}  // namespace softland::internal
