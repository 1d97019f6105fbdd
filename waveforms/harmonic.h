// Harmonic dither on a step:  V(t) = b(t) + amplitude e(t) sin(angular_frequency t + phase)  for t in [start, end], b(t)
// elsewhere (t >= 0). b rises linearly from 0 to base on [0, rise_time]. The envelope e rises linearly from 0 to 1 on
// [start, start + fade] and falls from 1 to 0 on [end - fade, end]; fade = 0 is a hard switch.
#pragma once

#include <array>
#include <limits>

#include "waveforms/parameter.h"
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

template <>
struct FamilyOf<Harmonic> {
  static constexpr std::string_view name = "harmonic";
  static constexpr auto parameters = std::to_array<Parameter<Harmonic>>({
      {"base", Meaning::level, &Harmonic::base, false, "what the sine swings about"},
      {"rise_time", Meaning::time, &Harmonic::rise_time, false, "linear rise of the base from 0 V"},
      {"amplitude", Meaning::swing, &Harmonic::amplitude, true,
       "or a percentage of the base; for the piezo, of the main hold level"},
      {"angular_frequency", Meaning::angular_frequency, &Harmonic::angular_frequency, true, "of the sine"},
      {"phase", Meaning::angle, &Harmonic::phase, false, "of the sine at t = 0"},
      {"start", Meaning::time, &Harmonic::start, false, "when the sine begins"},
      {"end", Meaning::end_time, &Harmonic::end, false, "when the sine ends; absent: never"},
      {"fade", Meaning::time, &Harmonic::fade, false, "linear fade in after start and out before end"},
  });
};

[[nodiscard]] Signal signal(const Harmonic& harmonic);

}  // namespace softland
