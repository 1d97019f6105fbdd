#include "config/aim.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "base/nearest.h"
#include "base/require.h"
#include "base/trimmed.h"

namespace softland {
namespace {

Target target_of(std::string_view name) {
  const TargetRow* row = find_named(targets, name);
  require(row != nullptr, [&] {
    return fmt::format("must be {}, or a weighted sum such as \"0.7 bounce + 0.3 energy\"{}", listed(targets),
                       did_you_mean(name, names_of(targets)));
  });
  return row->value;
}

}  // namespace

Aim parse_aim(std::string_view text) {
  if (text.find_first_of(" +") == std::string_view::npos) return target_of(text);
  std::vector<Aim::Part> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('+', begin), text.size());
    const std::string_view part = trimmed(text.substr(begin, end - begin));
    const std::size_t blank = part.find(' ');
    Aim::Part one{.target = Target::bounce};
    if (blank != std::string_view::npos) {
      const std::string_view number = part.substr(0, blank);
      const auto [rest, error] = std::from_chars(number.data(), number.data() + number.size(), one.weight);
      require(error == std::errc() && rest == number.data() + number.size(),
              [&] { return fmt::format("'{}' must be a weight and a target, such as 0.7 bounce", part); });
    }
    one.target = target_of(trimmed(blank == std::string_view::npos ? part : part.substr(blank)));
    parts.push_back(one);
    begin = end + 1;
  }
  return Aim(std::move(parts));
}

}  // namespace softland
