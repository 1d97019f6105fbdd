// Converts the signals of drives to pieces for closings in SIMD lanes; a smooth signal replaces a finely sampled and filtered
// signal.
#pragma once

#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "model/ensemble/lane_closing.h"
#include "waveforms/signal.h"

namespace softland::simd {

/// Returns true when SIMD lanes support a signal: it consists of straight lines, steady sines, cubic polynomials and a few
/// exponentials.
[[nodiscard]] bool goes_in_lanes(const Signal& drive);

/// Returns the pieces, for SIMD lanes, of a signal for which goes_in_lanes() is true.
[[nodiscard]] std::vector<LanePiece> pieces_of(const Signal& drive);

/// Pieces of a drive signal in which a moving average replaces each sequence of short pieces. Such a sequence arises when a
/// filter with a time constant longer than a sample smooths a sampled signal. A switch of lower frequencies cannot follow the
/// ripple of the samples, yet each piece has a breakpoint. The average preserves the integral of the voltage, and its pieces
/// join with their slopes, so that integration steps pass over their ends.
struct SmoothedDrive {
  std::vector<LanePiece> pieces = {};
  double window = 0;  ///< longest window of a moving average, the duration of two samples [s]; 0 without an average
};
[[nodiscard]] SmoothedDrive smoothed(std::vector<LanePiece> exact);

/// The signal pieces of drives for closings in SIMD lanes, computed once however many switches a drive closes.
class LaneDrives {
 public:
  [[nodiscard]] bool go_in_lanes(std::span<const Signal> drives);
  /// Returns the signal pieces of a drive for a switch whose modes have angular frequencies up to `fastest` [rad/s].
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
