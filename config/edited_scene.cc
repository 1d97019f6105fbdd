#include "config/edited_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "base/require.h"
#include "config/scene_file_impl.h"

namespace softland {
namespace {

using internal::toml_string;

// Converts line and column of a scene's text, which TOML counts from 1 and in characters, to an index in the text.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text), begins_{0} {
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') begins_.push_back(i + 1);
    }
  }
  [[nodiscard]] std::size_t place(const toml::source_position& at) const {
    std::size_t i = begins_[at.line - 1];
    if (i == 0 && text_.starts_with("\xEF\xBB\xBF")) i = 3;
    for (std::size_t column = 1; column < at.column && i < text_.size(); ++column) {
      ++i;
      while (i < text_.size() && (static_cast<unsigned char>(text_[i]) & 0xC0) == 0x80) ++i;
    }
    return i;
  }
  // Returns the index of the end of the line that contains the index `place`, before the line break.
  [[nodiscard]] std::size_t end(std::size_t place) const {
    std::size_t end = std::min(text_.find('\n', place), text_.size());
    if (end > place && text_[end - 1] == '\r') --end;
    return end;
  }

 private:
  std::string_view text_;
  std::vector<std::size_t> begins_;
};

// Returns the index behind the TOML number or quoted text that begins at index `begin`.
std::size_t end_of_value(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  if (quote == '"' || quote == '\'') {
    std::size_t i = begin + 1;
    while (i < text.size() && text[i] != quote) i += text[i] == '\\' && quote == '"' ? 2 : 1;
    return std::min(i + 1, text.size());
  }
  return std::min(text.find_first_of(",]}# \t\r\n", begin), text.size());
}

const toml::node* node_at(const toml::table& root, const std::vector<std::string>& path) {
  const toml::node* node = &root;
  for (const std::string& key : path) {
    const toml::table* table = node == nullptr ? nullptr : node->as_table();
    node = table == nullptr ? nullptr : internal::child_of(*table, key);
  }
  return node;
}

// Returns the new value of a key as text, in the unit of `written`, the value as the scene states it.
std::string in_unit_of(const std::string& written, const Quantity& value) {
  constexpr const char* number_begins = "0123456789.eE+-−_";
  std::size_t end = 0;
  while (end < written.size() && std::string_view(number_begins).find(written[end]) != std::string_view::npos) ++end;
  const std::size_t unit = written.find_first_not_of(' ', end);
  if (unit == std::string::npos) return fmt::format("{:.10g}", value.value);
  const std::string symbol = written.substr(unit);
  const Quantity one = parse_quantity("1 " + symbol);
  return fmt::format("{:.10g} {}", value.value / one.value, symbol);
}

struct Replacement {
  std::size_t begin = 0, end = 0;
  std::string text;
};

std::string replaced(std::string_view text, std::vector<Replacement> all) {
  std::stable_sort(all.begin(), all.end(), [](const Replacement& a, const Replacement& b) { return a.begin < b.begin; });
  std::string out;
  std::size_t at = 0;
  for (const Replacement& one : all) {
    out += text.substr(at, one.begin - at);
    out += one.text;
    at = one.end;
  }
  out += text.substr(at);
  return out;
}

}  // namespace

std::string edited_scene(std::string_view text, const std::string& name, const std::vector<SceneEdit>& edits) {
  const toml::table root = internal::parse_toml(text, name);
  const Lines lines(text);
  std::vector<Replacement> all;
  std::map<std::size_t, std::string> remarks;  // comments to add to lines of the scene, by the index of the line's end
  for (const SceneEdit& edit : edits) {
    const std::vector<std::string> path = internal::split_path(edit.path);
    const toml::node* node = node_at(root, path);
    if (node != nullptr && edit.element > 0)
      node = node->as_array() == nullptr ? nullptr : node->as_array()->get(edit.element - 1);
    if (node != nullptr) {
      const std::size_t begin = lines.place(node->source().begin), end = end_of_value(text, begin);
      const auto* words = node->as_string();
      const std::string was(text.substr(begin, end - begin));
      const std::string now =
          words != nullptr ? toml_string(in_unit_of(words->get(), edit.value)) : fmt::format("{:.10g}", edit.value.value);
      all.push_back({.begin = begin, .end = end, .text = now});
      if (!edit.remark.empty())
        remarks[lines.end(end)] += fmt::format("{}{}, was {}", remarks[lines.end(end)].empty() ? "" : "; ", edit.remark, was);
      continue;
    }
    require(edit.element == 0, [&] { return fmt::format("{}: {} must be a list", name, edit.path); });
    const std::vector<std::string> section(path.begin(), path.end() - 1);
    std::string header;
    for (const std::string& part : section) header = internal::join_path(header, part);
    const std::string line = fmt::format("{} = {}{}", internal::is_bare_key(path.back()) ? path.back() : toml_string(path.back()),
                                         toml_string(quantity_text(edit.value.value, edit.value.dimension)),
                                         edit.remark.empty() ? "" : "  # " + edit.remark);
    if (const toml::node* there = node_at(root, section); there != nullptr) {
      const std::size_t begin = lines.place(there->source().begin);
      require(there->is_table() && begin < text.size() && text[begin] == '[', [&] {
        return fmt::format("{}: [{}] must be written as a section with a header: a key cannot be added to an inline table", name,
                           header);
      });
      const std::size_t end = lines.end(begin);
      all.push_back({.begin = end, .end = end, .text = "\n" + line});
    } else {
      all.push_back({.begin = text.size(), .end = text.size(), .text = fmt::format("\n[{}]\n{}\n", header, line)});
    }
  }
  for (const auto& [end, words] : remarks) all.push_back({.begin = end, .end = end, .text = "  # " + words});
  return replaced(text, std::move(all));
}

namespace {

// Returns the range of a scene's text from a header of [spread] or [spread.NAME] to the next header of another section; none
// without such a header.
std::optional<std::pair<std::size_t, std::size_t>> spread_of(std::string_view text) {
  std::optional<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    const bool is_spread = line.starts_with("[spread]") || line.starts_with("[spread.");
    if (found && line.starts_with('[') && !is_spread) return std::pair{found->first, begin};
    if (!found && is_spread) found = {begin, text.size()};
    begin = end + 1;
  }
  return found;
}

}  // namespace

std::string with_spread_of(std::string_view text, const std::string& name, const SceneFile& other) {
  const std::string whole = other.text();
  const auto theirs = spread_of(whole);
  require(theirs.has_value(), [&] { return fmt::format("{}: the scene must have a section [spread]", other.name()); });
  const std::string section = whole.substr(theirs->first, theirs->second - theirs->first);
  const toml::table root = internal::parse_toml(text, name);
  if (!root.contains("spread")) return fmt::format("{}\n{}", text, section);
  const auto own = spread_of(text);
  require(own.has_value(), [&] { return fmt::format("{}: spread must be written as a section with a header", name); });
  return replaced(text, {{.begin = own->first, .end = own->second, .text = section + (own->second < text.size() ? "\n" : "")}});
}

}  // namespace softland
