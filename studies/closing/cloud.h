// A closing repeated under imperceptibly perturbed drives. The bounce count and the permanent contact time of a chaotic closing
// do not converge with the tolerance: such figures are properties of a cloud of runs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/watch.h"
#include "model/closing.h"
#include "objectives/figures.h"

namespace softland {

struct CloudOptions {
  int runs = 16;
  double smallest = 1e-9, largest = 1e-7;  ///< relative change of every drive's levels, of either sign; between them by decades
  std::uint64_t seed = 1;
  int jobs = 1;  ///< threads; does not change the runs
};

/// Returns the runs in order, as a function of the arguments alone. Runs that `closing.stop` ends are left out, with all after
/// the first of them. An observer of `closing` is called from several threads at once if jobs > 1; `watch` is called from one
/// at a time.
[[nodiscard]] std::vector<Trajectory> perturbed_closings(const Switch& model, std::span<const Signal> drives,
                                                         const ClosingOptions& closing, const CloudOptions& options = {},
                                                         const Watch& watch = {});

/// Range of a figure over the runs that have it; NaN if none has.
struct Spread {
  double low = Metrics::unset, median = Metrics::unset, high = Metrics::unset;
  int runs = 0;
};
[[nodiscard]] Spread spread(std::vector<double> values);

/// Relative range over the cloud from which on a figure is ill-conditioned: a thousandfold magnification of the perturbation.
inline constexpr double ill_conditioned_range = 1e-4;
/// True if the drives' last digits decide a figure; `values` are those of Figure::counted().
[[nodiscard]] bool ill_conditioned(const Spread& values);

}  // namespace softland
