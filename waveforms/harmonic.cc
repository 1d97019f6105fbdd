#include "waveforms/harmonic.h"

#include <fmt/format.h>

#include "base/require.h"
#include "waveforms/coincide.h"

namespace softland {

Signal signal(const Harmonic& harmonic) {
  const auto [base, amplitude, angular_frequency, phase, start, end, fade] = harmonic;
  require(std::isfinite(base), fmt::format("base of a harmonic is {} V; it must be finite", base));
  require(std::isfinite(amplitude), fmt::format("amplitude of a harmonic is {} V; it must be finite", amplitude));
  require(angular_frequency > 0 && std::isfinite(angular_frequency),
          fmt::format("angular_frequency of a harmonic is {} rad/s; it must be finite and > 0", angular_frequency));
  require(std::isfinite(phase), fmt::format("phase of a harmonic is {} rad; it must be finite", phase));
  require(start >= 0 && std::isfinite(start), fmt::format("start of a harmonic is {} s; it must be finite and >= 0", start));
  require(end > start, fmt::format("end of a harmonic is {} s; it must be after its start, {} s", end, start));
  require(fade >= 0 && std::isfinite(fade), fmt::format("fade of a harmonic is {} s; it must be finite and >= 0", fade));

  const bool ends = std::isfinite(end);
  double faded_in = start + fade;
  const double fading_out = ends ? end - fade : end;
  const bool meets = ends && internal::coincide(faded_in, fading_out);
  require(meets || faded_in < fading_out,
          fmt::format("fade of a harmonic is {} s; it must be at most half of end - start, {} s", fade, end - start));
  if (meets && fade > 0) faded_in = fading_out;
  if (amplitude == 0) return Signal::constant(base);

  std::vector<SignalPiece> pieces;
  if (start > 0) pieces.push_back({.begin = 0, .value = base});
  const auto add = [&](double begin, double envelope, double envelope_slope) {
    pieces.push_back({.begin = begin,
                      .value = base,
                      .amplitude = amplitude * envelope,
                      .amplitude_slope = amplitude * envelope_slope,
                      .angular_frequency = angular_frequency,
                      .phase = phase});
  };
  if (faded_in > start) add(start, 0, 1 / (faded_in - start));
  if (faded_in < fading_out) add(faded_in, 1, 0);
  if (ends) {
    if (fading_out < end) add(fading_out, 1, -1 / (end - fading_out));
    pieces.push_back({.begin = end, .value = base});
  }
  return Signal(std::move(pieces));
}

}  // namespace softland
