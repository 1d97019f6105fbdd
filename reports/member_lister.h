// The archive that lists the members of a record for the manual: see reports/record.h.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "objectives/figure_values.h"
#include "reports/record.h"
#include "reports/record_members.h"

namespace softland::internal {

/// Adds members to a list. A key that is there already gets only the members of its record that it lacks.
inline void add_members(std::vector<JsonMember>& all, std::vector<JsonMember> more) {
  for (JsonMember& one : more) {
    const auto found = std::ranges::find(all, one.key, &JsonMember::key);
    if (found == all.end())
      all.push_back(std::move(one));
    else
      add_members(found->members, std::move(one.members));
  }
}

class MemberLister {
 public:
  static constexpr bool reads = false, lists = true;
  /// A list has the members that exist only in some records.
  [[nodiscard]] static bool has(bool) { return true; }

  template <class T>
  void operator()(std::string_view key, const T& value, std::string_view about) {
    add(key, of(value), about);
  }
  void pair(std::string_view key, double, double, std::string_view about) { add(key, {.type = "2 numbers"}, about); }
  template <class T, class Write, class Read, class Shape>
  void custom(std::string_view key, const T&, const Write&, const Read&, const Like<Shape>& like) {
    add(key, of(Shape{}), like.about);
  }
  template <class T, class Write, class Read, class Shape>
  void custom(std::string_view key, const T&, const Write&, const Read&, const OneOrMore<Shape>& like) {
    add(key, of(Shape{}), like.about);
    add(key, of(std::map<std::string, Shape>{}), std::string(like.about) + ", by name where there are several");
  }
  template <class T, class Write, class Read>
  void custom(std::string_view key, const T&, const Write&, const Read&, const Written& written) {
    add(key, {.type = std::string(written.type)}, written.about);
  }
  template <class T>
  void derived(std::string_view key, const T& value, std::string_view about) {
    (*this)(key, value, about);
  }
  template <class Inside>
  void object(std::string_view key, const Inside& inside, std::string_view about) {
    MemberLister own;
    inside(own);
    add(key, {.type = "record", .members = std::move(own).take()}, about);
  }
  void figures(const FigureValues&, const FigureGroup& group) { add("FIGURE", {.type = "number"}, group.about); }
  [[nodiscard]] std::vector<JsonMember> take() && { return std::move(all_); }

 private:
  // `one.key` is what follows the key: "[]" for a list of records, ".NAME" for values by name.
  void add(std::string_view key, JsonMember one, std::string_view about) {
    one.key.insert(0, key);
    one.about = std::string(about) + one.about;
    std::vector<JsonMember> more;
    more.push_back(std::move(one));
    add_members(all_, std::move(more));
  }

  static JsonMember of(double) { return {.type = "number"}; }
  static JsonMember of(bool) { return {.type = "true or false"}; }
  static JsonMember of(const std::string&) { return {.type = "text"}; }
  static JsonMember of(const json&) { return {.type = "record"}; }
  static JsonMember of(Stopped) { return {.type = "text"}; }
  static JsonMember of(Status) { return {.type = "text"}; }
  static JsonMember of(const Count&) { return {.type = "whole number"}; }
  template <class Rows>
  static JsonMember of(const Chosen<Rows>& choice) {
    std::string names;
    for (const auto& row : choice.rows) names += fmt::format("{}`{}`", names.empty() ? ": " : ", ", row.name);
    return {.type = "text", .about = names};
  }
  template <std::integral Whole>
  static JsonMember of(Whole) {
    return {.type = "whole number"};
  }
  template <class T>
  static JsonMember of(const OrInfinite<T>& inner) {
    JsonMember one = of(inner.value);
    one.about = "; infinite where null";
    return one;
  }
  template <class T>
  static JsonMember of(const OrNull<T>& inner) {
    return of(inner.value);
  }
  template <class T>
  static JsonMember of(const std::optional<T>& value) {
    return value ? of(*value) : of(T{});
  }
  template <class T, std::size_t n>
  static JsonMember of(const std::array<T, n>&) {
    return {.type = fmt::format("{} {}", n, plural(of(T{}).type))};
  }
  template <class T>
  static JsonMember of(const std::vector<T>& all) {
    JsonMember one = all.empty() ? of(T{}) : of(all.front());
    if (one.type != "record") return {.type = "list of " + plural(one.type)};
    one.key.insert(0, "[]");
    return one;
  }
  template <class T>
  static JsonMember of(const std::map<std::string, T>&) {
    JsonMember one = of(T{});
    one.key.insert(0, ".NAME");
    return one;
  }
  template <class Record>
  requires std::is_class_v<Record>
  static JsonMember of(const Record& record) {
    MemberLister own;
    members(own, const_cast<Record&>(record));
    return {.type = "record", .record = typeid(Record).name(), .members = std::move(own).take()};
  }
  static std::string plural(const std::string& type) {
    if (type == "2 numbers") return "pairs of numbers";
    if (type.ends_with(" numbers")) return "rows of " + type;
    if (type.starts_with("list of ")) return "lists" + type.substr(4);
    return type == "true or false" ? "true or false" : type + "s";
  }

  std::vector<JsonMember> all_;
};

/// Returns the members of a record. Members that depend on values of the record are those of `record`.
template <class Record>
[[nodiscard]] std::vector<JsonMember> listed(const Record& record = {}) {
  MemberLister archive;
  members(archive, const_cast<Record&>(record));  // a list does not change the record, so the const may be removed
  return std::move(archive).take();
}

}  // namespace softland::internal
