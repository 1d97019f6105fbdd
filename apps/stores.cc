#include "apps/stores.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "apps/streams.h"
#include "base/require.h"
#include "document/quantity.h"
#include "reports/origin.h"

namespace softland::apps {

void tell_of_other_programs(const std::string& store) {
  if (!is_store(store)) return;
  const std::vector<StoredSession> sessions = StudyReader(store).sessions();
  const StoredOrigin ours = stored_origin({});
  const auto is_other = [&](const StoredSession& s) { return s.program != ours.program || s.processor != ours.processor; };
  const auto other = std::find_if(sessions.begin(), sessions.end(), is_other);
  if (other == sessions.end()) return;
  print_note(fmt::format("{}: some rows were computed by {} on {}: their last digits may differ from those of {}", store,
                         other->program, other->host, ours.program));
}

std::string whole(std::int64_t count) { return internal::whole(static_cast<double>(count)); }

std::string duration_prose(double seconds) {
  constexpr double minute = 60, hour = 3600, day = 86400;
  if (seconds < 2 * minute) return fmt::format("{:.0f}\u00a0s", seconds);
  if (seconds < 2 * hour) return fmt::format("{:.0f}\u00a0min", seconds / minute);
  return seconds < 2 * day ? fmt::format("{:.1f}\u00a0h", seconds / hour) : fmt::format("{:.1f}\u00a0days", seconds / day);
}

}  // namespace softland::apps
