// The estimate of a least-squares fit, in coordinates z in which the scale of each unknown is 1: one standard deviation of its
// prior, or a tenth of its value without a prior.
//
//   H = J^T W J,  W the weights of the robust loss       information of the data
//   C = (H + P)^-1,  P that of the prior                 covariance of the estimate
//
// A direction of z is weak if the data have less information about it than the prior: its eigenvalue of H is below 1. The data
// cannot separate the unknowns along it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace softland {

struct WeakDirection {
  Eigen::VectorXd direction;          ///< direction in z, its largest component 1
  double information = 0;             ///< eigenvalue of H
  std::vector<std::size_t> unknowns;  ///< unknowns with at least a tenth of the largest component
  double seen = 0;                    ///< root of the sum of the squared changes of all data, in their errors, for this direction
};

struct Estimate {
  Eigen::MatrixXd data;        ///< H
  Eigen::MatrixXd covariance;  ///< C; infinite variances without information from data or prior
  Eigen::MatrixXd correlation;
  std::vector<WeakDirection> weak;  ///< weak directions by rising information

  [[nodiscard]] double deviation(std::size_t i) const;
  /// Share by which the root mean square of all deviations falls with a further measured figure that changes by `slopes` in its
  /// own error.
  [[nodiscard]] double reduction(const std::vector<Eigen::VectorXd>& slopes) const;
};

/// The weak directions of this information, by rising eigenvalue.
[[nodiscard]] std::vector<WeakDirection> weak_directions(const Eigen::MatrixXd& data);
[[nodiscard]] Estimate estimate(const Eigen::MatrixXd& data, const Eigen::MatrixXd& prior);

/// A population of devices, each known by data of information H_k about z_k near the estimate m_k. Mean and covariance of the z
/// of the population have the largest likelihood, by expectation and maximisation (Dempster, Laird and Rubin 1977; Laird and
/// Ware 1982).
struct Population {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};
struct KnownDevice {
  Eigen::MatrixXd data;    ///< H_k
  Eigen::VectorXd target;  ///< H_k z at the z that the data alone give
};
/// Begins at this mean and covariance; needs at least two devices.
[[nodiscard]] Population population_of(const std::vector<KnownDevice>& devices, Population begin);

}  // namespace softland
