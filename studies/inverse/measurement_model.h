// The measurement model of a fit: what the instruments read on devices at z, and the derivatives by z (fit.h).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>

#include "studies/inverse/fit_problem.h"

namespace softland {

/// Each search has a model of its own: a reader is one device at a time.
class MeasurementModel {
 public:
  /// Keeps a reference.
  explicit MeasurementModel(const FitProblem& problem);

  /// Computes the predicted values of all data and, if `slopes` is not null, their derivatives, a row for each. Returns false
  /// if a device is impossible or cannot be read.
  [[nodiscard]] bool predict(std::span<const double> z, Eigen::VectorXd& values, Eigen::MatrixXd* slopes);

  struct Prediction {
    double value = 0;
    Eigen::VectorXd slopes;  ///< derivatives by z
  };
  /// Predicts the reading of one further instrument on a device; none if it cannot be read.
  [[nodiscard]] std::optional<Prediction> predict(std::size_t device, std::span<const double> z, const Instrument& instrument);

 private:
  [[nodiscard]] bool move_to(std::size_t device, std::span<const double> z);
  [[nodiscard]] Eigen::VectorXd slopes_by_z(std::size_t device, const DeviceReader::Reading& reading, Eigen::Index row) const;

  const FitProblem& problem_;
  std::deque<DeviceReader> readers_;
};

/// Returns the problem as least squares: the residuals of the data, then those of the prior. Keeps a reference.
[[nodiscard]] LeastSquares least_squares_of(const FitProblem& problem);

}  // namespace softland
