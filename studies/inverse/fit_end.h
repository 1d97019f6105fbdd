// The results of a fit at the end of its best search: residuals, unknowns with their errors, the means and deviations over the
// devices, and the measurements that would reduce the errors most (fit.h).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "studies/inverse/measurement_model.h"

namespace softland {

class EndOfFit {
 public:
  /// Computes residuals, estimate and unknowns of the fit and stores them in `fit`. Keeps references to its arguments.
  EndOfFit(const FitProblem& problem, const LeastSquaresEnd& end, Fit& fit);

  /// Throws InvalidRequest for an unknown of the fit that has no prior and that changes no prediction: its fitted value would
  /// be the start of its search.
  void require_all_seen(const std::string& bench) const;
  /// Adds the means and deviations over the devices (their population) for the unknowns that each device has for itself. Shared
  /// unknowns have their fitted values.
  void add_population();
  /// Adds the possible further measurements to the fit, those that reduce the errors most first.
  void add_next(const Progress& progress);

 private:
  void add_residuals(const Eigen::VectorXd& values);
  [[nodiscard]] std::vector<WeakDirection> weak_of_a_device() const;
  void add_unknowns();

  const FitProblem& problem_;
  Fit& fit_;
  MeasurementModel model_;
  Eigen::VectorXd z_, residuals_;
  Eigen::MatrixXd slopes_;  // derivatives of the residuals by the scaled unknowns z
};

}  // namespace softland
