#include "waveforms/chirp.h"

#include <fmt/format.h>

namespace softland {

Signal signal(const Chirp& chirp, double before) {
  internal::require_dither("a chirp", {.base = chirp.base,
                                       .rise_time = chirp.rise_time,
                                       .amplitude = chirp.amplitude,
                                       .angular_frequency = chirp.angular_frequency,
                                       .phase = chirp.phase,
                                       .start = chirp.start,
                                       .end = chirp.end,
                                       .fade = chirp.fade});
  const double ratio = chirp.frequency_ratio;
  require_of("frequency_ratio", ratio > 0 && std::isfinite(ratio),
             [&] { return fmt::format("frequency_ratio of a chirp is {}; it must be finite and > 0", ratio); });
  require_of("decay_time", chirp.decay_time > 0,
             [&] { return fmt::format("decay_time of a chirp is {} s; it must be > 0", chirp.decay_time); });
  if (!std::isfinite(chirp.end)) {
    require_of("frequency_ratio", ratio == 1, [&] {
      return fmt::format(
          "frequency_ratio of a chirp is {}; it must be 1 for a chirp without an end, "
          "whose frequency is constant",
          ratio);
    });
    require_of("decay_time", std::isfinite(chirp.decay_time),
               "a chirp must have an end or a decay_time; a sine without either is a harmonic");
  }
  if (chirp.amplitude == 0) return Signal::piecewise_linear({{0, before}, {chirp.rise_time, chirp.base}}, before);
  return Signal(pieces(chirp, before), before);
}

}  // namespace softland
