#include "verbs/options.h"

#include <thread>

#include "config/quantity_argument.h"

namespace softland::verbs {

std::string keyword_of(std::string_view name) {
  std::string keyword(name);
  std::ranges::replace(keyword, '-', '_');
  return keyword;
}

std::string spelled(std::string_view marked, const Spelling& spelling) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz-";
  constexpr char mark = '\x02', end_mark = '\x03';  // the marks that requested() sets around a name
  std::string text;
  for (std::size_t begin = 0; begin < marked.size();) {
    const std::size_t name = std::min(marked.find(mark, begin), marked.size());
    text += marked.substr(begin, name - begin);
    if (name == marked.size()) break;
    const std::size_t end = std::min(marked.find_first_not_of(letters, name + 1), marked.size());
    text += spelling(marked.substr(name + 1, end - name - 1));
    begin = end < marked.size() && marked[end] == end_mark ? end + 1 : end;
  }
  return text;
}

std::string spelled(const InvalidRequest& error, const Spelling& spelling) {
  // with_fields() leaves the start mark before each option name, but no end mark: spelled() accepts both forms.
  return spelled(error.with_fields("\x02"), spelling);
}

double OptionReader::quantity_of(const char* name, const std::string& text, const Wanted& wanted) const {
  if (wanted.rule.empty()) return quantity_argument(requested(name), text, wanted.dimension);
  const auto rule = [&](bool ok) {
    require_request(ok, [&] { return fmt::format("{} {}: must be {}", requested(name), visible(text), wanted.rule); });
  };
  Quantity q;
  try {
    q = quantity_with_unit(text, wanted.dimension);
  } catch (const InvalidInput& error) {
    rule(wanted.dimension != dimension::none);
    throw InvalidRequest(fmt::format("{} {}: {}", requested(name), visible(text), error.what()));
  }
  rule(q.dimension == wanted.dimension && wanted.range.contains(q.value));
  return q.value;
}

int one_per_core() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

}  // namespace softland::verbs
