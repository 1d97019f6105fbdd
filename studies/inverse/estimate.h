// The estimate of a least-squares fit, in coordinates z in which the scale of each unknown is 1. The scale is one standard
// deviation of the prior, or a tenth of the value of an unknown without a prior.
//
//   H = J^T W J,  W the weights of the robust loss       information of the data
//   C = (H + P)^-1,  P the information of the prior       covariance of the estimate
//
// A direction of z is weak if the data have less information about it than the prior, that is, if the eigenvalue of H is below
// 1. The data cannot separate the unknowns along a weak direction.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "studies/inverse/posterior.h"

namespace softland {

struct WeakDirection {
  Eigen::VectorXd direction;          ///< direction in z, scaled to a largest component of 1
  double information = 0;             ///< eigenvalue of H for this direction
  std::vector<std::size_t> unknowns;  ///< indices of the unknowns whose component is at least a tenth of the largest
  double seen = 0;  ///< root of the sum of squared changes of the data along `direction`, in units of their errors
};

struct Estimate {
  Eigen::MatrixXd data;        ///< H, information of the data
  Eigen::MatrixXd covariance;  ///< C, covariance of z; infinite variances without information from data or prior
  Eigen::MatrixXd correlation;
  std::vector<WeakDirection> weak;  ///< weak directions in order of increasing information

  [[nodiscard]] double deviation(std::size_t i) const;
  /// Returns the relative decrease of the root mean square of all standard deviations if one more measurement is made. `slopes`
  /// are the derivatives of this measurement by z, in units of its error.
  [[nodiscard]] double reduction(const std::vector<Eigen::VectorXd>& slopes) const;
};

/// Returns the weak directions of the information `data`, in order of increasing eigenvalue.
[[nodiscard]] std::vector<WeakDirection> weak_directions(const Eigen::MatrixXd& data);
[[nodiscard]] Estimate estimate(const Eigen::MatrixXd& data, const Eigen::MatrixXd& prior);

/// A device of a population, with the information H_k of its data about z.
struct KnownDevice {
  Eigen::MatrixXd data;    ///< H_k, information of the data of this device about z
  Eigen::VectorXd target;  ///< H_k m_k, where m_k is the estimate from the data alone
};
/// Returns mean and covariance of z over a population with the largest likelihood, by expectation and maximisation (Dempster,
/// Laird and Rubin 1977; Laird and Ware 1982). The iteration starts from `begin` and needs at least two devices.
[[nodiscard]] NormalBelief population_of(const std::vector<KnownDevice>& devices, NormalBelief begin);

}  // namespace softland
