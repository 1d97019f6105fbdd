// Harmonic dither on a step:  V(t) = b(t) + amplitude e(t) sin(angular_frequency t + phase)  for t in [start, end], b(t)
// elsewhere (t >= 0). b rises linearly from 0 to base on [0, rise_time]. The envelope e rises linearly from 0 to 1 on
// [start, start + fade] and falls from 1 to 0 on [end - fade, end]; fade = 0 is a hard switch.
#pragma once

#include <limits>

#include "waveforms/signal.h"

namespace softland {

struct Harmonic {
  double base = 0;                                       ///< [V]
  double rise_time = 0;                                  ///< of the base [s], >= 0
  double amplitude = 0;                                  ///< [V]
  double angular_frequency = 0;                          ///< [rad/s], > 0
  double phase = 0;                                      ///< [rad]
  double start = 0;                                      ///< [s], >= 0
  double end = std::numeric_limits<double>::infinity();  ///< [s], > start; a finite end needs end - start >= 2 fade
  double fade = 0;                                       ///< [s], >= 0
};

[[nodiscard]] Signal signal(const Harmonic& harmonic);

}  // namespace softland
