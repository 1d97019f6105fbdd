#include "waveforms/sines.h"

#include <fmt/format.h>

namespace softland {

Signal signal(const Sines& sines, double before) {
  const auto& [base, rise_time, amplitudes, start, duration] = sines;
  require_of("base", std::isfinite(base), [&] { return fmt::format("base of sines is {} V; it must be finite", base); });
  require_of("rise_time", rise_time >= 0 && std::isfinite(rise_time),
             [&] { return fmt::format("rise_time of sines is {} s; it must be finite and >= 0", rise_time); });
  require_of("amplitudes", !amplitudes.empty(), "amplitudes of sines must not be empty");
  for (std::size_t k = 0; k < amplitudes.size(); ++k) {
    require_of("amplitudes", std::isfinite(amplitudes[k]),
               [&] { return fmt::format("amplitude {} of sines is {} V; it must be finite", k + 1, amplitudes[k]); });
  }
  require_of("start", start >= 0 && std::isfinite(start),
             [&] { return fmt::format("start of sines is {} s; it must be finite and >= 0", start); });
  require_of("duration", start + duration > start && std::isfinite(start + duration),
             [&] { return fmt::format("duration of sines is {} s; it must be finite and > 0", duration); });
  return Signal(pieces(sines, before), before);
}

}  // namespace softland
