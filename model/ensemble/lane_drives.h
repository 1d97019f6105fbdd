// Drives as the lanes of fleet.h take them: numbers of pieces; a finely sampled and filtered signal becomes a smooth course.
#pragma once

#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "model/ensemble/lane_closing.h"
#include "waveforms/signal.h"

namespace softland::fleet {

/// True when a signal consists of straight lines, steady sines, cubic polynomials and a few exponentials.
[[nodiscard]] bool goes_in_lanes(const Signal& drive);

/// Returns the pieces of a signal that goes in lanes.
[[nodiscard]] std::vector<LanePiece> pieces_of(const Signal& drive);

/// Pieces whose runs of short ones are replaced by the mean over a window about each time. A run consists of the pieces between
/// samples that a filter with a longer time constant lets through. Their ripple is too small for a switch of lower frequencies
/// to follow, yet each has a breakpoint. The mean keeps the integral of a run; its pieces join with their slopes, so that steps
/// pass over them.
struct SmoothedDrive {
  std::vector<LanePiece> pieces = {};
  double window = 0;  ///< longest window, the pieces of two samples [s]; 0 without such runs
};
[[nodiscard]] SmoothedDrive smoothed(std::vector<LanePiece> exact);

/// The pieces of drives in lanes, found once however many switches a drive closes.
class LaneDrives {
 public:
  [[nodiscard]] bool go_in_lanes(std::span<const Signal> drives);
  /// Returns the pieces for a switch whose modes have angular frequencies up to `fastest` [rad/s].
  [[nodiscard]] const std::vector<LanePiece>& of(const Signal& drive, double fastest);

 private:
  struct Known {
    std::vector<LanePiece> exact;
    SmoothedDrive smooth;
  };
  std::unordered_map<const Signal*, bool> go_;
  std::unordered_map<const Signal*, Known> known_;
};

}  // namespace softland::fleet
