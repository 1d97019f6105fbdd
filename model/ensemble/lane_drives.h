// Converts the signals of drives to pieces for closings in SIMD lanes. A signal that was finely sampled and then filtered is
// replaced by a smooth signal with fewer breakpoints.
#pragma once

#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "model/ensemble/lane_closing.h"
#include "waveforms/signal.h"

namespace softland::simd {

/// Returns true when closings in SIMD lanes support a signal: its pieces have straight lines, sines whose amplitude is constant
/// or changes linearly, cubic polynomials, and at most LanePiece::most_tails exponentials.
[[nodiscard]] bool goes_in_lanes(const Signal& drive);

/// Returns the pieces of a drive signal in the form for SIMD lanes; goes_in_lanes() must be true for the signal.
[[nodiscard]] std::vector<LanePiece> pieces_of(const Signal& drive);

/// Pieces of a drive signal in which a moving average replaces each sequence of short pieces. A sampled signal has such
/// sequences after a filter with a time constant longer than a sample. A switch whose modes are slow compared to the samples
/// cannot follow their ripple, but each piece would cost a breakpoint. The average preserves the integral of the voltage. Its
/// pieces join with equal slopes, so that integration steps may cross their ends.
struct SmoothedDrive {
  std::vector<LanePiece> pieces = {};
  double window = 0;  ///< longest window of a moving average [s]; 0 without an average
};
[[nodiscard]] SmoothedDrive smoothed(std::vector<LanePiece> exact);

/// The signal pieces of drives for closings in SIMD lanes, computed once for all switches with the same drive signals.
class LaneDrives {
 public:
  [[nodiscard]] bool go_in_lanes(std::span<const Signal> drives);
  /// Returns the signal pieces of a drive for a switch whose modes have angular frequencies up to `fastest` [rad/s]: smoothed
  /// pieces when the window of the moving average is shorter than 1 / `fastest`, exact pieces otherwise.
  [[nodiscard]] const std::vector<LanePiece>& of(const Signal& drive, double fastest);

 private:
  struct Known {
    std::vector<LanePiece> exact;
    SmoothedDrive smooth;
  };
  std::unordered_map<const Signal*, bool> go_;
  std::unordered_map<const Signal*, Known> known_;
};

}  // namespace softland::simd
