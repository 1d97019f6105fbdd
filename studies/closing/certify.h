// Figures of merit with reliable errors, and ranges for figures that have no error.
//
// The figures are those of simulate(). The error of a figure is a multiple of its difference to a more accurate run, the judge,
// plus a hundredth of the tolerance for the error that both runs share. The errors are calibrated on random scenes
// (bench/certify_coverage.cc). Pull-in voltages that serve as units of the drives are computed again with the judge's
// quadrature, and their errors are propagated to the figures.
//
// A figure is ill-conditioned if imperceptible changes of the drives change it visibly. Such a figure is then given as median
// and range over a cloud of perturbed runs, and its error reaches to the end of the range.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "studies/closing/cloud.h"
#include "studies/closing/simulate.h"

namespace softland {

/// The first rebound at which runs with imperceptibly perturbed drives diverge. Before this rebound all runs have the same
/// rebounds.
struct GrazingRebound {
  int number = 0;              ///< number of the rebound among all rebounds of the unperturbed run, counted from 1
  double time = 0;             ///< time at which the rebound begins [s]
  double height = 0;           ///< height of the rebound in the unperturbed run [m]
  double impact_velocity = 0;  ///< impact velocity of the touch before the rebound [m/s]
  /// True if the rebound is significant in some runs only; false if the touch before the rebound has the smallest impact
  /// velocity so far.
  bool at_threshold = false;
};

struct IllConditioned {
  Figure figure;
  Spread spread;
};

struct Certificate {
  std::vector<IllConditioned> ill_conditioned;
  /// Rebound at which the perturbed runs diverge; none if they do not diverge at a rebound.
  std::optional<GrazingRebound> grazing;
  int runs = 0;
};

/// Ratio of the stated error of a figure to the difference between a run and its judge, a more accurate run.
inline constexpr double error_safety = 3;

/// Returns the first rebound in which the perturbed runs differ, with the cause of the difference; none if they do not differ.
[[nodiscard]] std::optional<GrazingRebound> grazing_rebound(std::span<const Trajectory> runs, const MetricsOptions& options);

/// Runs the scene's own waveforms with simulate() and certifies the figures, if the run and its more accurate judge are
/// complete. `jobs` is the number of threads for perturbed runs; it does not change the result.
[[nodiscard]] Closing certify(const PreparedScene& prepared, const Progress& progress = {}, int jobs = 1);

}  // namespace softland
