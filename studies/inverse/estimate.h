// The estimate of a least-squares fit, in coordinates z in which the scale of each unknown is 1. The scale is one standard
// deviation of the prior, or a tenth of the value of an unknown without a prior.
//
//   H = J^T W J,  W the weights of the robust loss       Fisher information of the data
//   C = (H + P)^-1,  P the Fisher information of the prior       covariance of the estimate
//
// A direction of z is weak if the data have less information about it than the prior: it is an eigenvector of H with an
// eigenvalue below 1, the information of the prior in units of z. The data cannot separate the unknowns along a weak direction.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "studies/inverse/posterior.h"

namespace softland {

struct WeakDirection {
  Eigen::VectorXd direction;  ///< weak direction in the scaled unknowns z, with a largest component of 1
  double information = 0;     ///< eigenvalue of the Fisher information H of the data for this direction
  /// Indices of the unknowns whose component of `direction` is at least a tenth of the largest.
  std::vector<std::size_t> unknowns;
  /// Root of the sum of squared changes of the predicted data when z moves along `direction`, in units of the errors of the
  /// data.
  double seen = 0;
};

struct Estimate {
  Eigen::MatrixXd data;  ///< H, Fisher information of the data
  /// C, covariance of the scaled unknowns z; infinite variances without information from data or prior.
  Eigen::MatrixXd covariance;
  Eigen::MatrixXd correlation;
  std::vector<WeakDirection> weak;  ///< weak directions, which the data hardly determine, in order of increasing information

  [[nodiscard]] double deviation(std::size_t i) const;
  /// Returns the relative decrease of the root mean square of the standard deviations of all unknowns if one more measurement
  /// is made. `slopes` are the derivatives of this measurement by z, in units of its error.
  [[nodiscard]] double reduction(const std::vector<Eigen::VectorXd>& slopes) const;
};

/// Returns the weak directions (which the data hardly determine) of the Fisher information `data`, in order of increasing
/// eigenvalue.
[[nodiscard]] std::vector<WeakDirection> weak_directions(const Eigen::MatrixXd& data);
[[nodiscard]] Estimate estimate(const Eigen::MatrixXd& data, const Eigen::MatrixXd& prior);

/// A device of a population, with the Fisher information H_k of its data about the scaled unknowns z.
struct KnownDevice {
  Eigen::MatrixXd data;    ///< H_k, Fisher information of the device's data about z
  Eigen::VectorXd target;  ///< product H_k m_k of information and estimate m_k from the device's data alone
};
/// Returns mean and covariance of z over a population with the largest likelihood, by expectation and maximisation (Dempster,
/// Laird and Rubin 1977; Laird and Ware 1982). The iteration starts from `begin` and needs at least two devices.
[[nodiscard]] NormalBelief population_of(const std::vector<KnownDevice>& devices, NormalBelief begin);

}  // namespace softland
