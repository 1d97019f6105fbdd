// A small checker of well-formed XML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace softland::test {

/// Returns the first fault of a text that must be one well-formed element: tags match, attributes are quoted and occur once,
/// entities are known. Empty if there is none.
inline std::string xml_fault(std::string_view text) {
  std::vector<std::string> open;
  bool root_closed = false;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '&') {
      const std::size_t end = text.find(';', at);
      const std::string_view name = end == std::string_view::npos ? "" : text.substr(at + 1, end - at - 1);
      if (name != "amp" && name != "lt" && name != "gt" && name != "quot" && name != "apos" && !name.starts_with('#')) {
        return "bad entity at " + std::string(text.substr(at, 20));
      }
      at = end + 1;
      continue;
    }
    if (text[at] != '<') {
      if (open.empty() && text[at] != '\n') return "text outside the root";
      ++at;
      continue;
    }
    if (root_closed) return "a second root";
    std::size_t end = at + 1;
    for (char quote = 0; end < text.size() && (quote != 0 || text[end] != '>'); ++end) {
      if (quote != 0 && text[end] == '<') return "< inside an attribute";
      if (text[end] == '"' || text[end] == '\'') quote = quote == 0 ? text[end] : quote == text[end] ? '\0' : quote;
    }
    if (end == text.size()) return "a tag does not end";
    std::string_view tag = text.substr(at + 1, end - at - 1);
    at = end + 1;
    if (tag.starts_with('/')) {
      if (open.empty() || open.back() != tag.substr(1))
        return "closes " + std::string(tag) + " while " + (open.empty() ? "nothing" : open.back()) + " is open";
      open.pop_back();
      root_closed = open.empty();
      continue;
    }
    const bool empty = tag.ends_with('/');
    if (empty) tag.remove_suffix(1);
    const std::size_t name_end = tag.find_first_of(" \n");
    std::string_view rest = name_end == std::string_view::npos ? "" : tag.substr(name_end);
    std::vector<std::string_view> attributes;
    while (rest.find_first_not_of(" \n") != std::string_view::npos) {
      rest.remove_prefix(rest.find_first_not_of(" \n"));
      const std::size_t equals = rest.find("=\"");
      const std::size_t close = equals == std::string_view::npos ? equals : rest.find('"', equals + 2);
      if (close == std::string_view::npos) return "bad attribute in " + std::string(tag.substr(0, 60));
      for (const std::string_view known : attributes) {
        if (known == rest.substr(0, equals)) return "attribute twice: " + std::string(known);
      }
      attributes.push_back(rest.substr(0, equals));
      rest.remove_prefix(close + 1);
    }
    if (!empty) open.emplace_back(tag.substr(0, name_end));
  }
  if (!open.empty()) return open.back() + " is not closed";
  return root_closed ? "" : "no root";
}

}  // namespace softland::test
