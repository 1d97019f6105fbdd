// A cloud: a closing that is repeated under imperceptibly perturbed drives. The bounce count and the permanent contact time of
// a chaotic closing do not converge with the tolerance, so each is given as a range over a cloud.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "model/closing.h"
#include "objectives/figures.h"

namespace softland {

struct CloudOptions {
  int runs = 16;
  /// Bounds of the relative change of a drive's levels in a perturbed run. The change is random: its sign, and its size with a
  /// uniform logarithm between these bounds.
  double smallest = 1e-9, largest = 1e-7;
  std::uint64_t seed = 1;
  int jobs = 1;  ///< number of threads for the perturbed runs; does not change the runs
};

/// Returns the perturbed runs in order; they depend on the arguments alone. If `closing.stop` ends a run, that run and all
/// later runs are left out. If jobs > 1, several threads call the observer of `closing` at once, but only one thread at a time
/// calls `progress`.
[[nodiscard]] std::vector<Trajectory> perturbed_closings(const Switch& model, std::span<const Signal> drives,
                                                         const ClosingOptions& closing, const CloudOptions& options = {},
                                                         const Progress& progress = {});

/// Range of a figure over the perturbed runs (a cloud) in which the figure exists; NaN if it exists in no run.
struct Spread {
  double low = Metrics::unset, median = Metrics::unset, high = Metrics::unset;
  int runs = 0;
};
[[nodiscard]] Spread spread(std::vector<double> values);

/// Relative range of a figure over perturbed runs above which the figure is ill-conditioned: a thousand times the largest
/// perturbation.
inline constexpr double ill_conditioned_range = 1e-4;
/// True if changes in the last digits of the drive voltages change a figure visibly; `values` is the range of the values that
/// Figure::counted() returns for the perturbed runs.
[[nodiscard]] bool ill_conditioned(const Spread& values);

}  // namespace softland
