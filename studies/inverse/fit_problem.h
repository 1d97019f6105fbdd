// The problem of a fit: devices, measured values, unknowns and their prior (fit.h).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "config/bench.h"
#include "studies/inverse/fit.h"

namespace softland {

/// A measured value of the bench file, with its place in the reading of an instrument.
struct Datum {
  std::size_t device = 0;
  std::size_t instrument = 0;    ///< index of the instrument among the device's instruments
  Eigen::Index row = 0;          ///< row of the measured value in the reading of the instrument
  std::size_t measurement = 0;   ///< number of the value's measurement in the bench file
  double time = Metrics::unset;  ///< time of the row if the value belongs to a trace (curve over time) [s]; NaN otherwise
};

struct FitDevice {
  std::string name;
  PreparedScene nominal;  ///< scene whose [spread] contains only the unknowns
  std::vector<Instrument> instruments = {};
};

/// An unknown of a fit: a variable of [spread], for one device or shared by all.
struct FitParameter {
  std::size_t variable = 0;
  std::optional<std::size_t> device = {};  ///< index of the device to which the unknown belongs; none: shared by all devices
  double mean = 0, scale = 1;              ///< mean and scale of the unknown: its value is mean + scale z
  bool has_prior = true;
};

struct FitProblem {
  std::vector<FitDevice> devices;
  std::vector<Datum> data;
  Eigen::VectorXd measured, errors;  ///< measured values and their standard deviations [SI unit]
  std::vector<FitParameter> parameters;
  std::vector<std::vector<std::size_t>> of_device;  ///< indices of the unknowns by device and variable of [spread]
  Eigen::MatrixXd prior;                            ///< P, the Fisher information of the prior on the scaled unknowns z
  Eigen::MatrixXd prior_root;  ///< square root of the matrix `prior`: the residuals of the prior are prior_root z
  Loss loss = Loss::huber;

  /// Returns the residuals of these predicted values: prediction less measured value, in standard deviations of the data.
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& predicted) const;
  /// Returns the weights that the robust loss gives these residuals in the Fisher information of the data.
  [[nodiscard]] Eigen::VectorXd weights(const Eigen::VectorXd& residuals) const;
};

/// Scale of an unknown without a prior, as a share of the scene's value.
inline constexpr double scale_without_prior = 0.1;

/// Returns the problem of a fit without measured values. Throws the exceptions of fit().
[[nodiscard]] FitProblem problem_without_data(const SceneFile& file, const Bench& bench, const FitOptions& options,
                                              const Progress& progress);
/// Returns the problem of a fit with its data replaced by those of the measurements in `bench`.
[[nodiscard]] FitProblem with_data(FitProblem problem, const Bench& bench);

}  // namespace softland
