#include "apps/stores.h"

#include <fmt/format.h>

#include "reports/made_with.h"

namespace softland::apps {

StoredOrigin origin_of(const Common& common) {
  const MadeWith& m = made_with();
  return {.program = m.program,
          .processor = fmt::format("{}, {}, {}, {}", m.processor, m.instruction_set, m.vectors, m.c_library),
          .command = common.command};
}

std::string duration_words(double seconds) {
  constexpr double minute = 60, hour = 3600, day = 86400;
  if (seconds < 2 * minute) return fmt::format("{:.0f}\u00a0s", seconds);
  if (seconds < 2 * hour) return fmt::format("{:.0f}\u00a0min", seconds / minute);
  return seconds < 2 * day ? fmt::format("{:.1f}\u00a0h", seconds / hour) : fmt::format("{:.1f}\u00a0days", seconds / day);
}

}  // namespace softland::apps
