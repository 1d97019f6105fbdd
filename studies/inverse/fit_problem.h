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

/// A measured value of the bench file.
struct Datum {
  std::size_t device = 0;
  std::size_t instrument = 0;    ///< index among the instruments of the device
  Eigen::Index row = 0;          ///< row of the value in the reading of the instrument
  std::size_t measurement = 0;   ///< number of the measurement in the bench file
  double time = Metrics::unset;  ///< time of the row if the value belongs to a trace [s]; NaN otherwise
};

struct FitDevice {
  std::string name;
  PreparedScene nominal;  ///< scene whose [spread] contains only the unknowns
  std::vector<Instrument> instruments = {};
};

/// An unknown of a fit: a variable of [spread], of one device or shared by all.
struct FitParameter {
  std::size_t variable = 0;
  std::optional<std::size_t> device = {};  ///< index of the device; none: shared by all devices
  double mean = 0, scale = 1;              ///< value = mean + scale z
  bool has_prior = true;
};

struct FitProblem {
  std::vector<FitDevice> devices;
  std::vector<Datum> data;
  Eigen::VectorXd measured, errors;  ///< values and standard deviations of the data [SI unit]
  std::vector<FitParameter> parameters;
  std::vector<std::vector<std::size_t>> of_device;  ///< indices of the parameters by device and variable
  Eigen::MatrixXd prior;                            ///< P, the information of the prior
  Eigen::MatrixXd prior_root;                       ///< residuals of the prior are prior_root z
  Loss loss = Loss::huber;

  /// Returns the residuals of these predictions: prediction less measured value, in standard deviations of the data.
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& predicted) const;
  /// Returns the weights that the robust loss gives these residuals in the information of the data.
  [[nodiscard]] Eigen::VectorXd weights(const Eigen::VectorXd& residuals) const;
};

/// Share of the scene's value that is the scale of an unknown without a prior.
inline constexpr double scale_without_prior = 0.1;

/// Returns the problem without measured values. Throws the exceptions of fit().
[[nodiscard]] FitProblem problem_without_data(const SceneFile& file, const Bench& bench, const FitOptions& options,
                                              const Progress& progress);
/// Returns the problem with the data of the measurements in `bench`, in place of its former data.
[[nodiscard]] FitProblem with_data(FitProblem problem, const Bench& bench);

}  // namespace softland
