#include "waveforms/pulse.h"

#include <fmt/format.h>

namespace softland {

namespace internal {

void require_levels_and_edges(std::string_view what, const std::vector<double>& levels, const std::vector<double>& times,
                              double edge) {
  const std::size_t count = levels.size();
  require_of("levels", count >= 1, [&] { return fmt::format("levels of {} must not be empty", what); });
  require_of("times", times.size() + 1 == count, [&] {
    return fmt::format("times of {} are {} for {} levels; there must be one fewer than levels", what, times.size(), count);
  });
  require_of("edge", edge >= 0 && std::isfinite(edge),
             [&] { return fmt::format("edge of {} is {} s; it must be finite and >= 0", what, edge); });
  for (std::size_t k = 0; k < count; ++k) {
    require_of("levels", std::isfinite(levels[k]),
               [&] { return fmt::format("level {} of {} is {} V; it must be finite", k + 1, what, levels[k]); });
  }

  double edge_end = edge;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double time = times[k];
    require_of("times", std::isfinite(time),
               [&] { return fmt::format("time {} of {} is {} s; it must be finite", k + 1, what, time); });
    const bool meets = coincide(edge_end, time);
    require_of("times", meets || time > edge_end, [&] {
      return fmt::format("time {} of {} is {} s; it must be at least {} s, when the edge before it ends", k + 1, what, time,
                         edge_end);
    });
    edge_end = time + edge;
  }
}

}  // namespace internal

Signal signal(const Pulse& pulse, double before) {
  internal::require_levels_and_edges("a pulse", pulse.levels, pulse.times, pulse.edge);
  return Signal::piecewise_linear(points(pulse, before), before);
}

}  // namespace softland
