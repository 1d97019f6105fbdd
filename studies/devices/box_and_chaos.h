// Two other ways to say how devices differ, to be read beside the figures of a sample (studies/devices/robustness.h): the range
// of a figure over a box of what varies, and polynomial chaos.
//
// Box. What interval analyses ask for: the least and the largest figure while every quantity is somewhere between two bounds. The
// bounds are those of the standard normal numbers z beneath the quantities, the same for all,
//
//   |z_i| <= b,   (2 Phi(b) - 1)^d = 0.95
//
// so that the box holds 95 % of all devices, and the largest figure in it is never below the 95 % quantile: one is to be read as
// a bound of the other. A normal quantity reaches b standard deviations; where quantities are correlated the box is that of
// independent numbers beneath them (sampling/copula.h). The range is searched, for each end by a global search from the corners
// and the best sampled devices inside (optimizers/): it proves nothing, and the true range is at least as wide. A device that
// does not close is the worst.
//
// Chaos. Each figure as a sum of polynomials in what varies (sampling/polynomial_chaos.h), taught by the first devices of the
// sample: it costs no closings. How well it predicts is known twice, from a cross-validation over the devices that taught it, and
// from the others of the sample. A figure that jumps is no sum of few polynomials, and both say so.
//
// Errors of measurement count as none in the box; for chaos they are a part of the figures that it cannot predict.
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

/// b [standard deviations of a normal number], for d varying quantities, at least one.
[[nodiscard]] double box_half_width(std::size_t d);

/// An end of a range.
struct BoxDevice {
  std::vector<double> values;  ///< of the varying quantities [SI unit, or factor]
  double figure = Metrics::unset;
  DeviceOutcome outcome = {};
};
struct FigureRange {
  std::string_view key;     ///< of device_figures
  BoxDevice least, most;    ///< `least` has no values where no device in the box is known to close
  Interval of_sample = {};  ///< of the sampled devices in the box
};

struct FigureChaos {
  std::string_view key;               ///< of device_figures
  std::size_t taught = 0;             ///< devices that it was made of
  std::size_t unseen = 0;             ///< devices that it was tried on
  int degree = 0;                     ///< of the polynomials
  std::size_t terms = 0;              ///< with the constant
  double q2 = Metrics::unset;         ///< share of the variance that it predicts, by cross-validation
  double q2_unseen = Metrics::unset;  ///< the same of the devices that did not teach it
  double mean = Metrics::unset, standard_deviation = Metrics::unset;
  double quantile_95 = Metrics::unset;
};

struct BoxAndChaosOptions {
  std::size_t closings_per_search = 300;  ///< of which there are two for each figure
  std::size_t most_taught = 256;          ///< devices
};

struct BoxAndChaos {
  double half_width = Metrics::unset;  ///< b
  std::size_t sampled_inside = 0;      ///< devices of the sample in the box
  long closings = 0;                   ///< of all searches
  std::vector<FigureRange> ranges = {};
  std::vector<FigureChaos> chaos = {};
  std::size_t left_out = 0;   ///< devices that would have taught, but do not close: chaos says nothing of those
  std::string why_none = {};  ///< empty where there are ranges
};

/// For explained_figures, under this drive of `found`, which is judged on the devices of `options`. Ranges and polynomials depend
/// on nothing but their arguments.
[[nodiscard]] BoxAndChaos box_and_chaos(const PreparedScene& nominal, const DriveRobustness& drive,
                                        const RobustnessOptions& options, const BoxAndChaosOptions& effort = {},
                                        const Watch& watch = {});

/// The scene of a device at an end of a range: what `simulate` runs to the same closing.
[[nodiscard]] SceneFile scene_of_device(const PreparedScene& nominal, const DriveRobustness& drive, const BoxDevice& device,
                                        const RobustnessOptions& options);

}  // namespace softland
