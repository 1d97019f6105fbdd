// Covariance matrix adaptation evolution strategy, (mu/mu_w, lambda) with rank-one and rank-mu updates and cumulative step length
// control. Draws lambda points m + sigma A z from a normal distribution, moves its mean m to the weighted best half and learns
// its shape from the steps that succeeded. Only the order of the values counts, so that it follows curved valleys over kinks and
// jumps. Points beyond a bound are mirrored back into the box.
// Source: N. Hansen, "The CMA evolution strategy: a tutorial", arXiv:1604.00772, algorithm and default parameters of appendix A,
// without negative weights.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/random.h"
#include "optimizers/backends.h"

namespace softland::internal {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// In units of the box; below this the spread of the points is lost in the noise of the objective.
constexpr double smallest_spread = 1e-7;

/// Folds the real line onto [0, 1].
double mirror(double u) { return std::abs(std::remainder(u, 2.0)); }

/// Weights of the better half of lambda children, the best first; they add up to 1.
VectorXd recombination_weights(Eigen::Index lambda) {
  const Eigen::ArrayXd rank = Eigen::ArrayXd::LinSpaced(lambda / 2, 1, static_cast<double>(lambda / 2));
  const VectorXd weights = std::log((static_cast<double>(lambda) + 1) / 2) - rank.log();
  return weights / weights.sum();
}

}  // namespace

RunReport run_cma_es(const Run& run, Strand& strand) {
  const auto n = static_cast<Eigen::Index>(run.start.size());
  const auto dimension = static_cast<double>(n);
  const auto lambda = 4 + static_cast<Eigen::Index>(3 * std::log(dimension));
  const VectorXd weights = recombination_weights(lambda);
  const double mu_eff = 1 / weights.squaredNorm();
  const double c_sigma = (mu_eff + 2) / (dimension + mu_eff + 5);
  const double d_sigma = 1 + 2 * std::max(0.0, std::sqrt((mu_eff - 1) / (dimension + 1)) - 1) + c_sigma;
  const double c_c = (4 + mu_eff / dimension) / (dimension + 4 + 2 * mu_eff / dimension);
  const double c_1 = 2 / ((dimension + 1.3) * (dimension + 1.3) + mu_eff);
  const double c_mu = std::min(1 - c_1, 2 * (0.25 + mu_eff + 1 / mu_eff - 2) / ((dimension + 2) * (dimension + 2) + mu_eff));
  const double chi = std::sqrt(dimension) * (1 - 1 / (4 * dimension) + 1 / (21 * dimension * dimension));

  const auto evaluate = [&](const VectorXd& point) { return strand({point.data(), run.start.size()}).value; };
  std::uint64_t drawn = 0;
  const auto normal = [&] { return random_normal(run.seed, Stream::normals, drawn++); };
  VectorXd mean = VectorXd::Map(run.start.data(), n);
  double sigma = run.step;
  // The points lie about the mean as sigma axes diag(lengths) z does, with z from the standard normal distribution. The
  // covariance without sigma is axes diag(lengths)^2 axes^T; its lower triangle is kept.
  MatrixXd covariance = MatrixXd::Identity(n, n), axes = covariance;
  VectorXd lengths = VectorXd::Ones(n), path_sigma = VectorXd::Zero(n), path_c = path_sigma;
  Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(n);

  struct Child {
    VectorXd step;  // (point - mean) / sigma
    double value;
  };
  std::vector<Child> children(static_cast<std::size_t>(lambda));
  strand.begin_search();
  try {
    evaluate(mean);
    for (long generation = 1;; ++generation) {
      for (Child& child : children) {
        const VectorXd z = VectorXd::NullaryExpr(n, normal);
        const VectorXd point = (mean + sigma * axes * lengths.cwiseProduct(z)).unaryExpr(&mirror);
        child = {.step = (point - mean) / sigma, .value = evaluate(point)};
      }
      std::stable_sort(children.begin(), children.end(), [](const Child& a, const Child& b) { return a.value < b.value; });

      VectorXd move = VectorXd::Zero(n);
      for (Eigen::Index j = 0; j < weights.size(); ++j) move += weights[j] * children[static_cast<std::size_t>(j)].step;
      mean = (mean + sigma * move).cwiseMax(0.0).cwiseMin(1.0);

      const VectorXd whitened = axes * (axes.transpose() * move).cwiseQuotient(lengths);
      path_sigma = (1 - c_sigma) * path_sigma + std::sqrt(c_sigma * (2 - c_sigma) * mu_eff) * whitened;
      const double settled = std::sqrt(1 - std::pow(1 - c_sigma, 2.0 * static_cast<double>(generation)));
      const bool stalled = path_sigma.norm() / settled >= (1.4 + 2 / (dimension + 1)) * chi;
      path_c = (1 - c_c) * path_c + (stalled ? 0.0 : std::sqrt(c_c * (2 - c_c) * mu_eff)) * move;

      covariance *= 1 - c_1 - c_mu + (stalled ? c_1 * c_c * (2 - c_c) : 0.0);
      auto lower = covariance.selfadjointView<Eigen::Lower>();
      lower.rankUpdate(path_c, c_1);
      for (Eigen::Index j = 0; j < weights.size(); ++j)
        lower.rankUpdate(children[static_cast<std::size_t>(j)].step, c_mu * weights[j]);
      eigen.compute(covariance);
      axes = eigen.eigenvectors();
      // Eigenvalues that are smaller still are rounding errors of the largest.
      const double smallest = std::numeric_limits<double>::epsilon() * eigen.eigenvalues().maxCoeff();
      lengths = eigen.eigenvalues().cwiseMax(smallest).cwiseSqrt();

      sigma *= std::exp(std::min(1.0, c_sigma / d_sigma * (path_sigma.norm() / chi - 1)));
      const double spread = sigma * lengths.maxCoeff();
      if (!(spread > smallest_spread)) return {.converged = true, .message = "CMA-ES: points have drawn together"};
      if (spread > 2) sigma *= 2 / spread;
    }
  } catch (const Cut&) {
    return {.converged = false, .message = "CMA-ES: stopped by us"};
  }
}

}  // namespace softland::internal
