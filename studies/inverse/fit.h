// Fits a scene to measurements on devices: least squares over the quantities of [spread], or over any keys of the scene.
//
//   minimise  sum over data of rho(((y_i(x) - m_i) / s_i)^2) + (z - mean)^T R^-1 (z - mean)
//
// y_i(x) is the reading of an instrument on the device (studies/devices/instruments.h), m_i the measured value, s_i its error,
// and rho the robust loss (least_squares.h). z are the unknowns x, each in units of its scale: one standard deviation of
// [spread]. R are the correlations of [spread]. A key without an entry in [spread] has no prior, and its scale is a tenth of
// the scene's value. Distributions other than the normal distribution are replaced by their mean and standard deviation.
//
// An unknown belongs to one device, or is shared by all. Searches start at the nominal device and at points of low discrepancy
// over the prior; the result is the end of the best search. Standard errors are those of the problem linearised at this end. At
// first, only rows of traces up to first contact are fitted. Then more rows are added, as long as the model describes them
// (trace_windows.h).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "config/bench.h"
#include "studies/devices/instruments.h"
#include "studies/inverse/estimate.h"
#include "studies/inverse/least_squares.h"

namespace softland {

struct FitOptions {
  /// Unknowns of the fit: entries of [spread] or keys of the scene; empty for all entries of [spread].
  std::vector<std::string> unknowns = {};
  std::vector<std::string> shared = {};  ///< names of the unknowns that have one value for all devices
  Loss loss = Loss::huber;
  std::size_t starts = 20;
  std::uint64_t seed = 1;
  int jobs = 1;         ///< number of threads; does not change the result
  bool suggest = true;  ///< true to search for the measurement that would reduce the errors most
};
inline constexpr std::size_t most_starts = 10'000;

struct FittedUnknown {
  std::string name;    ///< name of the unknown: its entry in [spread], or its key
  std::string device;  ///< name of the device to which the unknown belongs; empty if shared by all, or for the only device
  std::string unit;    ///< SI unit of the unknown; empty for a factor of the scene's values
  double nominal = 0;  ///< value of the unknown in the given scene [unit]
  double value = 0, standard_error = 0;  ///< fitted value and standard error [unit]; NaN if the fit is in doubt
  double low = 0, high = 0;              ///< ends of the 95 % interval of the fitted value [unit]; NaN if the fit is in doubt
  /// Mean and standard deviation of the unknown's prior [unit]; NaN without a prior.
  double prior_mean = Metrics::unset, prior_deviation = Metrics::unset;
  double scale = 0;  ///< change of the value when the scaled unknown z changes by 1
};

struct FitResidual {
  std::size_t measurement = 0;  ///< number of the measurement in the bench file to which the residual belongs
  std::string device;
  Measurable what = Measurable::pull_in;
  std::string drive;
  /// Level of the measurement [V]; time of the row if the measurement is a curve over time [s].
  std::optional<double> level, time;
  /// Measured value and its error; readings in the given scene (before) and in the fitted scene (after).
  double measured = 0, error = 0, before = 0, after = 0;
  [[nodiscard]] double normalized() const { return (after - measured) / error; }
  [[nodiscard]] double normalized_before() const { return (before - measured) / error; }
};

/// The rows of a trace (recorded curve of position or velocity) that the fit uses: the rows that the model describes.
struct FittedTrace {
  std::size_t measurement = 0;  ///< number of the trace's measurement in the bench file
  Measurable what = Measurable::velocity;
  double until = 0, recorded = 0;  ///< times of the trace's last row that the fit uses, and of its last recorded row [s]
};

struct NextMeasurement {
  std::string name;  ///< name of the further measurement, such as "closing time at 22 V"
  Measurable what = Measurable::pull_in;
  std::optional<double> level;  ///< voltage at which the further measurement is made [V]
  double error = 0;             ///< assumed standard deviation of the further measurement's error [SI unit]
  double reduction = 0;         ///< relative decrease of the root mean square of all standard errors if this measurement is made
};

/// Means and deviations of the unknowns over several fitted devices (their population).
struct FittedPopulation {
  std::vector<std::size_t> variables;  ///< indices in the scene's [spread] of the variables that differ between the devices
  std::vector<std::string> names;
  /// Mean and standard deviation of each variable over the devices [unit of the variable].
  std::vector<double> mean, deviation;
  Eigen::MatrixXd correlation;
};

struct Fit {
  PreparedScene scene;  ///< scene that the user gave; its [spread] contains the unknowns
  bool spread_assumed = false;
  std::vector<std::string> devices;
  std::vector<FittedUnknown> unknowns;
  /// Estimate of the unknowns. Its weak directions are those of the Fisher information averaged over the devices, in the
  /// unknowns of the first device.
  Estimate estimate;
  std::vector<FitResidual> residuals;
  std::vector<FittedTrace> traces = {};
  std::vector<NextMeasurement> next;  ///< possible further measurements, those that reduce the errors most first
  std::optional<FittedPopulation> population;
  std::size_t starts = 0, converged = 0, minima = 0;
  std::vector<double> costs;  ///< least-squares cost at the end of each search, by start; NaN for a failed search
  Loss loss = Loss::huber;
  std::uint64_t seed = 1;
  bool found = false;
  /// Reasons to doubt the result of the fit, as sentences: an unknown is far from its prior, the model does not describe the
  /// data, or another minimum describes the data as well. A result in doubt has no standard errors.
  std::vector<std::string> doubts = {};

  /// Return the sum of the squared residuals, in errors of the data and without robust weights, after and before the fit.
  [[nodiscard]] double chi_squared() const;
  [[nodiscard]] double chi_squared_before() const;
  /// A key of the scene and its fitted value, which replaces the value of the given scene in the fitted scene of a device.
  struct FittedKey {
    std::string path;
    std::size_t element = 0;
    Quantity value;
  };
  [[nodiscard]] std::vector<FittedKey> keys(const std::string& device) const;
};

/// Throws InvalidInput for unknowns that no device can have, for measurements that are impossible for the scene, and if the
/// scene or a device of the bench file cannot be fitted. Throws Interrupted if `progress` asks to stop.
[[nodiscard]] Fit fit(const SceneFile& file, const Bench& bench, const FitOptions& options, const Progress& progress = {});

}  // namespace softland
