#include "waveforms/harmonic.h"

#include <fmt/format.h>

namespace softland {
namespace internal {

void require_dither(std::string_view what, const Harmonic& harmonic) {
  const auto [base, rise_time, amplitude, angular_frequency, phase, start, end, fade] = harmonic;
  require_of("base", std::isfinite(base), [&] { return fmt::format("base of {} is {} V; it must be finite", what, base); });
  require_of("rise_time", rise_time >= 0 && std::isfinite(rise_time),
             [&] { return fmt::format("rise_time of {} is {} s; it must be finite and >= 0", what, rise_time); });
  require_of("amplitude", std::isfinite(amplitude),
             [&] { return fmt::format("amplitude of {} is {} V; it must be finite", what, amplitude); });
  require_of("angular_frequency", angular_frequency > 0 && std::isfinite(angular_frequency), [&] {
    return fmt::format("angular_frequency of {} is {} rad/s; it must be finite and > 0", what, angular_frequency);
  });
  require_of("phase", std::isfinite(phase), [&] { return fmt::format("phase of {} is {} rad; it must be finite", what, phase); });
  require_of("start", start >= 0 && std::isfinite(start),
             [&] { return fmt::format("start of {} is {} s; it must be finite and >= 0", what, start); });
  require_of("end", end > start,
             [&] { return fmt::format("end of {} is {} s; it must be after its start, {} s", what, end, start); });
  require_of("fade", fade >= 0 && std::isfinite(fade),
             [&] { return fmt::format("fade of {} is {} s; it must be finite and >= 0", what, fade); });

  const bool meets = std::isfinite(end) && coincide(start + fade, end - fade);
  require_of("fade", meets || !std::isfinite(end) || start + fade < end - fade, [&] {
    return fmt::format("fade of {} is {} s; it must be at most half of end - start, {} s", what, fade, end - start);
  });
}

}  // namespace internal

Signal signal(const Harmonic& harmonic, double before) {
  internal::require_dither("a harmonic", harmonic);
  if (harmonic.amplitude == 0) return Signal::piecewise_linear({{0, before}, {harmonic.rise_time, harmonic.base}}, before);
  return Signal(pieces(harmonic, before), before);
}

}  // namespace softland
