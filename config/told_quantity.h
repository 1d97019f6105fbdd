// A quantity that was told beside a scene, by an option.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "base/require.h"
#include "config/units.h"

namespace softland {

/// Of this dimension, at least 0 [SI unit]. Throws InvalidInput that names `what`, such as "--marker", the text and the rule.
[[nodiscard]] inline double told_quantity(std::string_view what, const std::string& text, const Dimension& due) {
  const std::string shown = text.empty() ? "''" : text;
  Quantity given;
  try {
    given = parse_quantity(text);
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("{} {}: {}", what, shown, error.what()));
  }
  require(given.dimension == due && given.value >= 0, [&] {
    return fmt::format("{} {}: must be {}, at least 0, such as \"{}\"", what, shown, describe(due),
                       due == dimension::none ? "0.5 %" : example(due));
  });
  return given.value;
}

}  // namespace softland
