#include "waveforms/harmonic.h"

#include <fmt/format.h>

#include <algorithm>

#include "waveforms/coincide.h"

namespace softland {
namespace {

/// One stretch of a broken line: it holds until the next one begins.
struct Stretch {
  double begin = 0;  ///< [s]
  double value = 0;  ///< at begin
  double slope = 0;  ///< [1/s]

  [[nodiscard]] double at(double time) const { return value + slope * (time - begin); }
};

const Stretch& stretch_at(const std::vector<Stretch>& line, double time) {
  const auto after = std::upper_bound(line.begin() + 1, line.end(), time, [](double t, const Stretch& s) { return t < s.begin; });
  return *(after - 1);
}

}  // namespace

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

  const bool ends = std::isfinite(end);
  double faded_in = start + fade;
  const double fading_out = ends ? end - fade : end;
  const bool meets = ends && internal::coincide(faded_in, fading_out);
  require_of("fade", meets || faded_in < fading_out,
             fmt::format("fade of a harmonic is {} s; it must be at most half of end - start, {} s", fade, end - start));
  if (meets && fade > 0) faded_in = fading_out;
  if (amplitude == 0) return Signal::piecewise_linear({{0, 0}, {rise_time, base}});

  std::vector<Stretch> envelope;
  if (start > 0) envelope.push_back({.begin = 0});
  if (faded_in > start) envelope.push_back({.begin = start, .value = 0, .slope = 1 / (faded_in - start)});
  if (faded_in < fading_out) envelope.push_back({.begin = faded_in, .value = 1});
  if (ends && fading_out < end) envelope.push_back({.begin = fading_out, .value = 1, .slope = -1 / (end - fading_out)});
  if (ends) envelope.push_back({.begin = end});

  std::vector<double> begins;
  for (const Stretch& stretch : envelope) begins.push_back(stretch.begin);
  // In volts and by one division: a ramp whose slope is rounded twice ends beside the base, which would count as a jump.
  std::vector<Stretch> straight_line{{.begin = 0, .value = base}};
  if (base != 0 && rise_time > 0) {
    const auto same = std::find_if(begins.begin(), begins.end(), [&](double t) { return internal::coincide(t, rise_time); });
    const double risen = same == begins.end() ? rise_time : *same;
    straight_line = {{.begin = 0, .value = 0, .slope = base / risen}, {.begin = risen, .value = base}};
    if (same == begins.end()) begins.insert(std::upper_bound(begins.begin(), begins.end(), risen), risen);
  }

  std::vector<SignalPiece> pieces;
  for (const double begin : begins) {
    const Stretch& straight = stretch_at(straight_line, begin);
    const Stretch& swing = stretch_at(envelope, begin);
    pieces.push_back({.begin = begin, .value = straight.at(begin), .slope = straight.slope});
    if (swing.value == 0 && swing.slope == 0) continue;
    pieces.back().amplitude = amplitude * swing.at(begin);
    pieces.back().amplitude_slope = amplitude * swing.slope;
    pieces.back().angular_frequency = angular_frequency;
    pieces.back().phase = phase;
  }
  return Signal(std::move(pieces));
}

}  // namespace softland
