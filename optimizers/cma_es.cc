// Covariance matrix adaptation evolution strategy, (mu/mu_w, lambda) with rank-one and rank-mu updates and cumulative step
// length control. It draws lambda points m + sigma A z with z standard normal, moves the mean m to the weighted mean of the
// better half, and adapts step length sigma and shape A to the steps that succeeded. Only the order of the objective values
// counts, so that the method follows curved valleys over kinks and jumps. Points beyond a bound are mirrored back into the box.
// Source: N. Hansen, "The CMA evolution strategy: a tutorial", arXiv:1604.00772, algorithm and default parameters of appendix
// A, without negative weights.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/decompositions.h"
#include "base/random.h"
#include "optimizers/backends.h"

namespace softland::internal {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Standard deviation of the sampled points, in units of the box, below which CMA-ES has converged: between closer points the
// noise of the objective would hide the differences.
constexpr double smallest_spread = 1e-7;

/// Moves a coordinate of a sampled point into [0, 1] by mirroring at the bounds, as often as needed.
double mirror(double u) { return std::abs(std::remainder(u, 2.0)); }

/// Returns the weights by which the better half of lambda sampled points (children) enter the new mean, for the best point
/// first; the weights add up to 1.
VectorXd recombination_weights(Eigen::Index lambda) {
  const Eigen::Index mu = lambda / 2;
  const Eigen::ArrayXd rank = Eigen::ArrayXd::LinSpaced(mu, 1, static_cast<double>(mu));
  const VectorXd weights = std::log((static_cast<double>(lambda) + 1) / 2) - rank.log();
  return weights / weights.sum();
}

// The constants of the evolution strategy, with the names and values of N. Hansen's tutorial.
struct Strategy {
  Strategy(Eigen::Index n, double population)
      : dimension(static_cast<double>(n)),
        lambda(static_cast<Eigen::Index>(population * (4 + std::floor(3 * std::log(dimension))))),
        weights(recombination_weights(lambda)),
        mu_eff(1 / weights.squaredNorm()),
        c_sigma((mu_eff + 2) / (dimension + mu_eff + 5)),
        d_sigma(1 + 2 * std::max(0.0, std::sqrt((mu_eff - 1) / (dimension + 1)) - 1) + c_sigma),
        c_c((4 + mu_eff / dimension) / (dimension + 4 + 2 * mu_eff / dimension)),
        c_1(2 / ((dimension + 1.3) * (dimension + 1.3) + mu_eff)),
        c_mu(std::min(1 - c_1, 2 * (0.25 + mu_eff + 1 / mu_eff - 2) / ((dimension + 2) * (dimension + 2) + mu_eff))),
        chi(std::sqrt(dimension) * (1 - 1 / (4 * dimension) + 1 / (21 * dimension * dimension))) {}

  double dimension;
  Eigen::Index lambda;
  VectorXd weights;
  double mu_eff, c_sigma, d_sigma, c_c, c_1, c_mu, chi;
};

struct Child {
  VectorXd step;  // (point - mean) / sigma of the sampled point
  double value;
};

// The normal distribution from which points are drawn: mean + sigma axes diag(lengths) z, with z standard normal. The
// covariance without sigma is axes diag(lengths)^2 axes^T; only its lower triangle is stored.
class Distribution {
 public:
  Distribution(const Strategy& strategy, VectorXd mean, double sigma)
      : strategy_(strategy),
        mean_(std::move(mean)),
        sigma_(sigma),
        covariance_(MatrixXd::Identity(mean_.size(), mean_.size())),
        axes_(covariance_),
        lengths_(VectorXd::Ones(mean_.size())),
        path_sigma_(VectorXd::Zero(mean_.size())),
        path_c_(path_sigma_) {}

  [[nodiscard]] const VectorXd& mean() const { return mean_; }
  [[nodiscard]] VectorXd point(const VectorXd& z) const {
    return (mean_ + sigma_ * axes_ * lengths_.cwiseProduct(z)).unaryExpr(&mirror);
  }
  [[nodiscard]] VectorXd step_to(const VectorXd& point) const { return (point - mean_) / sigma_; }
  [[nodiscard]] double spread() const { return sigma_ * lengths_.maxCoeff(); }
  void shrink(double factor) { sigma_ *= factor; }

  // Moves the mean to the weighted mean of the best sampled points (children), and adapts the distribution to the steps from
  // the old mean to these points. The children are sorted, the best first.
  void learn(const std::vector<Child>& children, long generation) {
    const Strategy& s = strategy_;
    VectorXd move = VectorXd::Zero(mean_.size());
    for (Eigen::Index j = 0; j < s.weights.size(); ++j) move += s.weights[j] * children[static_cast<std::size_t>(j)].step;
    mean_ = (mean_ + sigma_ * move).cwiseMax(0.0).cwiseMin(1.0);

    const VectorXd whitened = axes_ * (axes_.transpose() * move).cwiseQuotient(lengths_);
    path_sigma_ = (1 - s.c_sigma) * path_sigma_ + std::sqrt(s.c_sigma * (2 - s.c_sigma) * s.mu_eff) * whitened;
    const double settled = std::sqrt(1 - std::pow(1 - s.c_sigma, 2.0 * static_cast<double>(generation)));
    const bool stalled = path_sigma_.norm() / settled >= (1.4 + 2 / (s.dimension + 1)) * s.chi;
    path_c_ = (1 - s.c_c) * path_c_ + (stalled ? 0.0 : std::sqrt(s.c_c * (2 - s.c_c) * s.mu_eff)) * move;

    covariance_ *= 1 - s.c_1 - s.c_mu + (stalled ? s.c_1 * s.c_c * (2 - s.c_c) : 0.0);
    auto lower = covariance_.selfadjointView<Eigen::Lower>();
    lower.rankUpdate(path_c_, s.c_1);
    for (Eigen::Index j = 0; j < s.weights.size(); ++j)
      lower.rankUpdate(children[static_cast<std::size_t>(j)].step, s.c_mu * s.weights[j]);
    const SymmetricEigen eigen = symmetric_eigen(covariance_);
    axes_ = eigen.vectors;
    // Raise eigenvalues of the covariance to this limit: smaller ones are rounding errors of the largest eigenvalue.
    const double smallest = std::numeric_limits<double>::epsilon() * eigen.values.maxCoeff();
    lengths_ = eigen.values.cwiseMax(smallest).cwiseSqrt();

    sigma_ *= std::exp(std::min(1.0, s.c_sigma / s.d_sigma * (path_sigma_.norm() / s.chi - 1)));
  }

 private:
  const Strategy& strategy_;
  VectorXd mean_;
  double sigma_;
  MatrixXd covariance_, axes_;
  VectorXd lengths_, path_sigma_, path_c_;
};

}  // namespace

RunReport run_cma_es(const RunOptions& run, BudgetedObjective& budgeted) {
  const auto n = static_cast<Eigen::Index>(run.start.size());
  const Strategy strategy(n, run.population);
  Distribution points(strategy, VectorXd::Map(run.start.data(), n), run.step);
  const auto evaluate = [&](const VectorXd& point) { return budgeted({point.data(), run.start.size()}).value; };
  std::uint64_t drawn = 0;
  const auto normal = [&] { return random_normal(run.seed, Stream::normals, drawn++); };
  std::vector<Child> children(static_cast<std::size_t>(strategy.lambda));
  budgeted.begin_search();
  try {
    evaluate(points.mean());
    for (long generation = 1;; ++generation) {
      for (Child& child : children) {
        const VectorXd point = points.point(VectorXd::NullaryExpr(n, normal));
        child = {.step = points.step_to(point), .value = evaluate(point)};
      }
      std::stable_sort(children.begin(), children.end(), [](const Child& a, const Child& b) { return a.value < b.value; });
      points.learn(children, generation);
      const double spread = points.spread();
      if (!(spread > smallest_spread))
        return {.converged = true, .message = "CMA-ES: the spread of the points is below the tolerance"};
      if (spread > 2) points.shrink(2 / spread);
    }
  } catch (const Cut&) {
    return {.converged = false, .message = "CMA-ES: stopped by softland"};
  }
}

}  // namespace softland::internal
