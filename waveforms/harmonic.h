// Harmonic: a drive voltage with a sine on a step,  V(t) = b(t) + amplitude e(t) sin(angular_frequency t + phase)  for t in
// [start, end], b(t) elsewhere (t >= 0). b rises linearly to base on [0, rise_time], from the voltage before t = 0. The
// envelope e rises linearly from 0 to 1 on [start, start + fade] and falls from 1 to 0 on [end - fade, end]; with fade = 0 the
// sine starts and ends abruptly.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <vector>

#include "waveforms/parameter.h"
#include "waveforms/signal.h"

namespace softland {

template <class P>
struct HarmonicOf {
  P base = 0;               ///< voltage of the step under the sine [V]
  P rise_time = 0;          ///< rise time of the step [s], >= 0
  P amplitude = 0;          ///< amplitude of the sine [V]
  P angular_frequency = 0;  ///< angular frequency of the sine [rad/s], > 0
  P phase = 0;              ///< phase of the sine [rad]
  P start = 0;              ///< start of the sine [s], >= 0
  /// Time at which the sine ends [s], > start; a finite end needs end - start >= 2 fade.
  P end = std::numeric_limits<double>::infinity();
  P fade = 0;  ///< rise time and fall time of the sine's envelope [s], >= 0
};
using Harmonic = HarmonicOf<double>;

template <>
struct FamilyOf<Harmonic> {
  static constexpr std::string_view name = "harmonic";
  static constexpr auto parameters = std::to_array<Parameter<Harmonic>>({
      {"base", ParameterKind::level, &Harmonic::base, false, "mean level of the sine"},
      {"rise_time", ParameterKind::time, &Harmonic::rise_time, false, "linear rise of the base from `before`"},
      {"amplitude", ParameterKind::swing, &Harmonic::amplitude, true,
       "amplitude, or a percentage of the base; for the piezo, of the hold voltage of the main electrode"},
      {"angular_frequency", ParameterKind::angular_frequency, &Harmonic::angular_frequency, true, "of the sine"},
      {"phase", ParameterKind::angle, &Harmonic::phase, false,
       "phase of the sine at t = 0: it is sin(angular_frequency t + phase)"},
      {"start", ParameterKind::time, &Harmonic::start, false, "when the sine begins"},
      {"end", ParameterKind::end_time, &Harmonic::end, false, "when the sine ends, after start; absent: never"},
      {"fade", ParameterKind::time, &Harmonic::fade, false,
       "linear fade in after start and out before end, at most half of the time between them"},
  });
  [[nodiscard]] static Harmonic example() {
    return {.base = 1, .rise_time = 0.5, .amplitude = 2, .angular_frequency = 3, .phase = 0.3, .start = 1, .end = 9, .fade = 2};
  }
};

namespace internal {

/// Returns the envelope of the sine (rise from 0 to 1, constant, fall to 0) as a piecewise linear function of time.
template <class P>
[[nodiscard]] std::vector<StraightPart<P>> envelope(const HarmonicOf<P>& h) {
  const bool ends = decided(h.end < std::numeric_limits<double>::infinity());
  P faded_in = h.start + h.fade;
  const P fading_out = ends ? h.end - h.fade : h.end;
  if (ends && decided(h.fade > 0) && coincide(faded_in, fading_out)) faded_in = fading_out;
  std::vector<StraightPart<P>> line;
  if (decided(h.start > 0)) line.push_back({.begin = P(0)});
  if (decided(faded_in > h.start)) line.push_back({.begin = h.start, .value = P(0), .slope = P(1) / (faded_in - h.start)});
  if (decided(faded_in < fading_out)) line.push_back({.begin = faded_in, .value = P(1)});
  if (ends && decided(fading_out < h.end)) {
    line.push_back({.begin = fading_out, .value = P(1), .slope = P(-1) / (h.end - fading_out)});
  }
  if (ends) line.push_back({.begin = h.end});
  return line;
}

}  // namespace internal

/// Returns the signal pieces of a valid harmonic waveform; its base rises from `before` [V].
template <class P>
[[nodiscard]] Pieces<P> pieces(const HarmonicOf<P>& h, const P& before = P(0)) {
  const std::vector<internal::StraightPart<P>> envelope = internal::envelope(h);
  std::vector<P> begins;
  for (const internal::StraightPart<P>& part : envelope) begins.push_back(part.begin);
  // Compute the ramp of the base in volts with one division. A slope that is rounded twice would not end exactly on the base
  // voltage, and the difference would count as a jump.
  std::vector<internal::StraightPart<P>> straight_line{{.begin = P(0), .value = h.base}};
  if (!(internal::vanishes(h.base) && internal::vanishes(before)) && internal::decided(h.rise_time > 0)) {
    const auto same = std::find_if(begins.begin(), begins.end(), [&](const P& t) { return internal::coincide(t, h.rise_time); });
    const P risen = same == begins.end() ? h.rise_time : *same;
    straight_line = {{.begin = P(0), .value = before, .slope = (h.base - before) / risen}, {.begin = risen, .value = h.base}};
    const auto later = [&](const P& begin) { return internal::decided(begin > risen); };
    if (same == begins.end()) begins.insert(std::find_if(begins.begin(), begins.end(), later), risen);
  }
  Pieces<P> all;
  for (const P& begin : begins) {
    const internal::StraightPart<P>& straight = internal::part_at(straight_line, begin);
    const internal::StraightPart<P>& swing = internal::part_at(envelope, begin);
    all.push_back({.begin = begin, .value = straight.at(begin), .slope = straight.slope});
    // Leave out the sine where its envelope is 0.
    if (!internal::decided(swing.value > 0) && !internal::decided(swing.slope > 0)) continue;
    all.back().amplitude = h.amplitude * swing.at(begin);
    all.back().amplitude_slope = h.amplitude * swing.slope;
    all.back().angular_frequency = h.angular_frequency;
    all.back().phase = h.phase;
  }
  return all;
}
/// Compiles the harmonic waveform to a voltage signal. Throws InvalidParameter for an invalid harmonic.
[[nodiscard]] Signal signal(const Harmonic& harmonic, double before = 0);

namespace internal {

/// Checks the parameters of a waveform that is a sine on a step; `what` is the waveform's name in messages. Throws
/// InvalidParameter for an invalid parameter.
void require_dither(std::string_view what, const Harmonic& harmonic);

}  // namespace internal

}  // namespace softland
