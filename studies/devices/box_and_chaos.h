// Two further descriptions of process variation, beside the figures of a sample (studies/devices/robustness.h): the range of a
// figure over a box of the varied quantities, and polynomial chaos.
//
// Box. An interval analysis asks for it: the least and the largest figure while every quantity is somewhere between two bounds.
// The bounds are those of the standard normal numbers z beneath the quantities, the same for all,
//
//   |z_i| <= b,   (2 Phi(b) - 1)^d = 0.95
//
// so that the box holds 95 % of all devices. The largest figure in it is never below the 95th percentile: read the former as a
// bound of the latter. A normal quantity reaches b standard deviations. If quantities are correlated, the box is that of the
// independent numbers beneath them (sampling/copula.h). The range is searched, for each end by a global search from the corners
// and the best sampled devices inside (optimizers/). It proves nothing: the true range is at least as wide. A device that does
// not close is the worst.
//
// Chaos. Each figure is a sum of polynomials in the varied quantities (sampling/polynomial_chaos.h), fitted to the first
// devices of the sample: it costs no closings. Its prediction error is known twice: from a cross-validation over the fitted
// devices, and from the others of the sample. A figure that jumps is not a sum of few polynomials, and both show it.
//
// Errors of measurement are left out of the box; for chaos they are a part of the figures that it cannot predict.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/devices/robustness.h"

namespace softland {

/// The share of the devices that the box holds.
inline constexpr double box_share = 0.95;

/// Returns b for d varied quantities, at least one [standard deviations of a normal number].
[[nodiscard]] double box_half_width(std::size_t d);

/// An end of a range.
struct BoxDevice {
  std::vector<double> values;  ///< values of the varied quantities [SI unit, or factor]
  double figure = Metrics::unset;
  DeviceOutcome outcome = {};
};
struct FigureRange {
  std::string_view key;     ///< key of device_figures
  BoxDevice least, most;    ///< `least` has no values if no device in the box is known to close
  Interval of_sample = {};  ///< range of the sampled devices in the box
};

struct FigureChaos {
  std::string_view key;               ///< key of device_figures
  std::size_t taught = 0;             ///< number of fitted devices
  std::size_t unseen = 0;             ///< number of devices that test it
  int degree = 0;                     ///< degree of the polynomials
  std::size_t terms = 0;              ///< number of terms, with the constant
  double q2 = Metrics::unset;         ///< share of the variance that it predicts, by cross-validation
  double q2_unseen = Metrics::unset;  ///< the same for the devices that it was not fitted to
  double mean = Metrics::unset, standard_deviation = Metrics::unset;
  double quantile_95 = Metrics::unset;
};

struct BoxAndChaosOptions {
  std::size_t closings_per_search = 300;  ///< closings of each of the two searches per figure
  std::size_t most_taught = 256;          ///< most fitted devices
};

struct BoxAndChaos {
  double half_width = Metrics::unset;  ///< half width b
  std::size_t sampled_inside = 0;      ///< devices of the sample in the box
  long closings = 0;                   ///< closings of all searches
  std::vector<FigureRange> ranges = {};
  std::vector<FigureChaos> chaos = {};
  std::size_t left_out = 0;   ///< devices of the fit that do not close: chaos says nothing about them
  std::string why_none = {};  ///< empty if ranges exist
};

/// Finds ranges and chaos of explained_figures under this drive, which was judged on the devices of `options`. The results are
/// functions of the arguments.
[[nodiscard]] BoxAndChaos box_and_chaos(const PreparedScene& nominal, const DriveRobustness& drive,
                                        const RobustnessOptions& options, const BoxAndChaosOptions& effort = {},
                                        const Watch& watch = {});

/// The scene of a device at an end of a range, which `simulate` runs to the same closing.
[[nodiscard]] SceneFile scene_of_device(const PreparedScene& nominal, const DriveRobustness& drive, const BoxDevice& device,
                                        const RobustnessOptions& options);

}  // namespace softland
