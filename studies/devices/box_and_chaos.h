// Two further descriptions of process variation, beside the statistics of a sample (studies/devices/robustness.h): the range of
// a figure over a box of the varied quantities, and polynomial chaos.
//
// Box. An interval analysis requests the least and the largest figure while every varied quantity is anywhere between two
// bounds. Each varied quantity is a function of a standard normal number z_i, and the bounds are the same for all z_i,
//
//   |z_i| <= b,   (2 Phi(b) - 1)^d = 0.95,   d: number of varied quantities
//
// so that the box holds 95 % of all devices. The largest figure in the box is never below the 95th percentile of all devices:
// read this figure as an upper bound of the percentile. A normal quantity reaches b standard deviations. If quantities are
// correlated, z_i are the independent numbers from which the quantities are made (sampling/copula.h).
//
// Each end of the range is found by a global search that starts from the corners of the box and from the best sampled devices
// in it (optimizers/). A search proves nothing: the true range is at least as wide. A device that does not close counts as the
// worst.
//
// Chaos. Each figure is a sum of polynomials in the varied quantities (sampling/polynomial_chaos.h). The sum is fitted to the
// first devices of the sample, and so needs no further closings. Its prediction error is estimated twice: by cross-validation
// over the fitted devices, and on the other devices of the sample. Both errors are large for a figure that jumps, since no sum
// of few polynomials describes such a figure.
//
// Errors of measurement are left out of the box. Polynomial chaos cannot predict the variation that measurement errors cause.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/devices/robustness.h"

namespace softland {

/// Share of all devices that the box of varied quantities contains.
inline constexpr double box_share = 0.95;

/// Returns the half width b of the box for d varied quantities, at least one [standard deviations of a normal number].
[[nodiscard]] double box_half_width(std::size_t d);

/// A device at an end of the range of a figure over the box of varied quantities.
struct BoxDevice {
  std::vector<double> values;  ///< values of the varied quantities of the device [SI unit, or factor]
  double figure = Metrics::unset;
  DeviceOutcome outcome = {};
};
struct FigureRange {
  std::string_view key;     ///< key of the figure, one of device_figures
  BoxDevice least, most;    ///< devices with the least and the largest figure; `least` is empty if none closes
  Interval of_sample = {};  ///< range of the figure over the sampled devices inside the box
};

struct FigureChaos {
  std::string_view key;        ///< key of the figure, one of device_figures
  std::size_t fitted = 0;      ///< number of devices to which the polynomials of the figure are fitted
  std::size_t unseen = 0;      ///< number of devices outside of the fit, on which the polynomials are tested
  int degree = 0;              ///< degree of the polynomials in the varied quantities
  std::size_t terms = 0;       ///< number of terms of the polynomials, the constant included
  double q2 = Metrics::unset;  ///< share of the figure's variance that the polynomials predict, by cross-validation
  /// Share of the figure's variance that the polynomials predict on the devices to which they were not fitted.
  double q2_unseen = Metrics::unset;
  double mean = Metrics::unset, standard_deviation = Metrics::unset;
  double quantile_95 = Metrics::unset;
};

struct BoxAndChaosOptions {
  std::size_t closings_per_search = 300;  ///< largest number of closings in a search for an end of a figure's range
  std::size_t most_fitted = 256;          ///< largest number of devices to which polynomials are fitted
};

struct BoxAndChaos {
  double half_width = Metrics::unset;  ///< half width b of the box of varied quantities, in standard deviations
  std::size_t sampled_inside = 0;      ///< number of sampled devices with their varied quantities in the box
  long closings = 0;                   ///< number of simulated closings in the searches for the ends of the ranges
  std::vector<FigureRange> ranges = {};
  std::vector<FigureChaos> chaos = {};
  std::size_t left_out = 0;   ///< number of devices that do not close and are therefore left out of the fit of polynomials
  std::string why_none = {};  ///< reason why the box has no ranges; empty if there are ranges
};

/// Finds the ranges over the box of varied quantities, and the polynomial chaos, of explained_figures under the waveforms of
/// `drive`, which were simulated on the devices of `options`. The results depend on nothing but the arguments.
[[nodiscard]] BoxAndChaos box_and_chaos(const PreparedScene& nominal, const DriveRobustness& drive,
                                        const RobustnessOptions& options, const BoxAndChaosOptions& effort = {},
                                        const Progress& progress = {});

/// Returns the scene of a device at an end of the range of a figure. Simulating it gives BoxDevice::outcome.
[[nodiscard]] SceneFile scene_of_device(const PreparedScene& nominal, const DriveRobustness& drive, const BoxDevice& device,
                                        const RobustnessOptions& options);

}  // namespace softland
