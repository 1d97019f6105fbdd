// What was given to an option, as the value it stands for. Each throws InvalidInput that names option, value and rule.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <system_error>

#include "base/require.h"
#include "base/shortened.h"
#include "config/units.h"

namespace softland::apps {

template <class Number>
[[nodiscard]] Number whole_number(const char* option, const std::string& text, Number least) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error != std::errc::result_out_of_range,
          fmt::format("{} {}: must be a whole number from {} to {}", option, text, least, std::numeric_limits<Number>::max()));
  require(error == std::errc() && end == text.data() + text.size() && value >= least,
          fmt::format("{} {}: must be a whole number from {} on", option, visible(text), least));
  return value;
}

/// Threads, one per core unless --jobs says how many.
[[nodiscard]] int job_count(const std::optional<std::string>& option);

/// `seed`, unless --seed says which.
[[nodiscard]] std::uint64_t seed_of(const std::optional<std::string>& option, std::uint64_t seed);

/// A quantity of this dimension, at least 0 [SI unit].
[[nodiscard]] double quantity_of(const char* option, const std::string& text, const Dimension& due);

}  // namespace softland::apps
