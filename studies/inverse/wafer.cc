#include "studies/inverse/wafer.h"

#include <cmath>
#include <vector>

#include "base/decompositions.h"
#include "base/require.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The result of tuning a device as a linear measurement y = J z + n of its coordinates z: `rows` is J, `values` is y.
struct LinearMeasurement {
  MatrixXd rows;
  VectorXd values;
};

void check(const NormalBelief& belief, Index size) {
  const MatrixXd& c = belief.covariance;
  require(belief.mean.size() == size && c.rows() == size && c.cols() == size && belief.mean.allFinite() && c.allFinite() &&
              symmetric_eigen(c).values.minCoeff() > 0,
          "a belief about a tuned device must have finite coordinates of this scene, and a positive definite covariance");
}

LinearMeasurement measurement_of(const TunedBelief& tuned) {
  // Largest variance of a measured direction, as a share of the prior's variance. The variance of samples without information
  // scatters around 1.
  constexpr double measured_share = 0.5;
  const Index n = tuned.prior.mean.size();
  const MatrixXd inverse = whitening_of(tuned.prior.covariance);
  const VectorXd mean = inverse * (tuned.posterior.mean - tuned.prior.mean);
  const SymmetricEigen eigen = symmetric_eigen(inverse * tuned.posterior.covariance * inverse.transpose());
  std::vector<Index> measured;
  for (Index k = 0; k < n; ++k) {
    if (eigen.values[k] < measured_share) measured.push_back(k);
  }
  LinearMeasurement all{.rows = MatrixXd(static_cast<Index>(measured.size()), n),
                        .values = VectorXd(static_cast<Index>(measured.size()))};
  for (Index i = 0; i < all.values.size(); ++i) {
    const Index k = measured[static_cast<std::size_t>(i)];
    // Precision (inverse variance) from the records alone: the precision of the prior, 1 in these units, is subtracted.
    const double variance = eigen.values[k], precision = 1 / variance - 1;
    const VectorXd direction = eigen.vectors.col(k);
    all.rows.row(i) = std::sqrt(precision) * direction.transpose() * inverse;
    all.values[i] = direction.dot(mean) / variance / std::sqrt(precision) + all.rows.row(i).dot(tuned.prior.mean);
  }
  return all;
}

}  // namespace

WaferBelief believed_of_wafer(std::span<const TunedBelief> tuned, Index size) {
  std::vector<LinearMeasurement> all;
  Index count = 0;
  for (const TunedBelief& one : tuned) {
    check(one.prior, size);
    check(one.posterior, size);
    all.push_back(measurement_of(one));
    count += all.back().values.size();
  }
  // J (directions in z) of the measurements on all devices. `own` has a diagonal block J J^T for each device.
  MatrixXd rows(count, size), own = MatrixXd::Zero(count, count);
  VectorXd values(count);
  Index begin = 0;
  for (const LinearMeasurement& one : all) {
    const Index m = one.values.size();
    rows.middleRows(begin, m) = one.rows;
    values.segment(begin, m) = one.values;
    own.block(begin, begin, m, m) = one.rows * one.rows.transpose();
    begin += m;
  }
  constexpr int steps = 40;
  constexpr double least_apart = 0.03;  // smallest standard deviation within a wafer, as a share of that of all devices
  const MatrixXd identity = MatrixXd::Identity(count, count), shared = rows * rows.transpose();
  std::vector<double> shares, logarithms;
  std::vector<NormalBelief> nexts;
  for (int s = 0; s <= steps; ++s) {
    const double rho = 1 - std::pow(least_apart, 2.0 * s / steps);
    const MatrixXd factor = cholesky_factor(identity + (1 - rho) * own + rho * shared);
    MatrixXd whitened(count, size);
    for (Index k = 0; k < size; ++k) whitened.col(k) = solve_linear(factor, rows.col(k));
    const VectorXd residual = solve_linear(factor, values);
    shares.push_back(rho);
    logarithms.push_back(-factor.diagonal().array().log().sum() - residual.squaredNorm() / 2);
    nexts.push_back({.mean = rho * whitened.transpose() * residual,
                     .covariance = MatrixXd::Identity(size, size) - rho * rho * whitened.transpose() * whitened});
  }
  const std::vector<double> weights = weights_of(logarithms).values;
  WaferBelief wafer{.next = moments_of(weights, nexts)};
  for (std::size_t s = 0; s < nexts.size(); ++s) wafer.share += weights[s] * shares[s];
  return wafer;
}

}  // namespace softland
