#include "waveforms/pulse.h"

#include <fmt/format.h>

namespace softland {

Signal signal(const Pulse& pulse) {
  const std::size_t count = pulse.levels.size();
  require_of("levels", count >= 1, "levels of a pulse are empty; there must be at least one");
  require_of(
      "times", pulse.times.size() + 1 == count,
      fmt::format("times of a pulse are {} for {} levels; there must be one fewer than levels", pulse.times.size(), count));
  require_of("edge", pulse.edge >= 0 && std::isfinite(pulse.edge),
             fmt::format("edge of a pulse is {} s; it must be finite and >= 0", pulse.edge));
  for (std::size_t k = 0; k < count; ++k) {
    require_of("levels", std::isfinite(pulse.levels[k]),
               fmt::format("level {} of a pulse is {} V; it must be finite", k + 1, pulse.levels[k]));
  }

  double edge_end = pulse.edge;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double time = pulse.times[k];
    require_of("times", std::isfinite(time), fmt::format("time {} of a pulse is {} s; it must be finite", k + 1, time));
    const bool meets = internal::coincide(edge_end, time);
    require_of("times", meets || time > edge_end,
               fmt::format("time {} of a pulse is {} s; it must be at least {} s, where the edge before it ends", k + 1, time,
                           edge_end));
    edge_end = time + pulse.edge;
  }
  return Signal::piecewise_linear(points(pulse));
}

}  // namespace softland
