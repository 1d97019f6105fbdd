#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "base/require.h"
#include "base/shortened.h"
#include "config/scene_file_impl.h"
#include "config/schema.h"

namespace softland {
namespace internal {
namespace {

/// Returns the index behind the TOML string that begins at `begin`. A single-line string without a closing quote ends with its
/// line.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string triple(3, quote);
  const bool is_multiline = text.substr(begin).starts_with(triple);
  for (std::size_t i = begin + (is_multiline ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (is_multiline && text.substr(i).starts_with(triple)) {
      const auto rest = text.find_first_not_of(quote, i);  // up to two quotes of the content may precede the closing three
      return rest == std::string_view::npos ? text.size() : rest;
    } else if (!is_multiline && (text[i] == quote || text[i] == '\n')) {
      return i + 1;
    }
  }
  return text.size();
}

/// Returns the index in the text of a dotted key that has too many parts, npos if none has. toml++ limits nested values but not
/// dotted keys; a table of some ten thousand levels overflows the stack when it is destroyed.
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
  if (text.find_first_of(".e") == std::string::npos) text += ".0";  // without a point, TOML reads an integer
  return text;
}

std::string key_text(std::string_view key) { return is_bare_key(key) ? std::string(key) : toml_string(key); }

/// Returns the keys of `table`: those in `order` first, then the others sorted by name.

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

/// Writes a section of a scene and its subsections. Inline tables, such as the varied quantities in [spread], stay on one line.
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

// Returns true if a text without closing quote ran to the end of its line, which the parser takes for a forbidden control
// character, or to the end of the file.
bool is_unclosed(std::string_view toml, const toml::parse_error& error) {
  const std::string_view what = error.description();
  const auto says = [&](std::string_view words) { return what.find(words) != std::string_view::npos; };
  if (!says("string:") || says("multi-line")) return false;
  if (says("end-of-file")) return true;
  for (auto line = error.source().begin.line; line > 1; --line) toml.remove_prefix(toml.find('\n') + 1);
  const auto is_control = [](char c) { return c >= 0 && c < ' ' && c != '\t' && c != '\r'; };
  return says("control characters") && std::ranges::none_of(toml.substr(0, toml.find('\n')), is_control);
}

}  // namespace

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
  return inline_text(node);  // JSON has no dates and times: write them as text
}

toml::table parse_toml(std::string_view text, const std::string& name) {
  if (const auto at = find_deep_dotted_key(text); at != std::string_view::npos) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw InvalidInput(fmt::format("{}:{}: a key has more than {} parts", name, line, deepest_path));
  }
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    if (is_unclosed(text, error)) {
      throw InvalidInput(fmt::format("{}:{}:{}: not TOML: the text is not closed on line {}: its closing quote is missing", name,
                                     at.line, at.column, at.line));
    }
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
  // The TOML parser reads the path of a key, so that quotes have the same meaning as in a file.
  const std::string rule = "not a key path such as structure.length";
  std::vector<std::string> parts;
  try {
    const toml::table parsed = parse_toml(std::string(path) + " = 0", "");
    for (const toml::table* table = &parsed; table != nullptr;) {
      if (table->size() != 1) throw InvalidInput(rule);
      const auto first = table->begin();  // the iterator must live as long as the key, which it owns
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
}  // namespace softland
