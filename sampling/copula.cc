#include "sampling/copula.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/decompositions.h"
#include "base/engineering.h"
#include "base/require.h"
#include "base/standard_normal.h"

namespace softland {
namespace {

std::string rounded_text(double value) { return engineering(value, "", 6); }

void require_correlation(bool rule_holds, const std::string& message) { require_of("correlation", rule_holds, message); }

void require_in_range(double value) {
  require(-1 <= value && value <= 1, "a correlation of " + rounded_text(value) + " must be between -1 and 1");
}

// Returns the names of the variables whose elements of an eigenvector are at least half as large as its largest element.
std::string main_parts(const Eigen::VectorXd& vector, const std::vector<std::string>& names) {
  const double largest = vector.cwiseAbs().maxCoeff();
  std::string parts;
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    if (std::abs(vector[i]) >= largest / 2) parts += (parts.empty() ? "" : ", ") + names[static_cast<std::size_t>(i)];
  }
  return parts;
}

}  // namespace

GaussianCopula::GaussianCopula(const Eigen::MatrixXd& correlation, const std::vector<std::string>& names) {
  const Eigen::Index n = correlation.rows();
  require_correlation(n >= 1 && correlation.cols() == n, "a correlation matrix has " + std::to_string(n) + " rows and " +
                                                             std::to_string(correlation.cols()) + " columns; it must be square");
  std::vector<std::string> known = names;
  for (std::size_t i = known.size(); i < static_cast<std::size_t>(n); ++i) known.push_back("variable " + std::to_string(i + 1));
  const auto name = [&](Eigen::Index i) { return known[static_cast<std::size_t>(i)]; };
  for (Eigen::Index i = 0; i < n; ++i) {
    require_correlation(correlation(i, i) == 1, "the correlation of " + name(i) + " with itself is " +
                                                    rounded_text(correlation(i, i)) + "; it must be 1");
    for (Eigen::Index k = 0; k < i; ++k) {
      const double rho = correlation(k, i);
      const std::string pair = "the correlation of " + name(k) + " and " + name(i) + " is " + rounded_text(rho);
      require_correlation(-1 <= rho && rho <= 1, pair + "; it must be between -1 and 1");
      require_correlation(rho == correlation(i, k),
                          pair + " above the diagonal and " + rounded_text(correlation(i, k)) + " below it; both must be equal");
    }
  }
  const SymmetricEigen eigen = symmetric_eigen(correlation);
  const double least = eigen.values[0];
  if (!(least >= least_eigenvalue)) {
    require_correlation(false, "the correlations of " + main_parts(eigen.vectors.col(0), known) +
                                   " contradict each other: the smallest eigenvalue of their matrix is " + rounded_text(least) +
                                   "; it must be at least " + rounded_text(least_eigenvalue));
  }
  factor_ = cholesky_factor(correlation);
}

void GaussianCopula::correlate(std::span<double> u) const {
  require(u.size() == dimensions(), "a point must have one coordinate per dimension of the copula");
  Eigen::VectorXd z(factor_.rows());
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double p = u[static_cast<std::size_t>(i)];
    require(p > 0 && p < 1, "every coordinate of a point must be above 0 and below 1");
    z[i] = standard_normal_quantile(p);
  }
  for (Eigen::Index i = 1; i < z.size(); ++i) {  // the first variable does not change: v_1 = u_1
    const double correlated = factor_.row(i).head(i + 1).dot(z.head(i + 1));
    u[static_cast<std::size_t>(i)] = std::clamp(standard_normal_cdf(correlated), 0x1p-53, 1 - 0x1p-53);
  }
}

double rank_correlation(double correlation) {
  require_in_range(correlation);
  return 6 / std::numbers::pi * std::asin(correlation / 2);
}

double correlation_of_ranks(double rank_correlation) {
  require_in_range(rank_correlation);
  return 2 * std::sin(std::numbers::pi / 6 * rank_correlation);
}

}  // namespace softland
