// Figures of merit with reliable errors, and clouds in the place of figures that have none.
//
// The figures are those of simulate(). Their errors are a multiple of the difference to the judging run, plus a hundredth of
// the tolerance for the common error of both. They are calibrated on random scenes (bench/certify_coverage.cc). Pull-in
// voltages in which drives are given are computed again with the judge's quadrature, and the figures' errors contain the effect
// of theirs. A figure is ill-conditioned if imperceptible changes of the drives move it visibly. It is then given as median and
// range over a cloud of runs, and its error reaches to the end of that range.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "studies/closing/cloud.h"
#include "studies/closing/simulate.h"

namespace softland {

/// The rebound at which the runs of a cloud part: up to it they have the same rebounds.
struct GrazingRebound {
  int number = 0;              ///< counted from 1, all rebounds of the first run
  double time = 0;             ///< begin of the rebound [s]
  double height = 0;           ///< [m]
  double impact_velocity = 0;  ///< velocity of the touch before it [m/s]
  bool at_threshold = false;   ///< it counts in some runs only; else the touch before it is the gentlest of all until then
};

struct IllConditioned {
  Figure figure;
  Spread spread;
};

struct Certificate {
  std::vector<IllConditioned> ill_conditioned;
  std::optional<GrazingRebound> grazing;  ///< none if the runs do not part at a rebound
  int runs = 0;
};

/// Factor of the difference to the better run.
inline constexpr double error_safety = 3;

/// Returns the first rebound in which runs differ, with the cause of the difference; none if they do not differ.
[[nodiscard]] std::optional<GrazingRebound> grazing_rebound(std::span<const Trajectory> runs, const MetricsOptions& options);

/// Runs the scene's own waveforms with simulate() and certifies the figures, unless the run, or its judge, did not come to its
/// end. `jobs` is the number of threads for the cloud; it does not change the result.
[[nodiscard]] Closing certify(const PreparedScene& prepared, const Watch& watch = {}, int jobs = 1);

}  // namespace softland
