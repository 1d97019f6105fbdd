#include "studies/inverse/estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/decompositions.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Returns the inverse of an information matrix, which is symmetric and positive except for rounding. Directions without
// information get very large variances.
MatrixXd inverse(const MatrixXd& matrix) {
  constexpr double least = 1e-13;  // smallest eigenvalue that is used in the inverse, as a share of the largest
  const SymmetricEigen eigen = symmetric_eigen(matrix);
  const double largest = eigen.values[eigen.values.size() - 1];
  const VectorXd inverses = eigen.values.unaryExpr([&](double v) { return 1 / std::max(v, std::max(least * largest, 1e-300)); });
  return eigen.vectors * inverses.asDiagonal() * eigen.vectors.transpose();
}

WeakDirection weak_direction(const VectorXd& vector, double information) {
  constexpr double takes_part = 0.1;
  WeakDirection weak{.direction = vector, .information = std::max(information, 0.0), .unknowns = {}};
  Index largest = 0;
  vector.cwiseAbs().maxCoeff(&largest);
  weak.direction /= vector[largest];
  for (Index i = 0; i < vector.size(); ++i) {
    if (std::abs(weak.direction[i]) >= takes_part) weak.unknowns.push_back(static_cast<std::size_t>(i));
  }
  weak.seen = std::sqrt(weak.information) * weak.direction.norm();
  return weak;
}

}  // namespace

double Estimate::deviation(std::size_t i) const {
  const auto k = static_cast<Index>(i);
  return std::sqrt(covariance(k, k));
}

double Estimate::reduction(const std::vector<VectorXd>& slopes) const {
  MatrixXd after = covariance;
  for (const VectorXd& g : slopes) {
    const VectorXd moved = after * g;
    after -= moved * moved.transpose() / (1 + g.dot(moved));
  }
  return 1 - std::sqrt(std::max(0.0, after.trace()) / covariance.trace());
}

std::vector<WeakDirection> weak_directions(const MatrixXd& data) {
  std::vector<WeakDirection> weak;
  const SymmetricEigen eigen = symmetric_eigen(data);
  for (Index k = 0; k < eigen.values.size() && eigen.values[k] < 1; ++k)
    weak.push_back(weak_direction(eigen.vectors.col(k), eigen.values[k]));
  return weak;
}

Estimate estimate(const MatrixXd& data, const MatrixXd& prior) {
  Estimate found{.data = data, .covariance = inverse(data + prior), .correlation = {}, .weak = {}};
  found.correlation = correlation_of(found.covariance);
  found.weak = weak_directions(data);
  return found;
}

NormalBelief population_of(const std::vector<KnownDevice>& devices, NormalBelief now) {
  constexpr int most_rounds = 2000;
  constexpr double enough = 1e-6, least = 1e-8;
  const Index n = now.mean.size();
  const auto count = static_cast<double>(devices.size());
  for (int round = 0; round < most_rounds; ++round) {
    const MatrixXd before = inverse(now.covariance);
    NormalBelief next{.mean = VectorXd::Zero(n), .covariance = MatrixXd::Zero(n, n)};
    std::vector<VectorXd> means;
    for (const KnownDevice& device : devices) {
      const MatrixXd covariance = inverse(device.data + before);
      means.push_back(covariance * (device.target + before * now.mean));
      next.mean += means.back() / count;
      next.covariance += covariance / count;
    }
    for (const VectorXd& mean : means) next.covariance += (mean - next.mean) * (mean - next.mean).transpose() / count;
    next.covariance.diagonal().array() += least;
    const double change = (next.covariance - now.covariance).cwiseAbs().maxCoeff() + (next.mean - now.mean).cwiseAbs().maxCoeff();
    now = next;
    if (change < enough) break;
  }
  return now;
}

}  // namespace softland
