#include "waveforms/harmonic.h"

#include <fmt/format.h>

namespace softland {
Signal signal(const Harmonic& harmonic) {
  const auto [base, rise_time, amplitude, angular_frequency, phase, start, end, fade] = harmonic;
  require_of("base", std::isfinite(base), fmt::format("base of a harmonic is {} V; it must be finite", base));
  require_of("rise_time", rise_time >= 0 && std::isfinite(rise_time),
             fmt::format("rise_time of a harmonic is {} s; it must be finite and >= 0", rise_time));
  require_of("amplitude", std::isfinite(amplitude), fmt::format("amplitude of a harmonic is {} V; it must be finite", amplitude));
  require_of("angular_frequency", angular_frequency > 0 && std::isfinite(angular_frequency),
             fmt::format("angular_frequency of a harmonic is {} rad/s; it must be finite and > 0", angular_frequency));
  require_of("phase", std::isfinite(phase), fmt::format("phase of a harmonic is {} rad; it must be finite", phase));
  require_of("start", start >= 0 && std::isfinite(start),
             fmt::format("start of a harmonic is {} s; it must be finite and >= 0", start));
  require_of("end", end > start, fmt::format("end of a harmonic is {} s; it must be after its start, {} s", end, start));
  require_of("fade", fade >= 0 && std::isfinite(fade),
             fmt::format("fade of a harmonic is {} s; it must be finite and >= 0", fade));

  const bool meets = std::isfinite(end) && internal::coincide(start + fade, end - fade);
  require_of("fade", meets || !std::isfinite(end) || start + fade < end - fade,
             fmt::format("fade of a harmonic is {} s; it must be at most half of end - start, {} s", fade, end - start));
  if (amplitude == 0) return Signal::piecewise_linear({{0, 0}, {rise_time, base}});
  return Signal(pieces(harmonic));
}

}  // namespace softland
