#include "studies/inverse/posterior.h"

#include <algorithm>
#include <cmath>

#include "base/decompositions.h"

namespace softland {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

NormalBelief NormalBelief::standard(Index size) {
  return {.mean = VectorXd::Zero(size), .covariance = MatrixXd::Identity(size, size)};
}

NormalBelief NormalBelief::mapped(const VectorXd& origin, const MatrixXd& factor) const {
  return {.mean = origin + factor * mean, .covariance = factor * covariance * factor.transpose()};
}

MatrixXd correlation_of(const MatrixXd& covariance) {
  const VectorXd deviations = covariance.diagonal().cwiseSqrt();
  return deviations.cwiseInverse().asDiagonal() * covariance * deviations.cwiseInverse().asDiagonal();
}

MatrixXd whitening_of(const MatrixXd& covariance) {
  const MatrixXd factor = cholesky_factor(covariance);
  MatrixXd inverse(factor.rows(), factor.rows());
  for (Index k = 0; k < inverse.cols(); ++k) inverse.col(k) = solve_linear(factor, VectorXd::Unit(inverse.rows(), k));
  return inverse;
}

Weights weights_of(std::span<const double> logarithms, double power) {
  const double largest = *std::ranges::max_element(logarithms);
  Weights weights;
  double sum = 0, squares = 0;
  for (const double logarithm : logarithms) {
    weights.values.push_back(std::exp(power * (logarithm - largest)));
    sum += weights.values.back(), squares += weights.values.back() * weights.values.back();
  }
  for (double& weight : weights.values) weight /= sum;
  weights.effective = sum * sum / squares;
  return weights;
}

NormalBelief moments_of(std::span<const double> weights, std::span<const VectorXd> points) {
  const Index n = points.front().size();
  NormalBelief found{.mean = VectorXd::Zero(n), .covariance = MatrixXd::Zero(n, n)};
  for (std::size_t k = 0; k < points.size(); ++k) found.mean += weights[k] * points[k];
  for (std::size_t k = 0; k < points.size(); ++k) {
    const VectorXd off = points[k] - found.mean;
    found.covariance += weights[k] * off * off.transpose();
  }
  return found;
}

NormalBelief moments_of(std::span<const double> weights, std::span<const NormalBelief> mixed) {
  const Index n = mixed.front().mean.size();
  NormalBelief found{.mean = VectorXd::Zero(n), .covariance = MatrixXd::Zero(n, n)};
  for (std::size_t k = 0; k < mixed.size(); ++k) found.mean += weights[k] * mixed[k].mean;
  for (std::size_t k = 0; k < mixed.size(); ++k) {
    const VectorXd off = mixed[k].mean - found.mean;
    found.covariance += weights[k] * (mixed[k].covariance + off * off.transpose());
  }
  return found;
}

}  // namespace softland
