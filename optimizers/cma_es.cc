// Covariance matrix adaptation evolution strategy, (mu/mu_w, lambda) with rank-one and rank-mu updates and cumulative step length
// control. Draws lambda points m + sigma A z from a normal distribution, moves its mean m to the weighted best half and learns
// its shape from the steps that succeeded. Only the order of the values counts, so that it follows curved valleys over kinks and
// jumps. Points beyond a bound are mirrored back into the box.
// Source: N. Hansen, "The CMA evolution strategy: a tutorial", arXiv:1604.00772, algorithm and default parameters of appendix A,
// without negative weights.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/random.h"
#include "optimizers/backends.h"

namespace softland::internal {
namespace {

// In units of the box; below this the spread of the points is lost in the noise of the objective.
constexpr double kSmallestSpread = 1e-7;

using Matrix = std::vector<double>;  // square, by rows

/// Symmetric `a` = v diag(values) v^T by cyclic Jacobi rotations.
void eigen_decompose(Matrix a, std::size_t n, Matrix& v, std::vector<double>& values) {
  v.assign(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) v[i * n + i] = 1;
  constexpr int kSweeps = 50;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double off_diagonal = 0;
    double diagonal = 0;
    for (std::size_t i = 0; i < n; ++i) {
      diagonal += a[i * n + i] * a[i * n + i];
      for (std::size_t j = i + 1; j < n; ++j) off_diagonal += a[i * n + j] * a[i * n + j];
    }
    if (off_diagonal <= 1e-30 * diagonal) break;
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t q = p + 1; q < n; ++q) {
        if (a[p * n + q] == 0) continue;
        const double theta = (a[q * n + q] - a[p * n + p]) / (2 * a[p * n + q]);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1 / std::hypot(t, 1.0);
        const double s = t * c;
        for (std::size_t k = 0; k < n; ++k) {
          const double kp = a[k * n + p];
          const double kq = a[k * n + q];
          a[k * n + p] = c * kp - s * kq;
          a[k * n + q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < n; ++k) {
          const double pk = a[p * n + k];
          const double qk = a[q * n + k];
          a[p * n + k] = c * pk - s * qk;
          a[q * n + k] = s * pk + c * qk;
        }
        for (std::size_t k = 0; k < n; ++k) {
          const double kp = v[k * n + p];
          const double kq = v[k * n + q];
          v[k * n + p] = c * kp - s * kq;
          v[k * n + q] = s * kp + c * kq;
        }
      }
    }
  }
  values.resize(n);
  for (std::size_t i = 0; i < n; ++i) values[i] = std::max(a[i * n + i], 1e-300);
}

/// Folds the real line onto [0, 1].
double mirror(double u) { return std::abs(std::remainder(u, 2.0)); }

class Normals {
 public:
  explicit Normals(std::uint64_t seed) : seed_(seed) {}
  double operator()() {
    const double radius = std::sqrt(-2 * std::log(1 - random_uniform(seed_, Stream::normals, next_)));
    const double angle = 2 * std::numbers::pi * random_uniform(seed_, Stream::normals, next_ + 1);
    next_ += 2;
    return radius * std::cos(angle);
  }

 private:
  std::uint64_t seed_;
  std::uint64_t next_ = 0;
};

}  // namespace

RunReport run_cma_es(const Run& run, Strand& strand) {
  const std::size_t n = run.start.size();
  const auto dimension = static_cast<double>(n);
  const auto lambda = 4 + static_cast<std::size_t>(3 * std::log(dimension));
  const std::size_t mu = lambda / 2;
  std::vector<double> weights(mu);
  for (std::size_t i = 0; i < mu; ++i) {
    weights[i] = std::log((static_cast<double>(lambda) + 1) / 2) - std::log(static_cast<double>(i) + 1);
  }
  const double weight_sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  double weight_squares = 0;
  for (double& weight : weights) {
    weight /= weight_sum;
    weight_squares += weight * weight;
  }
  const double mu_eff = 1 / weight_squares;
  const double c_sigma = (mu_eff + 2) / (dimension + mu_eff + 5);
  const double d_sigma = 1 + 2 * std::max(0.0, std::sqrt((mu_eff - 1) / (dimension + 1)) - 1) + c_sigma;
  const double c_c = (4 + mu_eff / dimension) / (dimension + 4 + 2 * mu_eff / dimension);
  const double c_1 = 2 / ((dimension + 1.3) * (dimension + 1.3) + mu_eff);
  const double c_mu = std::min(1 - c_1, 2 * (0.25 + mu_eff + 1 / mu_eff - 2) / ((dimension + 2) * (dimension + 2) + mu_eff));
  const double chi = std::sqrt(dimension) * (1 - 1 / (4 * dimension) + 1 / (21 * dimension * dimension));

  Normals normal(run.seed);
  std::vector<double> mean = run.start;
  double sigma = run.step;
  Matrix covariance(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) covariance[i * n + i] = 1;
  Matrix axes = covariance;
  std::vector<double> lengths(n, 1.0);
  std::vector<double> path_sigma(n, 0.0);
  std::vector<double> path_c(n, 0.0);

  struct Child {
    std::vector<double> step;  // (x - mean) / sigma
    double value;
  };
  std::vector<Child> children(lambda);
  strand.begin_search();
  try {
    strand(mean);
    for (long generation = 1;; ++generation) {
      for (Child& child : children) {
        child.step.assign(n, 0.0);
        for (std::size_t k = 0; k < n; ++k) {
          const double z = normal() * lengths[k];
          for (std::size_t i = 0; i < n; ++i) child.step[i] += axes[i * n + k] * z;
        }
        Point point(n);
        for (std::size_t i = 0; i < n; ++i) {
          point[i] = mirror(mean[i] + sigma * child.step[i]);
          child.step[i] = (point[i] - mean[i]) / sigma;
        }
        child.value = strand(point).value;
      }
      std::stable_sort(children.begin(), children.end(), [](const Child& a, const Child& b) { return a.value < b.value; });

      std::vector<double> move(n, 0.0);
      for (std::size_t j = 0; j < mu; ++j) {
        for (std::size_t i = 0; i < n; ++i) move[i] += weights[j] * children[j].step[i];
      }
      for (std::size_t i = 0; i < n; ++i) mean[i] = std::clamp(mean[i] + sigma * move[i], 0.0, 1.0);

      double path_length = 0;
      std::vector<double> whitened(n, 0.0);
      for (std::size_t k = 0; k < n; ++k) {
        double along = 0;
        for (std::size_t i = 0; i < n; ++i) along += axes[i * n + k] * move[i];
        for (std::size_t i = 0; i < n; ++i) whitened[i] += axes[i * n + k] * along / lengths[k];
      }
      for (std::size_t i = 0; i < n; ++i) {
        path_sigma[i] = (1 - c_sigma) * path_sigma[i] + std::sqrt(c_sigma * (2 - c_sigma) * mu_eff) * whitened[i];
        path_length += path_sigma[i] * path_sigma[i];
      }
      path_length = std::sqrt(path_length);
      const double settled = std::sqrt(1 - std::pow(1 - c_sigma, 2.0 * static_cast<double>(generation)));
      const bool stalled = path_length / settled >= (1.4 + 2 / (dimension + 1)) * chi;
      for (std::size_t i = 0; i < n; ++i) {
        path_c[i] = (1 - c_c) * path_c[i] + (stalled ? 0.0 : std::sqrt(c_c * (2 - c_c) * mu_eff)) * move[i];
      }
      const double keep = 1 - c_1 - c_mu + (stalled ? c_1 * c_c * (2 - c_c) : 0.0);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < n; ++k) {
          double rank_mu = 0;
          for (std::size_t j = 0; j < mu; ++j) rank_mu += weights[j] * children[j].step[i] * children[j].step[k];
          covariance[i * n + k] = keep * covariance[i * n + k] + c_1 * path_c[i] * path_c[k] + c_mu * rank_mu;
        }
      }
      sigma *= std::exp(std::min(1.0, c_sigma / d_sigma * (path_length / chi - 1)));
      eigen_decompose(covariance, n, axes, lengths);
      for (double& length : lengths) length = std::sqrt(length);
      const double spread = sigma * *std::max_element(lengths.begin(), lengths.end());
      if (!(spread > kSmallestSpread)) return {.converged = true, .message = "CMA-ES: points have drawn together"};
      if (spread > 2) sigma *= 2 / spread;
    }
  } catch (const Cut&) {
    return {.converged = false, .message = "CMA-ES: stopped by us"};
  }
}

}  // namespace softland::internal
