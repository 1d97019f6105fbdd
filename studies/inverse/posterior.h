// The belief about the unknowns of a device, before and after measurements. `fit` and `tune` have the same posterior of the
// coordinates z, in which one standard deviation of the prior is 1:
//
//   -ln p(z | data) = z^T P z / 2 + sum over data of L(r_i(z)) + const,   r_i = (y_i(z) - m_i) / s_i
// The symbols are: y_i prediction, m_i measured value, s_i its standard deviation, L = rho(r^2) / 2 with the robust loss rho
// (least_squares.h), P inverse correlation of the prior. `fit` and `tune` differ as follows:
//
//   fit    y: readings of instruments with exact derivatives (studies/devices/instruments.h); s: from the bench file; value of
//          an unknown: mean + deviation z; P: correlations of [spread]. One normal distribution at the minimum.
//   tune   y: first contact of a whole closing, computed in SIMD lanes for many devices, with finite differences; s: grows as
//          the switch slows down; further terms for openings and sound; value of an unknown: exact quantile of its
//          distribution, so that P = I. The posterior has several peaks: a normal distribution at the best peak, then weighted
//          points.
// `calibrate` uses the instruments of `fit`, without derivatives, on known devices. It has no posterior of z: it finds the
// figures that predict the factors of a waveform, and fits these factors themselves.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>
#include <vector>

namespace softland {

/// A normal distribution of the coordinates z of a device.
struct NormalBelief {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;

  [[nodiscard]] static NormalBelief standard(Eigen::Index size);
  [[nodiscard]] double deviation(Eigen::Index i) const { return std::sqrt(covariance(i, i)); }
  /// Returns the normal distribution of origin + factor z if z has this distribution.
  [[nodiscard]] NormalBelief mapped(const Eigen::VectorXd& origin, const Eigen::MatrixXd& factor) const;
};

/// Returns the matrix of correlations that belongs to a covariance matrix.
[[nodiscard]] Eigen::MatrixXd correlation_of(const Eigen::MatrixXd& covariance);
/// Returns L^-1, where L L^T is the covariance: L^-1 (z - mean) is standard normal.
[[nodiscard]] Eigen::MatrixXd whitening_of(const Eigen::MatrixXd& covariance);

/// Weights of points or of distributions that represent the belief; their sum is 1.
struct Weights {
  std::vector<double> values;
  double effective = 0;  ///< effective number of points: (sum of weights)^2 divided by the sum of squared weights
};
/// Returns weights in proportion to exp(power * logarithm), one for each of `logarithms`; more even if `power` is below 1.
[[nodiscard]] Weights weights_of(std::span<const double> logarithms, double power = 1);

/// Returns mean and covariance of weighted points z.
[[nodiscard]] NormalBelief moments_of(std::span<const double> weights, std::span<const Eigen::VectorXd> points);
/// Returns mean and covariance of a weighted mixture of normal distributions.
[[nodiscard]] NormalBelief moments_of(std::span<const double> weights, std::span<const NormalBelief> mixed);

}  // namespace softland
