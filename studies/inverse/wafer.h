// Predicts the next device of a wafer from the devices of the same wafer that were tuned before.
//
// The coordinates z of each device are standard normal (tuning_model.h). Devices of one wafer share an unknown part rho of the
// variance:
//
//   z_i = w + e_i,   w ~ N(0, rho I) of the wafer,   e_i ~ N(0, (1 - rho) I) of each device
//
// A tuning yields a belief about z_i, normal with mean m and covariance C, from a prior with its own mean and covariance. The
// measured directions are the eigenvectors of C, in units of that prior, with an eigenvalue below a half. Along these
// directions the belief is a measurement y = J z_i + n, n ~ N(0, I). All measurements and the next z are jointly normal. The
// result is the next z given all y, for every rho of a grid, weighted by the likelihood of y. The prior is on sqrt(1 - rho),
// the standard deviation within a wafer over that of all devices: uniform from 0.03 to 1 on a logarithmic scale.
//
// Source: empirical Bayes for groups, D. V. Lindley & A. F. M. Smith, J. R. Stat. Soc. B 34 (1972) 1.
#pragma once

#include <Eigen/Core>
#include <span>

#include "studies/inverse/posterior.h"

namespace softland {

/// The beliefs about a device before and after its tuning.
struct TunedBelief {
  NormalBelief prior, posterior;
};

struct WaferBelief {
  NormalBelief next;  ///< belief about the next device of the wafer, before its tuning
  double share = 0;   ///< posterior mean of rho, the part of the variance of z that devices of the wafer share
};

/// Returns the belief about the next device, given the beliefs `tuned`. Throws InvalidInput unless all beliefs are finite, have
/// `size` coordinates and positive definite covariances.
[[nodiscard]] WaferBelief believed_of_wafer(std::span<const TunedBelief> tuned, Eigen::Index size);

}  // namespace softland
