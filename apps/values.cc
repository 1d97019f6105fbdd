#include "apps/values.h"

#include "config/told_quantity.h"

namespace softland::apps {

int job_count(const std::optional<std::string>& option) {
  return option ? whole_number("--jobs", *option, 1) : verbs::one_per_core();
}

std::uint64_t seed_of(const std::optional<std::string>& option, std::uint64_t seed) {
  return option ? whole_number<std::uint64_t>("--seed", *option, 0) : seed;
}

double quantity_of(const char* option, const std::string& text, const Dimension& due) { return told_quantity(option, text, due); }

}  // namespace softland::apps
