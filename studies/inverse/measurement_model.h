// The measurement model of a fit: the readings of the instruments on devices at z, and their derivatives by z (fit.h).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>

#include "studies/inverse/fit_problem.h"

namespace softland {

/// Predicts the measurements of a fit. Each search has its own model, since a DeviceReader represents one device at a time.
class MeasurementModel {
 public:
  /// Keeps a reference to `problem`, which must outlive this object.
  explicit MeasurementModel(const FitProblem& problem);

  /// Computes the predicted values of all measurements and, if `slopes` is not null, their derivatives by z, one row per datum.
  /// Returns false if the values of a device are impossible, or if it lacks a measured figure.
  [[nodiscard]] bool predict(std::span<const double> z, Eigen::VectorXd& values, Eigen::MatrixXd* slopes);

  struct Prediction {
    double value = 0;
    Eigen::VectorXd slopes;  ///< derivatives of the predicted value by the scaled unknowns z
  };
  /// Predicts the reading of an instrument that is not among the data; none if the device lacks the figure that the instrument
  /// reads.
  [[nodiscard]] std::optional<Prediction> predict(std::size_t device, std::span<const double> z, const Instrument& instrument);

 private:
  [[nodiscard]] bool move_to(std::size_t device, std::span<const double> z);
  [[nodiscard]] Eigen::VectorXd slopes_by_z(std::size_t device, const DeviceReader::Reading& reading, Eigen::Index row) const;

  const FitProblem& problem_;
  std::deque<DeviceReader> readers_;
};

/// Returns the problem of a fit as least squares: residuals of the data, then of the prior. Keeps a reference to `problem`.
[[nodiscard]] LeastSquares least_squares_of(const FitProblem& problem);

}  // namespace softland
