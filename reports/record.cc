#include "reports/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/printable.h"
#include "base/require.h"
#include "base/shortened.h"

namespace softland::internal {

namespace {

std::string plural(const std::string& type) {
  if (type == "2 numbers") return "pairs of numbers";
  if (type.ends_with(" numbers")) return "rows of " + type;
  if (type.starts_with("list of ")) return "lists" + type.substr(4);
  return type == "true or false" ? "true or false" : type + "s";
}

json figure_json(const Figure& figure, double value) {
  if (!std::isfinite(value)) return nullptr;
  if (figure.is_yes_or_no()) return value != 0;
  return figure.is_count() ? json(std::llround(value)) : json(value);
}

void take_number(const json& from, double& value) {
  if (from.is_number()) value = from.get<double>();
  if (from.is_null()) value = Metrics::unset;
}

double number_or_infinity(const json& from) {
  if (from.is_null()) return std::numeric_limits<double>::infinity();
  return from.is_number() ? from.get<double>() : Metrics::unset;
}

template <class Whole>
void take_whole(const json& from, Whole& value) {
  const double number = from.is_number() ? from.get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (std::abs(number) <= static_cast<double>(std::numeric_limits<int>::max())) value = static_cast<Whole>(number);
}

bool is_point(const json& from) { return from.is_array() && from.size() == 2; }

std::array<double, 2> point(const json& from) {
  std::array<double, 2> both{Metrics::unset, Metrics::unset};
  for (std::size_t k = 0; k < 2; ++k) take_number(from[k], both[k]);
  return both;
}

json point_json(const std::array<double, 2>& both) { return {json_number(both[0]), json_number(both[1])}; }

}  // namespace

void add_members(std::vector<JsonMember>& all, std::vector<JsonMember> more) {
  for (JsonMember& one : more) {
    const auto found = std::ranges::find(all, one.key, &JsonMember::key);
    if (found == all.end())
      all.push_back(std::move(one));
    else
      add_members(found->members, std::move(one.members));
  }
}

void require_same(const json& written, const json& read) {
  const json changes = json::diff(read, written);
  if (changes.empty()) return;
  // JSON pointer of the first difference between two records: "/touch/least_time_s".
  std::string key = changes[0]["path"].get<std::string>();
  for (char& letter : key) {
    if (letter == '/') letter = '.';
  }
  if (!key.empty()) key.erase(0, 1);
  key = shortened(printable_line(key));
  const std::string how = changes[0]["op"];
  require(how != "add", [&] { return fmt::format("\"{}\" is missing", key); });
  require(how != "remove", [&] { return fmt::format("\"{}\" is not known", key); });
  throw InvalidInput(fmt::format("\"{}\" is not as softland writes it", key));
}

const json& value_at(const json& object, std::string_view key) {
  static const json nothing;
  if (!object.is_object()) return nothing;
  const auto found = object.find(key);
  return found == object.end() ? nothing : *found;
}

void Archive::member(std::string_view key, Erased value, std::string_view about) {
  Archive own(task_, reads() ? &value_at(*read_, key) : nullptr);
  value.transfer(own, value.value);
  if (lists()) return list_member(key, std::move(own.listed_), about);
  if (task_ == Task::write && !own.is_absent_) json_[std::string(key)] = std::move(own.json_);
}

void Archive::pair(std::string_view key, double& low, double& high, std::string_view about) {
  if (task_ == Task::write) json_[std::string(key)] = point_json({low, high});
  if (lists()) list(key, Written{"2 numbers", about});
  if (!reads()) return;
  const json& list = value_at(*read_, key);
  if (!is_point(list)) return;
  take_number(list[0], low);
  take_number(list[1], high);
}

void Archive::figures(FigureValues& values, const FigureGroup& group) {
  if (lists()) return list("FIGURE", Written{"number", group.about});
  for (const Figure& figure : all_figures) {
    if (reads()) {
      const json& from = value_at(*read_, figure.key);
      if (figure.asked != nullptr && read_->contains(figure.key)) values.asked.*figure.asked = true;
      values[figure] = figure.is_yes_or_no() && from.is_boolean() ? from.get<bool>() : Metrics::unset;
      take_number(from, values[figure]);
    } else if (group.has(figure) && figure.is_asked(values.asked)) {
      json_[std::string(figure.key)] = figure_json(figure, values[figure]);
    }
  }
}

Archive Archive::opened(std::string_view key) const {
  Archive own(task_, reads() ? &value_at(*read_, key) : nullptr);
  own.begin_object();
  own.listed_.type = "record";
  return own;
}

void Archive::close(std::string_view key, Archive own, std::string_view about) {
  if (task_ == Task::write) json_[std::string(key)].update(own.json_);
  if (lists()) list_member(key, std::move(own.listed_), about);
}

void Archive::begin_list() {
  if (task_ == Task::write) json_ = json::array();
}

void Archive::begin_object() {
  if (task_ == Task::write) json_ = json::object();
}

std::size_t Archive::size() const { return reads() && read_->is_array() ? read_->size() : 0; }

std::vector<std::string> Archive::keys() const {
  std::vector<std::string> all;
  if (!reads() || !read_->is_object()) return all;
  for (const auto& [key, value] : read_->items()) all.push_back(key);
  return all;
}

void Archive::item(std::size_t k, Erased value) {
  if (reads() && k >= size()) return;
  Archive own(task_, reads() ? &(*read_)[k] : nullptr);
  value.transfer(own, value.value);
  if (task_ == Task::write) json_.push_back(std::move(own.json_));
  if (lists()) listed_.type = std::move(own.listed_.type);
}

void Archive::item(const std::string& key, Erased value) {
  if (!lists()) member(key, value, {});
}

// The key of `one` is what follows the key of the member: "[]" for a list of records, ".NAME" for values by name.
void Archive::list_member(std::string_view key, JsonMember one, std::string_view about) {
  one.key.insert(0, key);
  one.about.insert(0, about);
  std::vector<JsonMember> more;
  more.push_back(std::move(one));
  add_members(listed_.members, std::move(more));
}

void Archive::list(std::string_view key, const Written& written) {
  list_member(key, {.type = std::string(written.type)}, written.about);
}

void Archive::list_array(std::size_t size) { listed_ = {.type = fmt::format("{} {}", size, plural(listed_.type))}; }

void Archive::list_items(Erased one) {
  one.transfer(*this, one.value);
  if (listed_.type == "record")
    listed_.key.insert(0, "[]");
  else
    listed_ = {.type = "list of " + plural(listed_.type)};
}

void Archive::list_named(Erased one) {
  one.transfer(*this, one.value);
  listed_.key.insert(0, ".NAME");
}

void Archive::list_name(std::string_view name) {
  listed_.about += fmt::format("{}`{}`", listed_.about.empty() ? ": " : ", ", name);
}

void Archive::transfer(Archive& at, double& value) {
  at.listed_.type = "number";
  if (at.task_ == Task::write) at.json_ = json_number(value);
  if (at.reads()) take_number(*at.read_, value);
}

void Archive::transfer(Archive& at, bool& value) {
  at.listed_.type = "true or false";
  if (at.task_ == Task::write) at.json_ = value;
  if (at.reads() && at.read_->is_boolean()) value = at.read_->get<bool>();
}

void Archive::transfer(Archive& at, int& value) {
  at.listed_.type = "whole number";
  if (at.task_ == Task::write) at.json_ = value;
  if (at.reads()) take_whole(*at.read_, value);
}

void Archive::transfer(Archive& at, std::int64_t& value) {
  at.listed_.type = "whole number";
  if (at.task_ == Task::write) at.json_ = value;
  if (at.reads()) take_whole(*at.read_, value);
}

void Archive::transfer(Archive& at, std::uint64_t& value) {
  at.listed_.type = "whole number";
  if (at.task_ == Task::write) at.json_ = value;
  if (at.reads() && at.read_->is_number_integer() && *at.read_ >= 0) value = at.read_->get<std::uint64_t>();
}

void Archive::transfer(Archive& at, std::string& text) {
  at.listed_.type = "text";
  if (at.task_ == Task::write) at.json_ = text;
  if (at.reads() && at.read_->is_string()) text = at.read_->get<std::string>();
}

void Archive::transfer(Archive& at, json& as_it_is) {
  at.listed_.type = "record";
  if (at.task_ == Task::write) at.json_ = as_it_is;
  if (at.reads()) as_it_is = *at.read_;
}

void Archive::transfer(Archive& at, Stopped& study) {
  at.listed_.type = "text";
  if (at.task_ == Task::write) at.json_ = study.interrupted ? "interrupted" : "done";
  if (at.reads()) study.interrupted = *at.read_ == "interrupted";
}

void Archive::transfer(Archive& at, Status& status) {
  at.listed_.type = "text";
  if (at.task_ == Task::write) at.json_ = to_string(status);
  for (int k = 0; at.reads() && k <= static_cast<int>(Status::interrupted); ++k) {
    if (*at.read_ == to_string(static_cast<Status>(k))) status = static_cast<Status>(k);
  }
}

void Archive::transfer(Archive& at, Count& count) {
  at.listed_.type = "whole number";
  if (at.task_ == Task::write && std::isfinite(count.value)) at.json_ = std::llround(count.value);
  if (at.reads()) take_number(*at.read_, count.value);
}

void Archive::transfer(Archive& at, OrInfinite<double>& number) {
  at.listed_ = {.type = "number", .about = "; infinite where null"};
  if (at.task_ == Task::write) at.json_ = json_number(number.value);
  if (at.reads()) number.value = number_or_infinity(*at.read_);
}

void Archive::transfer(Archive& at, OrInfinite<std::map<std::string, double>>& numbers) {
  if (!at.reads()) {
    transfer(at, numbers.value);
    at.listed_.about = "; infinite where null";
  } else if (at.read_->is_object()) {
    for (const auto& [key, value] : at.read_->items()) numbers.value[key] = number_or_infinity(value);
  }
}

void Archive::transfer(Archive& at, OrNull<std::string>& text) {
  transfer(at, text.value);
  if (at.task_ == Task::write && text.value.empty()) at.json_ = nullptr;
}

void Archive::transfer(Archive& at, std::vector<double>& all) {
  at.listed_.type = "list of numbers";
  at.begin_list();
  if (at.task_ == Task::write) {
    for (const double value : all) at.json_.push_back(json_number(value));
  }
  if (at.reads()) all.reserve(at.size());
  for (std::size_t k = 0, n = at.size(); k < n; ++k) take_number((*at.read_)[k], all.emplace_back(Metrics::unset));
}

void Archive::transfer(Archive& at, std::vector<std::string>& all) {
  at.listed_.type = "list of texts";
  if (at.task_ == Task::write) at.json_ = all;
  for (std::size_t k = 0, n = at.size(); k < n; ++k) {
    const json& one = (*at.read_)[k];
    if (one.is_string() && one != "") all.push_back(one.get<std::string>());
  }
}

void Archive::transfer(Archive& at, std::vector<std::array<double, 2>>& all) {
  at.listed_.type = "list of pairs of numbers";
  at.begin_list();
  if (at.task_ == Task::write) {
    for (const std::array<double, 2>& both : all) at.json_.push_back(point_json(both));
  }
  for (std::size_t k = 0, n = at.size(); k < n; ++k) {
    const json& one = (*at.read_)[k];
    if (is_point(one) && one[0].is_number()) all.push_back(point(one));
  }
}

void Archive::transfer(Archive& at, std::map<std::string, std::array<double, 2>>& all) {
  if (at.lists()) at.listed_ = {.key = ".NAME", .type = "2 numbers"};
  at.begin_object();
  if (at.task_ == Task::write) {
    for (const auto& [key, both] : all) at.json_[key] = point_json(both);
  }
  for (const std::string& key : at.keys()) {
    if (const json& one = value_at(*at.read_, key); is_point(one)) all[key] = point(one);
  }
}

}  // namespace softland::internal
