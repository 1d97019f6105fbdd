#include "verbs/options.h"

#include <thread>

namespace softland::verbs {

std::string keyword_of(std::string_view name) {
  std::string keyword(name);
  std::ranges::replace(keyword, '-', '_');
  return keyword;
}

std::string_view unit_of(const Dimension& dimension) {
  if (dimension == dimension::velocity) return "m/s";
  if (dimension == dimension::time) return "s";
  if (dimension == dimension::voltage) return "V";
  return "";
}

double OptionReader::quantity_of(const char* name, const std::string& text, const Wanted& wanted) const {
  const auto rule = [&](bool ok) {
    require_request(ok, [&] { return fmt::format("{} {}: must be {}", requested(name), visible(text), wanted.rule); });
  };
  Quantity q;
  try {
    q = parse_quantity(text);
  } catch (const InvalidInput&) {
    rule(false);
  }
  rule(q.dimension == wanted.dimension && wanted.range.contains(q.value));
  return q.value;
}

int one_per_core() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

}  // namespace softland::verbs
