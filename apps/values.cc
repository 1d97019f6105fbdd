#include "apps/values.h"

#include <algorithm>
#include <thread>

#include "config/told_quantity.h"

namespace softland::apps {

int job_count(const std::optional<std::string>& option) {
  return option ? whole_number("--jobs", *option, 1) : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

std::uint64_t sample_count(const std::optional<std::string>& option, std::uint64_t samples, std::uint64_t least,
                           std::uint64_t most) {
  if (option) samples = whole_number("--samples", *option, least);
  require(samples <= most, [&] { return fmt::format("--samples {}: must be at most {}", samples, most); });
  return samples;
}

std::uint64_t seed_of(const std::optional<std::string>& option, std::uint64_t seed) {
  return option ? whole_number<std::uint64_t>("--seed", *option, 0) : seed;
}

PointSet point_set(const std::string& option) {
  const auto* row = find_named(point_sets, option);
  require(row != nullptr, [&] { return fmt::format("--points {}: must be {}", option, listed(point_sets)); });
  return row->value;
}

double quantity_of(const char* option, const std::string& text, const Dimension& due) { return told_quantity(option, text, due); }

}  // namespace softland::apps
