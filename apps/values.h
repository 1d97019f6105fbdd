// What was given to an option, as the value it stands for. Each throws InvalidInput that names option, value and rule.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "config/units.h"
#include "verbs/options.h"

namespace softland::apps {

template <class Number>
[[nodiscard]] Number whole_number(const char* option, const std::string& text, Number least) {
  return verbs::whole_number<Number>(option, text, {.least = static_cast<double>(least)});
}

/// Threads, one per core unless --jobs says how many.
[[nodiscard]] int job_count(const std::optional<std::string>& option);

/// `seed`, unless --seed says which.
[[nodiscard]] std::uint64_t seed_of(const std::optional<std::string>& option, std::uint64_t seed);

/// A quantity of this dimension, at least 0 [SI unit].
[[nodiscard]] double quantity_of(const char* option, const std::string& text, const Dimension& due);

}  // namespace softland::apps
