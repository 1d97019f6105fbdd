// The prediction for the next device of a wafer from tuned ones.
//
// The coordinates z of each device are standard normal (tuned_scene.h). Devices of one wafer share an unknown part rho of the
// variance:
//
//   z_i = w + e_i,   w ~ N(0, rho I) of the wafer,   e_i ~ N(0, (1 - rho) I) of each device
//
// A tuning leaves a belief about z_i, normal with mean m and covariance C, from a prior with mean and covariance of its own.
// Consider the eigenvectors of C in units of that prior whose eigenvalue is below a half. Along them the belief is a
// measurement y = J z_i + n, n ~ N(0, I); the other directions are not measured. All measurements and the next z are normal
// together. The result is the next z under these y, for every rho of a grid, with the likelihood of y as its weight. The prior
// is on sqrt(1 - rho), the deviation of the devices of a wafer over that of all: it is uniform from 0.03 to 1 on a logarithmic
// scale.
//
// Source: empirical Bayes for groups, D. V. Lindley & A. F. M. Smith, J. R. Stat. Soc. B 34 (1972) 1.
#pragma once

#include <Eigen/Core>
#include <span>

namespace softland {

/// A normal distribution of z.
struct NormalBelief {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// The beliefs before and after a tuning.
struct TunedBelief {
  NormalBelief prior, posterior;
};

struct WaferBelief {
  NormalBelief next;  ///< belief about a device that was not tuned yet
  double share = 0;   ///< mean of rho
};

/// Throws InvalidInput unless all beliefs are finite, of `size` coordinates and with positive definite covariances.
[[nodiscard]] WaferBelief believed_of_wafer(std::span<const TunedBelief> tuned, Eigen::Index size);

}  // namespace softland
