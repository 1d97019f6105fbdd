// A cloud: a closing repeated under imperceptibly perturbed drives. The bounce count and the permanent contact time of a
// chaotic closing do not converge with the tolerance, so they are given as ranges over such a cloud.
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
  double smallest = 1e-9, largest = 1e-7;  ///< relative changes of the drives' levels, of either sign, in steps of a decade
  std::uint64_t seed = 1;
  int jobs = 1;  ///< number of threads; does not change the runs
};

/// Returns the runs in order, as a function of the arguments alone. If `closing.stop` ends a run, that run and all after it are
/// left out. An observer of `closing` is called from several threads at once if jobs > 1; `progress` is called from one at a
/// time.
[[nodiscard]] std::vector<Trajectory> perturbed_closings(const Switch& model, std::span<const Signal> drives,
                                                         const ClosingOptions& closing, const CloudOptions& options = {},
                                                         const Progress& progress = {});

/// Range of a figure over those runs in which it exists; NaN if there are none.
struct Spread {
  double low = Metrics::unset, median = Metrics::unset, high = Metrics::unset;
  int runs = 0;
};
[[nodiscard]] Spread spread(std::vector<double> values);

/// Relative range over the cloud from which on a figure is ill-conditioned: a thousandfold of the largest perturbation.
inline constexpr double ill_conditioned_range = 1e-4;
/// True if the last digits of the drives change a figure visibly; `values` are those of Figure::counted().
[[nodiscard]] bool ill_conditioned(const Spread& values);

}  // namespace softland
