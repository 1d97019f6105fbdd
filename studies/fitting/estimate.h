// What a least-squares fit knows of its unknowns, in coordinates z in which the scale of each is 1: one standard deviation of
// what was known before, or a tenth of its value where nothing was.
//
//   H = J^T W J,  W the weights of the robust loss       information of the data
//   C = (H + P)^-1,  P that of what was known before     covariance of the estimate
//
// A direction of z is weak where the data say less of it than was known before: its eigenvalue of H is below 1. Along it the data
// cannot tell the unknowns apart.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace softland {

struct WeakDirection {
  Eigen::VectorXd direction;          ///< in z, its largest component 1
  double information = 0;             ///< eigenvalue of H
  std::vector<std::size_t> unknowns;  ///< that take part, by a tenth of the largest or more
  double seen = 0;                    ///< root of the sum of the squared changes of all data, in their errors, for this direction
};

struct Estimate {
  Eigen::MatrixXd data;        ///< H
  Eigen::MatrixXd covariance;  ///< C; infinite variances where neither data nor prior say anything
  Eigen::MatrixXd correlation;
  std::vector<WeakDirection> weak;  ///< by rising information

  [[nodiscard]] double deviation(std::size_t i) const;
  /// By which share the root of the mean square of all deviations falls when a figure is measured as well that changes by
  /// `slopes` in its own error.
  [[nodiscard]] double reduction(const std::vector<Eigen::VectorXd>& slopes) const;
};

/// Those of this information, by rising eigenvalue.
[[nodiscard]] std::vector<WeakDirection> weak_directions(const Eigen::MatrixXd& data);
[[nodiscard]] Estimate estimate(const Eigen::MatrixXd& data, const Eigen::MatrixXd& prior);

/// Of a population of devices, each known by data of information H_k about z_k near the estimate m_k: mean and covariance of the
/// z of the population, of largest likelihood, by expectation and maximisation (Dempster, Laird and Rubin 1977; Laird and Ware
/// 1982).
struct Population {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};
struct KnownDevice {
  Eigen::MatrixXd data;    ///< H_k
  Eigen::VectorXd target;  ///< H_k z where the data alone would have it
};
/// Begins at this mean and covariance; at least two devices.
[[nodiscard]] Population population_of(const std::vector<KnownDevice>& devices, Population begin);

}  // namespace softland
