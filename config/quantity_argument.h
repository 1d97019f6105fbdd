// Reads a quantity, such as "2 us", that a command-line option gives.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "base/require.h"
#include "base/shortened.h"
#include "config/units.h"

namespace softland {

/// Reads a quantity that should have the dimension `due`. Throws InvalidInput as parse_quantity() does, and for a missing unit;
/// the caller checks any other dimension.
[[nodiscard]] inline Quantity quantity_with_unit(std::string_view text, const Dimension& due) {
  const Quantity read = parse_quantity(text);
  require(read.dimension != dimension::none || due == dimension::none || text.find('%') != std::string_view::npos,
          [&] { return fmt::format("no unit (expected {} such as \"{}\")", noun(due), example(due)); });
  return read;
}

/// Reads a quantity of this dimension, at least 0 [SI unit]. Throws InvalidRequest that names the option `what`, such as
/// requested("marker"), the text and the rule.
[[nodiscard]] inline double quantity_argument(std::string_view what, const std::string& text, const Dimension& due) {
  Quantity given;
  try {
    given = quantity_with_unit(text, due);
  } catch (const InvalidInput& error) {
    throw InvalidRequest(fmt::format("{} {}: {}", what, visible(text), error.what()));
  }
  require_request(given.dimension == due && given.value >= 0, [&] {
    return fmt::format("{} {}: must be {}, at least 0, such as \"{}\"", what, visible(text), describe(due),
                       due == dimension::none ? "0.5 %" : example(due));
  });
  return given.value;
}

}  // namespace softland
