// Sines waveform: a band-limited voltage on a step, the sum of sines that are all 0 at their common start and end.
//
//   V(t) = b(t) + sum over k = 1 ... N of amplitudes_k sin(k pi (t - start) / duration)
//
// for t in [start, start + duration], b(t) elsewhere (t >= 0). b rises linearly to base on [0, rise_time], from the voltage
// before t = 0. The highest frequency is N / (2 duration).
#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <vector>

#include "waveforms/harmonic.h"
#include "waveforms/parameter.h"
#include "waveforms/signal.h"

namespace softland {

template <class P>
struct SinesOf {
  P base = 0;                      ///< voltage of the step under the sines [V]
  P rise_time = 0;                 ///< rise time of the step [s], >= 0
  std::vector<P> amplitudes = {};  ///< amplitudes of the sines [V], at least one
  P start = 0;                     ///< common start of the sines [s], >= 0
  P duration = 0;                  ///< time from the common start to the common end of the sines [s], > 0
};
using Sines = SinesOf<double>;

template <>
struct FamilyOf<Sines> {
  static constexpr std::string_view name = "sines";
  static constexpr auto parameters = std::to_array<Parameter<Sines>>({
      {"base", ParameterKind::level, &Sines::base, false, "mean level of the sines"},
      {"rise_time", ParameterKind::time, &Sines::rise_time, false, "linear rise of the base from `before`"},
      {"amplitudes", ParameterKind::swing, &Sines::amplitudes, true,
       "amplitudes of the sines of 1, 2, 3 ... half waves, or percentages of the base; "
       "for the piezo, of the hold voltage of the main electrode"},
      {"start", ParameterKind::time, &Sines::start, false, "when the sines begin"},
      {"duration", ParameterKind::time, &Sines::duration, true, "duration of the sines, all of which are 0 at both ends; > 0"},
  });
  [[nodiscard]] static Sines example() {
    return {.base = 1, .rise_time = 0.5, .amplitudes = {2, 0, -1}, .start = 0.3, .duration = 6};
  }
};

/// Returns the signal pieces of a valid Sines waveform, whose base rises from `before` [V].
template <class P>
[[nodiscard]] Pieces<P> pieces(const SinesOf<P>& sines, const P& before = P(0)) {
  const P end = sines.start + sines.duration;
  // A harmonic waveform without a sine gives the rising base voltage.
  Pieces<P> all = pieces(HarmonicOf<P>{.base = sines.base,
                                       .rise_time = sines.rise_time,
                                       .amplitude = P(1),
                                       .angular_frequency = P(1),
                                       .start = sines.start,
                                       .end = end},
                         before);
  for (SignalPieceOf<P>& piece : all) {
    piece.amplitude = piece.amplitude_slope = piece.angular_frequency = piece.phase = P(0);
    if (internal::decided(piece.begin < sines.start) || !internal::decided(piece.begin < end)) continue;
    piece.is_series = true;
    for (std::size_t k = 0; k < sines.amplitudes.size(); ++k) {
      using std::cos, std::sin;
      const P omega = P(static_cast<double>(k + 1) * std::numbers::pi) / sines.duration;
      const P angle = omega * (piece.begin - sines.start), amplitude = sines.amplitudes[k];
      piece.terms.push_back({.cosine = {amplitude * sin(angle), P(0), P(0), P(0)},
                             .sine = {amplitude * cos(angle), P(0), P(0), P(0)},
                             .angular_frequency = omega});
    }
  }
  return all;
}
/// Compiles the Sines waveform to a voltage signal. Throws InvalidParameter for an invalid waveform.
[[nodiscard]] Signal signal(const Sines& sines, double before = 0);

}  // namespace softland
