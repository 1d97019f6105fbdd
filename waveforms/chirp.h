// Chirp: a drive voltage with a sine on a step. Its frequency changes linearly in time, or its amplitude decays, or both.
//
//   V(t) = b(t) + amplitude e(t) exp(-s / decay_time) sin(phase + angular_frequency s + sweep s^2 / 2),  s = t - start
//
// for t in [start, end], b(t) elsewhere (t >= 0). b rises linearly to base on [0, rise_time], from the voltage before t = 0;
// the envelope e rises after start and falls before end as in harmonic.h. The frequency at the end is frequency_ratio times the
// frequency at the start: sweep = (frequency_ratio - 1) angular_frequency / (end - start). A chirp that never ends has a
// constant frequency and must decay.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "waveforms/harmonic.h"
#include "waveforms/parameter.h"
#include "waveforms/signal.h"

namespace softland {

template <class P>
struct ChirpOf {
  P base = 0;               ///< voltage of the step under the sine [V]
  P rise_time = 0;          ///< rise time of the step [s], >= 0
  P amplitude = 0;          ///< amplitude of the sine at its start [V]
  P angular_frequency = 0;  ///< angular frequency of the sine at its start [rad/s], > 0
  P frequency_ratio = 1;    ///< frequency of the sine at its end over that at its start, > 0
  P phase = 0;              ///< phase of the sine at its start [rad]
  P start = 0;              ///< time at which the sine starts [s], >= 0
  /// Time at which the sine ends [s], > start; a finite end needs end - start >= 2 fade.
  P end = std::numeric_limits<double>::infinity();
  P fade = 0;                                              ///< rise time and fall time of the sine's envelope [s], >= 0
  P decay_time = std::numeric_limits<double>::infinity();  ///< time in which the amplitude falls by a factor e [s], > 0
};
using Chirp = ChirpOf<double>;

template <>
struct FamilyOf<Chirp> {
  static constexpr std::string_view name = "chirp";
  static constexpr auto parameters = std::to_array<Parameter<Chirp>>({
      {"base", ParameterKind::level, &Chirp::base, false, "mean level of the sine"},
      {"rise_time", ParameterKind::time, &Chirp::rise_time, false, "linear rise of the base from `before`"},
      {"amplitude", ParameterKind::swing, &Chirp::amplitude, true,
       "amplitude at the start, or a percentage of the base; for the piezo, of the hold voltage of the main electrode"},
      {"angular_frequency", ParameterKind::angular_frequency, &Chirp::angular_frequency, true, "of the sine at the start"},
      {"frequency_ratio", ParameterKind::ratio, &Chirp::frequency_ratio, false,
       "frequency at the end over that at the start, steady in between; must be 1 without end"},
      {"phase", ParameterKind::angle, &Chirp::phase, false, "of the sine at the start"},
      {"start", ParameterKind::time, &Chirp::start, false, "when the sine begins"},
      {"end", ParameterKind::end_time, &Chirp::end, false, "when the sine ends, after start; absent: never"},
      {"fade", ParameterKind::time, &Chirp::fade, false,
       "linear fade in after start and out before end, at most half of the time between them"},
      {"decay_time", ParameterKind::end_time, &Chirp::decay_time, false,
       "time in which the amplitude falls by 1/e; absent: constant amplitude, which needs end"},
  });
  [[nodiscard]] static Chirp example() {
    return {.base = 1,
            .rise_time = 0.5,
            .amplitude = 2,
            .angular_frequency = 3,
            .frequency_ratio = 0.4,
            .phase = 0.3,
            .start = 1,
            .end = 9,
            .fade = 2,
            .decay_time = 3};
  }
};

/// Returns the signal pieces of a valid chirp; its base rises from `before` [V].
template <class P>
[[nodiscard]] Pieces<P> pieces(const ChirpOf<P>& chirp, const P& before = P(0)) {
  using std::cos, std::exp, std::sin;
  // A harmonic waveform gives the pieces with base and envelope. Its sine is replaced by a term with sweep and decay.
  Pieces<P> all = pieces(HarmonicOf<P>{.base = chirp.base,
                                       .rise_time = chirp.rise_time,
                                       .amplitude = chirp.amplitude,
                                       .angular_frequency = chirp.angular_frequency,
                                       .start = chirp.start,
                                       .end = chirp.end,
                                       .fade = chirp.fade},
                         before);
  const bool ends = internal::decided(chirp.end < P(std::numeric_limits<double>::infinity()));
  const P sweep = ends ? (chirp.frequency_ratio - P(1)) * chirp.angular_frequency / (chirp.end - chirp.start) : P(0);
  const P decay = P(1) / chirp.decay_time;
  for (SignalPieceOf<P>& piece : all) {
    const bool is_inside = !internal::decided(piece.begin < chirp.start) && internal::decided(piece.begin < chirp.end);
    const P amplitude = piece.amplitude, amplitude_slope = piece.amplitude_slope;
    piece.amplitude = piece.amplitude_slope = piece.angular_frequency = piece.phase = P(0);
    if (!is_inside) continue;
    const P since = piece.begin - chirp.start, left = exp(P(0) - decay * since);
    const P angle = chirp.phase + (chirp.angular_frequency + P(0.5) * sweep * since) * since;
    const P at_begin = amplitude * left, later = amplitude_slope * left;
    piece.terms.push_back({.cosine = {at_begin * sin(angle), later * sin(angle), P(0), P(0)},
                           .sine = {at_begin * cos(angle), later * cos(angle), P(0), P(0)},
                           .decay = decay,
                           .angular_frequency = chirp.angular_frequency + sweep * since,
                           .sweep = sweep});
  }
  return all;
}
/// Compiles the chirp to a voltage signal. Throws InvalidParameter for an invalid chirp.
[[nodiscard]] Signal signal(const Chirp& chirp, double before = 0);

}  // namespace softland
