#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "base/printable.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/shortened.h"
#include "config/drives.h"
#include "config/invalid_key.h"
#include "config/scene.h"
#include "config/scene_file_impl.h"
#include "config/schema.h"
#include "config/units.h"

namespace softland {
namespace internal {
namespace {

constexpr std::size_t deepest_path = 16;

/// Returns the end of the string that begins at `begin`; a single-line string ends with its line at the latest.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string triple(3, quote);
  const bool is_multiline = text.substr(begin).starts_with(triple);
  for (std::size_t i = begin + (is_multiline ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (is_multiline && text.substr(i).starts_with(triple)) {
      const auto rest = text.find_first_not_of(quote, i);  // up to two quotes may stand before the closing three
      return rest == std::string_view::npos ? text.size() : rest;
    } else if (!is_multiline && (text[i] == quote || text[i] == '\n')) {
      return i + 1;
    }
  }
  return text.size();
}

/// Returns the place where a dotted key has too many parts, npos if none has. toml++ limits nested values but not dotted keys;
/// a table of some ten thousand levels overflows the stack when it is destroyed.
std::size_t find_deep_dotted_key(std::string_view text) {
  constexpr std::string_view ends_of_key = "\n=,[]{}";
  std::size_t dots = 0;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_string(text, i);
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '.' && ++dots >= deepest_path) return i;
    if (ends_of_key.find(c) != std::string_view::npos) dots = 0;
    ++i;
  }
  return std::string_view::npos;
}

std::string float_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::string text = number_text(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";  // an integer would change type
  return text;
}

std::string key_text(std::string_view key) { return is_bare_key(key) ? std::string(key) : toml_string(key); }

/// The keys of `table`: those in `order` first, then the rest by name.

struct Entry {
  std::string key;
  const toml::node* node;
};

std::vector<Entry> ordered(const toml::table& table, const std::vector<std::string_view>& order) {
  std::vector<Entry> entries;
  for (const auto& [key, node] : table) entries.push_back({std::string(key.str()), &node});
  const auto rank = [&](const Entry& entry) { return std::find(order.begin(), order.end(), entry.key) - order.begin(); };
  std::stable_sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) { return rank(a) < rank(b); });
  return entries;
}

std::vector<std::string_view> section_names() {
  std::vector<std::string_view> names;
  for (const Section& section : schema()) names.push_back(section.name);
  return names;
}

std::vector<std::string_view> key_names(const Section* section) {
  std::vector<std::string_view> names;
  if (section) {
    for (const Key& key : section->keys) names.push_back(key.name);
  }
  return names;
}

/// Writes a section and its subsections. Inline tables stay inline: an entry of [spread] is most readable on one line.
void write_section(std::string& out, const toml::table& table, const std::string& path, std::size_t depth,
                   const Section* section) {
  const bool holds_keys = section && (depth == (section->is_named ? 2U : 1U) || (section->may_be_named && depth == 2));
  const std::vector<Entry> entries = ordered(table, holds_keys ? key_names(section) : std::vector<std::string_view>{});
  const auto is_subsection = [](const Entry& entry) { return entry.node->is_table() && !entry.node->as_table()->is_inline(); };
  if (entries.empty() || !std::all_of(entries.begin(), entries.end(), is_subsection)) {
    if (!out.empty()) out += '\n';
    out += fmt::format("[{}]\n", path);
  }
  for (const Entry& entry : entries) {
    if (!is_subsection(entry)) out += fmt::format("{} = {}\n", key_text(entry.key), inline_text(*entry.node));
  }
  for (const Entry& entry : entries) {
    if (is_subsection(entry)) write_section(out, *entry.node->as_table(), join_path(path, entry.key), depth + 1, section);
  }
}

nlohmann::json to_json(const toml::node& node) {
  if (const auto* table = node.as_table()) {
    nlohmann::json json = nlohmann::json::object();
    for (const auto& [key, value] : *table) json[std::string(key.str())] = to_json(value);
    return json;
  }
  if (const auto* array = node.as_array()) {
    nlohmann::json json = nlohmann::json::array();
    for (const auto& value : *array) json.push_back(to_json(value));
    return json;
  }
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* flag = node.as_boolean()) return flag->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* number = node.as_floating_point())
    return std::isfinite(number->get()) ? nlohmann::json(number->get()) : nullptr;
  return inline_text(node);  // dates and times
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& name) {
  if (const auto at = find_deep_dotted_key(text); at != std::string_view::npos) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw InvalidInput(fmt::format("{}:{}: a key has more than {} parts", name, line, deepest_path));
  }
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    // A quantity without quotes, as in length = 2 um, is a common error that the message of the parser does not explain.
    const bool may_miss_quotes = error.description().find("expected a comment or whitespace") != std::string_view::npos;
    throw InvalidInput(fmt::format("{}:{}:{}: not TOML: {}{}", name, at.line, at.column, shortened(error.description(), 200),
                                   may_miss_quotes ? " (a quantity needs quotes: \"2 um\")" : ""));
  }
}

bool is_bare_key(std::string_view key) {
  constexpr std::string_view extra = "_-";
  return !key.empty() && std::all_of(key.begin(), key.end(), [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || extra.find(c) != std::string_view::npos;
  });
}

std::string write_scene(const toml::table& root) {
  std::string out;
  const std::vector<Entry> entries = ordered(root, section_names());
  const auto is_section = [](const Entry& entry) { return entry.node->is_table() && !entry.node->as_table()->is_inline(); };
  for (const Entry& entry : entries) {
    if (!is_section(entry)) out += fmt::format("{} = {}\n", key_text(entry.key), inline_text(*entry.node));
  }
  for (const Entry& entry : entries) {
    if (is_section(entry)) write_section(out, *entry.node->as_table(), key_text(entry.key), 1, find_section(entry.key));
  }
  return out;
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\t':
        out += "\\t";
        break;
      case '\r':
        out += "\\r";
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
          out += fmt::format("\\u{:04X}", static_cast<int>(c));
        } else {
          out += c;
        }
    }
  }
  return out + '"';
}

std::string inline_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return toml_string(text->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
  if (const auto* number = node.as_floating_point()) return float_text(number->get());
  if (const auto* array = node.as_array()) {
    std::vector<std::string> parts;
    for (const auto& value : *array) parts.push_back(inline_text(value));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
  if (const auto* table = node.as_table()) {
    if (table->empty()) return "{}";
    std::vector<std::string> parts;
    for (const auto& [key, value] : *table) parts.push_back(key_text(key.str()) + " = " + inline_text(value));
    return fmt::format("{{ {} }}", fmt::join(parts, ", "));
  }
  std::ostringstream out;
  node.visit([&](const auto& value) {
    if constexpr (!toml::is_container<decltype(value)>) out << value.get();
  });
  return out.str();
}

std::string join_path(const std::string& path, std::string_view key) {
  const auto [name, element] = without_element(key);
  const std::string text = element && is_bare_key(name) ? std::string(key) : key_text(key);
  return path.empty() ? text : path + "." + text;
}

const toml::node* child_of(const toml::table& table, const std::string& key) {
  if (const toml::node* const node = table.get(key)) return node;
  const auto [name, element] = without_element(key);
  const toml::node* const list = element ? table.get(name) : nullptr;
  const toml::array* const array = list != nullptr ? list->as_array() : nullptr;
  return array != nullptr && *element >= 1 ? array->get(*element - 1) : nullptr;
}

std::vector<std::string> split_path(std::string_view given) {
  // An element of a list is one part of the path: structure."sections[2]".width.
  std::string path;
  for (std::size_t begin = 0; begin <= given.size();) {
    std::size_t end = begin;
    for (char quote = 0; end < given.size() && (quote != 0 || given[end] != '.'); ++end) {
      if (quote == 0 && (given[end] == '"' || given[end] == '\'')) {
        quote = given[end];
      } else if (given[end] == quote && !(quote == '"' && given[end - 1] == '\\')) {
        quote = 0;
      }
    }
    const std::string_view part = given.substr(begin, end - begin);
    const auto [name, element] = without_element(part);
    path += element && is_bare_key(name) ? toml_string(part) : std::string(part);
    if (end < given.size()) path += '.';
    begin = end + 1;
  }
  // The TOML parser reads the path, so that quotes have the same meaning as in a file.
  const std::string rule = "not a key path such as structure.length";
  std::vector<std::string> parts;
  try {
    const toml::table parsed = parse_toml(std::string(path) + " = 0", "");
    for (const toml::table* table = &parsed; table != nullptr;) {
      if (table->size() != 1) throw InvalidInput(rule);
      const auto first = table->begin();  // keeps the iterator, which owns the key that it points to
      parts.emplace_back(first->first.str());
      table = first->second.as_table();
    }
  } catch (const InvalidInput&) {
    throw InvalidInput(rule);
  }
  return parts;
}

std::pair<std::string, std::optional<std::size_t>> without_element(std::string_view name) {
  const std::size_t bracket = name.rfind('[');
  if (bracket == std::string_view::npos || !name.ends_with(']')) return {std::string(name), std::nullopt};
  std::size_t element = 0;
  const char* const end = name.data() + name.size() - 1;
  const auto [rest, error] = std::from_chars(name.data() + bracket + 1, end, element);
  if (error != std::errc() || rest != end) return {std::string(name), std::nullopt};
  return {std::string(name.substr(0, bracket)), element};
}

toml::table parse_value(std::string_view toml_text) {
  return parse_toml(fmt::format("{} = {}", value_key, toml_text), std::string(toml_text));
}

}  // namespace internal

namespace {

using internal::join_path;

/// Returns the depth of nested tables.
std::size_t levels(const toml::node& node) {
  const toml::table* table = node.as_table();
  if (!table) return 0;
  std::size_t deepest = 0;
  for (const auto& [key, value] : *table) deepest = std::max(deepest, levels(value));
  return deepest + 1;
}

void record_origins(SceneFile::Impl& impl, const toml::table& table, const std::string& path, std::size_t parts = 1) {
  for (const auto& [key, node] : table) {
    const std::string key_path = join_path(path, key.str());
    const std::string place = fmt::format("{}:{}", impl.name, node.source().begin.line);
    impl.origins[key_path] = {place};
    if (const auto* list = node.as_array()) {
      for (std::size_t k = 0; k < list->size(); ++k) {
        const std::string element = fmt::format("{}[{}]", key_path, k + 1);
        const auto* const one = list->get(k)->as_table();
        if (one == nullptr || parts >= internal::deepest_path) continue;
        impl.origins[element] = {fmt::format("{}:{}", impl.name, one->source().begin.line)};
        record_origins(impl, *one, element, parts + 1);
      }
    }
    const auto* inner = node.as_table();
    if (!inner) continue;
    // A section and a dotted key may together form a path that is too deep to be read again.
    require(parts < internal::deepest_path, fmt::format("{}: a key has more than {} parts", place, internal::deepest_path));
    record_origins(impl, *inner, key_path, parts + 1);
  }
}

bool is_below(std::string_view path, std::string_view ancestor) {
  return path.size() > ancestor.size() && path.starts_with(ancestor) &&
         (path[ancestor.size()] == '.' || path[ancestor.size()] == '[');
}

}  // namespace

const toml::node* SceneFile::Impl::find(const std::vector<std::string>& path) const {
  const toml::node* node = &root;
  for (const std::string& key : path) {
    const toml::table* table = node->as_table();
    node = table ? internal::child_of(*table, key) : nullptr;
    if (!node) return nullptr;
  }
  return node;
}

SceneFile::Impl::Origin SceneFile::Impl::origin(std::string_view path) const {
  if (const auto exact = origins.find(path); exact != origins.end()) return exact->second;
  // Find the origin of a value that contains this key, such as an option that replaced a whole section.
  const Origin* nearest = nullptr;
  for (const auto& [known, place] : origins) {
    if (is_below(path, known)) nearest = &place;  // ancestors sort from the shortest to the longest
  }
  if (nearest) return *nearest;
  // Find a section that exists only because an option set one of its keys.
  for (const auto& [known, place] : origins) {
    if (is_below(known, path)) return place;
  }
  return {name};
}

void SceneFile::Impl::forget(std::string_view path) {
  std::erase_if(origins, [&](const auto& entry) { return entry.first == path || is_below(entry.first, path); });
}

std::string SceneFile::Impl::written(std::string_view path) const {
  const toml::node* node = find(internal::split_path(path));
  return fmt::format("{} = {}", shortened(path), shortened(node ? internal::inline_text(*node) : std::string()));
}

namespace {

// Returns "scenes/x.toml:12" as file and line.
InvalidKey::Place place_of_origin(std::string_view key, const SceneFile::Impl::Origin& origin) {
  InvalidKey::Place place{.key = std::string(key)};
  if (origin.is_option) return place;
  const std::size_t colon = origin.text.rfind(':');
  const auto line = colon == std::string::npos ? std::string() : origin.text.substr(colon + 1);
  const bool is_line = !line.empty() && line.size() < 9 && line.find_first_not_of("0123456789") == std::string::npos;
  place.file = is_line ? origin.text.substr(0, colon) : origin.text;
  place.line = is_line ? std::stoi(line) : 0;
  return place;
}

}  // namespace

void SceneFile::Impl::fail(std::string_view path, std::string_view rule) const {
  const Origin place = origin(path);
  const auto exact = origins.find(path);
  const bool is_said = place.is_option && exact != origins.end();
  throw InvalidKey(is_said ? fmt::format("{}: {}", place.text, printable_line(rule))
                           : fmt::format("{}: {}: {}", place.text, written(path), printable_line(rule)),
                   place_of_origin(path, place));
}

void SceneFile::Impl::fail_section(std::string_view path, std::string_view rule) const {
  const auto is_option_below = [&](const auto& entry) { return entry.second.is_option && is_below(entry.first, path); };
  const auto option = std::find_if(origins.begin(), origins.end(), is_option_below);
  const Origin place = option == origins.end() ? origin(path) : option->second;
  throw InvalidKey(fmt::format("{}: [{}]: {}", place.text, shortened(path), printable_line(rule)), place_of_origin(path, place));
}

void SceneFile::Impl::insert(const std::vector<std::string>& path, const toml::node& value, const Origin& place) {
  toml::table* table = &root;
  std::string parent, path_text, replaced;
  for (const std::string& key : path) {
    parent = std::exchange(path_text, join_path(path_text, key));
    if (&key == &path.back()) break;
    toml::node* const known = const_cast<toml::node*>(internal::child_of(*table, key));
    if (known == nullptr) {
      if (internal::without_element(key).second)
        throw InvalidInput(fmt::format("{}: {} is not an element of a list in this scene", place.text, path_text));
      table->insert(key, toml::table{});
    }
    table = (known != nullptr ? known : table->get(key))->as_table();
    if (!table) throw InvalidInput(fmt::format("{}: {} is not a section", place.text, written(path_text)));
  }
  if (const internal::Section* section = internal::find_section(path.front(), path.size() > 1 ? path[1] : std::string());
      section && (path.size() == (section->is_named ? 3U : 2U) || (section->may_be_named && path.size() == 3))) {
    for (const internal::Key& key : section->keys) {
      if (key.name != path.back()) continue;
      for (const std::string_view other : key.instead_of) {
        if (table->erase(other) == 0) continue;
        replaced = join_path(parent, other);
        forget(replaced);
      }
    }
  }
  value.visit([&](const auto& node) { table->insert_or_assign(path.back(), node); });
  forget(path_text);
  origins[path_text] = place;
  origins[path_text].replaced = replaced;
}

std::string SceneFile::Impl::replaced_in(std::string_view section) const {
  for (const auto& [path, place] : origins) {
    if (!place.replaced.empty() && is_below(path, section)) return fmt::format("; {} replaced {}", path, place.replaced);
  }
  return {};
}

toml::array SceneFile::Impl::with_element(const std::vector<std::string>& path, std::size_t element, const toml::node& value,
                                          const std::string& option) const {
  const toml::node* there = find(path);
  const toml::array* list = there == nullptr ? nullptr : there->as_array();
  require(list != nullptr, [&] {
    return fmt::format("{}: {} must be a list in this scene: give the whole list, such as --set '{}=[\"10 um\", \"tip\"]'",
                       option, fmt::join(path, "."), fmt::join(path, "."));
  });
  require(element >= 1 && element <= list->size(),
          [&] { return fmt::format("{}: {} is a list of {}, counted from 1", option, fmt::join(path, "."), list->size()); });
  toml::array changed = *list;
  value.visit([&](const auto& node) { changed.replace(changed.cbegin() + static_cast<std::ptrdiff_t>(element - 1), node); });
  return changed;
}

bool SceneFile::Impl::is_named(const internal::Section& section) const {
  if (!section.may_be_named) return section.is_named;
  const toml::node* node = find({std::string(section.name)});
  return node != nullptr && node->is_table() &&
         std::ranges::any_of(*node->as_table(), [](const auto& entry) { return entry.second.is_table(); });
}

std::vector<std::string> SceneFile::Impl::names_in(const std::string& section) const {
  std::vector<std::string> names;
  const toml::node* node = find({section});
  if (!node) return names;
  if (!node->is_table()) fail(section, fmt::format("expected sections [{}.NAME]", section));
  const std::string_view beside = internal::find_section(section)->beside;
  for (const auto& [key, value] : *node->as_table()) {
    if (!beside.empty() && key.str() == beside) continue;
    if (!value.is_table()) {
      const std::string key_beside = beside.empty() ? "" : fmt::format(" or the key '{}'", beside);
      if (internal::find_section(section)->may_be_named)
        fail(join_path(section, key.str()),
             fmt::format("[{}] must not be combined with [{}.NAME]: use one of the two forms", section, section));
      fail(join_path(section, key.str()), fmt::format("expected a section [{}.NAME]{}", section, key_beside));
    }
    names.emplace_back(key.str());
  }
  return names;
}

SceneFile::SceneFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SceneFile::SceneFile(const SceneFile& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
SceneFile& SceneFile::operator=(const SceneFile& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
SceneFile::SceneFile(SceneFile&&) noexcept = default;
SceneFile& SceneFile::operator=(SceneFile&&) noexcept = default;
SceneFile::~SceneFile() = default;

SceneFile SceneFile::load(const std::filesystem::path& path) { return parse(read_file(path), path.string(), path.parent_path()); }

SceneFile SceneFile::parse(std::string_view text, std::string name, std::filesystem::path directory) {
  auto impl = std::make_unique<Impl>();
  impl->root = internal::parse_toml(text, name);
  impl->name = std::move(name);
  impl->directory = std::move(directory);
  record_origins(*impl, impl->root, "");
  return SceneFile(std::move(impl));
}

void SceneFile::set(std::string_view assignment) {
  const std::string option = "--set " + shortened(printable_line(assignment));
  const auto equals = assignment.find('=');
  require(equals != std::string_view::npos, option + ": must be of the form key.path=value");
  const std::string_view value = assignment.substr(equals + 1);

  const auto [key, element] = internal::without_element(assignment.substr(0, equals));
  std::vector<std::string> path;
  try {
    path = internal::split_path(key);
  } catch (const InvalidInput& error) {
    throw InvalidInput(option + ": " + error.what());
  }

  toml::table parsed;
  try {
    parsed = internal::parse_value(value);
  } catch (const InvalidInput&) {
    parsed.clear();
  }
  if (parsed.size() != 1) {  // not TOML, or a line break smuggled in a second key
    try {
      parsed = internal::parse_value(internal::toml_string(value));
    } catch (const InvalidInput&) {
      throw InvalidInput(
          fmt::format("--set {}: the value is not UTF-8 text", shortened(printable_line(assignment.substr(0, equals)))));
    }
  }

  const toml::node& node = *parsed.get(internal::value_key);
  require(path.size() + levels(node) <= internal::deepest_path,
          [&] { return fmt::format("{}: a key has more than {} parts", option, internal::deepest_path); });
  if (element) {
    impl_->insert(path, impl_->with_element(path, *element, node, option), {option, true});
  } else {
    impl_->insert(path, node, {option, true});
  }
}

void SceneFile::assign(const std::string& path, const SceneValue& value) {
  const std::vector<std::string> parts = internal::split_path(path);
  const internal::Key* key = internal::find_key(parts);
  if (key == nullptr) throw std::logic_error("no scene has the key " + path);
  toml::table holder;
  std::visit(
      [&]<class Value>(const Value& v) {
        if constexpr (std::is_same_v<Value, double>) {
          if (!key->is_bare_number()) return void(holder.insert(internal::value_key, quantity_text(v, key->dimensions.front())));
        }
        holder.insert(internal::value_key, v);
      },
      value);
  impl_->insert(parts, *holder.get(internal::value_key), {impl_->name});
}

void SceneFile::assign(const std::string& path, const Quantity& value, std::size_t element) {
  const std::vector<std::string> parts = internal::split_path(path);
  const internal::Key* key = internal::find_key(parts);
  if (key == nullptr) throw std::logic_error("no scene has the key " + path);
  toml::table holder;
  internal::insert_quantity(*key, value, [&](const auto& node) { holder.insert(internal::value_key, node); });
  if (element == 0) return impl_->insert(parts, *holder.get(internal::value_key), {impl_->name});
  const toml::node* there = impl_->find(parts);
  if (there == nullptr || !there->is_array() || element > there->as_array()->size())
    throw std::logic_error(fmt::format("{} has no element {}", path, element));
  toml::array list = *there->as_array();
  holder.get(internal::value_key)->visit([&](const auto& node) {
    list.replace(list.cbegin() + static_cast<std::ptrdiff_t>(element - 1), node);
  });
  impl_->insert(parts, list, {impl_->name});
}

void SceneFile::erase(const std::string& path) {
  const std::vector<std::string> parts = internal::split_path(path);
  toml::table* table = &impl_->root;
  for (std::size_t i = 0; i + 1 < parts.size() && table; ++i) {
    toml::node* const inner = const_cast<toml::node*>(internal::child_of(*table, parts[i]));
    table = inner != nullptr ? inner->as_table() : nullptr;
  }
  if (table && table->erase(parts.back()) > 0) impl_->forget(path);
}

void SceneFile::set_waveform(const std::string& drive, const Waveform& given) {
  if (const Own* own = std::get_if<Own>(&given))
    throw InvalidInput(fmt::format("waveform.{}: {} cannot be written into a scene file", drive, described(*own)));
  static_cast<void>(signal(given));  // a waveform that breaks its family's rules would write an unreadable scene
  const bool is_factor = drive == dispersion_drive;
  const Waveform waveform = is_factor ? internal::raised(given, 1) : given;
  toml::table table{{"family", std::string(family(waveform))}};
  std::visit(
      [&]<class Family>(const Family& w) {
        for (const Parameter<Family>& p : FamilyOf<Family>::parameters) {
          const bool plain = is_factor && (p.kind == ParameterKind::level || p.kind == ParameterKind::swing);
          const auto put = [&](auto&& insert, double value) {
            plain ? insert(value) : insert(quantity_text(value, internal::dimension_of(p.kind)));
          };
          if (const auto* one = std::get_if<double Family::*>(&p.member)) {
            if (std::isfinite(w.*(*one))) put([&](const auto& value) { table.insert(p.name, value); }, w.*(*one));
            continue;
          }
          toml::array array;
          for (const double v : w.*std::get<std::vector<double> Family::*>(p.member)) {
            put([&](const auto& value) { array.push_back(value); }, v);
          }
          table.insert(p.name, std::move(array));
        }
      },
      waveform);
  for (const std::string_view key : {internal::before_key, internal::before_state_key}) {
    if (const toml::node* before = impl_->find({"waveform", drive, std::string(key)}))
      before->visit([&](const auto& node) { table.insert(key, node); });
  }
  toml::table* waveforms = impl_->root["waveform"].as_table();
  if (!waveforms) waveforms = impl_->root.insert_or_assign("waveform", toml::table{}).first->second.as_table();
  waveforms->insert_or_assign(drive, std::move(table));
  const std::string path = join_path("waveform", drive);
  impl_->forget(path);
  impl_->origins[path] = {impl_->name};
}

void SceneFile::forget_places() { impl_->origins.clear(); }

void SceneFile::add_contact(const Contact& contact) { impl_->own_contact = contact; }

SceneFile SceneFile::again(std::string name) const {
  SceneFile same = parse(internal::write_scene(impl_->root), std::move(name));
  same.impl_->own_contact = impl_->own_contact;
  return same;
}

namespace {

// Throws InvalidInput where the scene contains more than a file can express.
void require_writable(const SceneFile::Impl& impl) {
  const auto* const own = impl.own_contact ? std::get_if<OwnContact>(&impl.own_contact->model) : nullptr;
  require(!impl.own_contact, [&] {
    return fmt::format("{}: the contact law '{}' is defined by a program, and a scene file cannot express it", impl.name,
                       own && own->own ? own->own->name() : name_of(impl.own_contact->model));
  });
}

}  // namespace

std::string SceneFile::text() const {
  require_writable(*impl_);
  return internal::write_scene(impl_->root);
}
nlohmann::json SceneFile::json() const {
  require_writable(*impl_);
  return internal::to_json(impl_->root);
}

std::optional<std::string> SceneFile::written(const std::string& path) const {
  const toml::node* node = impl_->find(internal::split_path(path));
  if (node == nullptr) return std::nullopt;
  if (const auto* section = node->as_table()) return (*section)["model"].value_or(std::string());
  if (const auto* text = node->as_string()) return text->get();
  return internal::to_json(*node).dump();
}

std::vector<std::string> SceneFile::keys(const std::string& section) const {
  std::vector<std::string> all;
  const toml::node* node = impl_->find(internal::split_path(section));
  if (node == nullptr || !node->is_table()) return all;
  for (const auto& [key, value] : *node->as_table()) all.emplace_back(key.str());
  return all;
}

const std::string& SceneFile::name() const { return impl_->name; }

void SceneFile::refuse(const std::string& path, std::string_view rule) const {
  std::vector<std::string> parts = internal::split_path(path);
  if (impl_->find(parts)) impl_->fail(path, rule);
  parts.pop_back();
  std::string section;
  for (const std::string& part : parts) section = join_path(section, part);
  impl_->fail_section(section, rule);
}

}  // namespace softland
