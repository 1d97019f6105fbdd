// The results of a fit at the end of its best search: residuals, unknowns with their errors, the population of the devices, and
// the measurements that would reduce the errors most (fit.h).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "studies/inverse/measurement_model.h"

namespace softland {

class EndOfFit {
 public:
  /// Computes residuals, estimate and unknowns into `fit`. Keeps references.
  EndOfFit(const FitProblem& problem, const LeastSquaresEnd& end, Fit& fit);

  /// Throws InvalidRequest for an unknown without a prior that no datum depends on: it would keep the value at which its search
  /// began.
  void require_all_seen(const std::string& bench) const;
  /// Adds the population of the devices' own unknowns, with shared unknowns as they were found.
  void add_population();
  /// Adds the possible measurements, the best first.
  void add_next(const Progress& progress);

 private:
  void add_residuals(const Eigen::VectorXd& values);
  [[nodiscard]] std::vector<WeakDirection> weak_of_a_device() const;
  void add_unknowns();

  const FitProblem& problem_;
  Fit& fit_;
  MeasurementModel model_;
  Eigen::VectorXd z_, residuals_;
  Eigen::MatrixXd slopes_;  // derivatives of the residuals by z
};

}  // namespace softland
