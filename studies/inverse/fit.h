// The fit of a scene to measurements on devices: least squares over the quantities of [spread], or any keys of the scene.
//
//   minimise  sum over data of rho(((y_i(x) - m_i) / s_i)^2) + (z - mean)^T R^-1 (z - mean)
//
// The symbols are: y_i(x) reading of an instrument on the device (studies/devices/instruments.h), m_i measured value, s_i its
// error, rho robust loss (least_squares.h). z are the unknowns in scales of their own: one standard deviation of [spread],
// whose correlations R count. A key without an entry has a tenth of the scene's value as scale, and no prior. Distributions
// other than the normal one count with their mean and standard deviation.
//
// Unknowns are those of each device, or shared by all. The searches begin at the nominal device and at points of low
// discrepancy spread over the prior; the best end counts. Standard errors are those of the linearised problem there. The rows
// of traces up to the first touch count at first. The best ends go on to more of them as long as the scene describes those
// (trace_windows.h).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/watch.h"
#include "config/bench.h"
#include "studies/devices/instruments.h"
#include "studies/inverse/estimate.h"
#include "studies/inverse/least_squares.h"

namespace softland {

struct FitOptions {
  std::vector<std::string> unknowns = {};  ///< entries of [spread], or keys; empty: all entries of [spread]
  std::vector<std::string> shared = {};    ///< those of the unknowns that all devices share
  Loss loss = Loss::huber;
  std::size_t starts = 20;
  std::uint64_t seed = 1;
  int jobs = 1;         ///< threads; does not change the result
  bool suggest = true;  ///< search for the best next measurement
};
inline constexpr std::size_t most_starts = 10'000;

struct FittedUnknown {
  std::string name;                                                      ///< name of the entry in [spread], or the key
  std::string device;                                                    ///< device; empty: all devices, or the only one
  std::string unit;                                                      ///< SI; empty: a factor of the scene's values
  double nominal = 0;                                                    ///< value of the scene [unit]
  double value = 0, standard_error = 0;                                  ///< unset if the fit is in doubt
  double low = 0, high = 0;                                              ///< 95 % interval; likewise
  double prior_mean = Metrics::unset, prior_deviation = Metrics::unset;  ///< NaN: no prior
  double scale = 0;                                                      ///< scale of z
};

struct FitResidual {
  std::size_t measurement = 0;  ///< number in the bench file
  std::string device;
  Measurable what = Measurable::pull_in;
  std::string drive;
  std::optional<double> level, time;                      ///< [V], [s]
  double measured = 0, error = 0, before = 0, after = 0;  ///< before: in the given scene; after: in the fitted one
  [[nodiscard]] double normalized() const { return (after - measured) / error; }
  [[nodiscard]] double normalized_before() const { return (before - measured) / error; }
};

/// The rows of a trace (position or velocity) that count: up to where the scene describes it.
struct FittedTrace {
  std::size_t measurement = 0;  ///< number in the bench file
  Measurable what = Measurable::velocity;
  double until = 0, recorded = 0;  ///< times of the last row that counts, and of the last one [s]
};

struct NextMeasurement {
  std::string name;  ///< "closing time at 22 V"
  Measurable what = Measurable::pull_in;
  std::optional<double> level;  ///< [V]
  double error = 0;             ///< assumed error [SI unit]
  double reduction = 0;         ///< share by which the root mean square of all standard errors falls
};

/// The fitted population of several devices.
struct FittedPopulation {
  std::vector<std::size_t> variables;  ///< numbers of the variables of the scene's spread
  std::vector<std::string> names;
  std::vector<double> mean, deviation;  ///< [unit of the value]
  Eigen::MatrixXd correlation;
};

struct Fit {
  PreparedScene scene;  ///< given scene, with the [spread] of the unknowns
  bool spread_assumed = false;
  std::vector<std::string> devices;
  std::vector<FittedUnknown> unknowns;
  Estimate estimate;  ///< weak directions are those of the mean device, by the unknowns of the first
  std::vector<FitResidual> residuals;
  std::vector<FittedTrace> traces = {};
  std::vector<NextMeasurement> next;  ///< measurements, the best first
  std::optional<FittedPopulation> population;
  std::size_t starts = 0, converged = 0, minima = 0;
  std::vector<double> costs;  ///< costs of the ends, by start; NaN for a failed search
  Loss loss = Loss::huber;
  std::uint64_t seed = 1;
  bool found = false;
  /// The reasons to doubt the result, in words: an unknown that lies far from its prior, data that are not described, another
  /// minimum that describes them as well. A result in doubt has no standard errors.
  std::vector<std::string> doubts = {};

  /// Sum of the squared normalized residuals, without weights.
  [[nodiscard]] double chi_squared() const;
  [[nodiscard]] double chi_squared_before() const;
  /// Key and value of everything that was fitted for this device: the fitted scene has them in the place of the scene's own.
  struct FittedKey {
    std::string path;
    std::size_t element = 0;
    Quantity value;
  };
  [[nodiscard]] std::vector<FittedKey> keys(const std::string& device) const;
};

/// Sets the [spread] of the scene to the deviations and correlations of the fitted population: normal, about the scene's
/// values.
void set_spread(SceneFile& file, const Fit& fit);

/// Returns this text of a scene, which is that of the file `path`, with the results for this device; for several devices, with
/// the mean of their population and its spread. Comments, sources and units stay. Throws InvalidInput for a text that is not a
/// scene.
[[nodiscard]] std::string fitted_text(const Fit& fit, std::string_view text, const std::string& path, const std::string& device);

/// Throws InvalidInput for unknowns that no device can have, for measurements that the scene cannot have, and if the scene
/// itself or a device of the bench file does not allow any of it. Throws Interrupted.
[[nodiscard]] Fit fit(const SceneFile& file, const Bench& bench, const FitOptions& options, const Watch& watch = {});

}  // namespace softland
