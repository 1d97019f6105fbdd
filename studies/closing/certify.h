// Figures of merit that carry an error to rely on, and clouds in the place of those that have none.
//
// The figures are those of simulate(). Their errors are a multiple of the difference to the run that judged them, and a hundredth
// of the tolerance for what both miss; calibrated on random scenes (bench/certify_coverage.cc). Where drives are given in pull-in
// voltages these are computed again with the judge's quadrature, and the figures' errors hold what theirs moves. A figure is
// ill-conditioned where imperceptible changes of the drives move it visibly: it is then given as median and range over a cloud of
// runs, and its error reaches to the end of that range.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "studies/closing/cloud.h"
#include "studies/closing/simulate.h"

namespace softland {

/// Where the runs of a cloud part: up to here they have the same rebounds.
struct GrazingRebound {
  int number = 0;              ///< counted from 1, all rebounds of the first run
  double time = 0;             ///< at which it begins [s]
  double height = 0;           ///< [m]
  double impact_velocity = 0;  ///< of the touch that it follows [m/s]
  bool at_threshold = false;   ///< it counts in some runs only; else the touch before it is the gentlest of all until then
};

struct IllConditioned {
  Figure figure;
  Spread spread;
};

struct Certificate {
  std::vector<IllConditioned> ill_conditioned;
  std::optional<GrazingRebound> grazing;  ///< none where the runs do not part at a rebound
  int runs = 0;
};

/// Of the difference to the better run.
inline constexpr double error_safety = 3;

/// The first rebound in which runs differ, named by what made them differ. None for runs that do not.
[[nodiscard]] std::optional<GrazingRebound> grazing_rebound(std::span<const Trajectory> runs, const MetricsOptions& options);

/// Runs the scene's own waveforms with simulate() and certifies the figures; not those of a run, or of a judge, that
/// did not come to its end.
/// `jobs`: threads for the cloud; does not change the result.
[[nodiscard]] Closing certify(const PreparedScene& prepared, const Watch& watch = {}, int jobs = 1);

}  // namespace softland
