// Gaussian copula: uniform variables that depend on each other as normal variables of a given correlation do.
//
//   v_i = Phi((L z)_i),   z_i = Phi^-1(u_i),   L L^T = R
//
// u, v are uniform in (0, 1), Phi is the standard normal distribution, R the correlation matrix, L its lower Cholesky factor:
// v_1 = u_1. R is the correlation of the underlying normal variables. If the variables have other distributions, their own
// correlation is smaller in size. With rho an element of R, the rank correlation of the variables (Spearman) is rho_S = 6/pi
// asin(rho / 2), and Kendall's tau is 2/pi asin(rho), for any distributions. Extreme values of two variables are independent in
// the limit for any rho < 1 (no tail dependence). rho = +-1 is refused, because R is then singular: the two variables are one.
// Source: R. B. Nelsen, "An Introduction to Copulas", 2nd ed. 2006; W. H. Kruskal, J. Am. Stat. Assoc. 53 (1958) 814 (ranks).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace softland {

class GaussianCopula {
 public:
  /// The least eigenvalue that the correlation matrix may have.
  static constexpr double least_eigenvalue = 1e-10;

  /// Takes the correlation matrix of the underlying normal variables. Messages call the variables by `names`, or "variable 1",
  /// ... without names. Throws InvalidParameter for `correlation` unless the matrix is square and symmetric with a unit
  /// diagonal, all other elements are between -1 and 1, and all eigenvalues are at least least_eigenvalue. The message names
  /// the variables whose correlations break the rule.
  explicit GaussianCopula(const Eigen::MatrixXd& correlation, const std::vector<std::string>& names = {});

  [[nodiscard]] std::size_t dimensions() const { return static_cast<std::size_t>(factor_.rows()); }

  /// Turns independent numbers u into correlated numbers, in place; the results are between 2^-53 and 1 - 2^-53. Throws
  /// InvalidInput unless u has one number per dimension, each above 0 and below 1.
  void correlate(std::span<double> u) const;

 private:
  Eigen::MatrixXd factor_;  // lower triangular Cholesky factor of the correlation matrix
};

/// Convert the correlation of underlying normal variables to Spearman's rank correlation, and the rank correlation back,
/// 2 sin(pi rho_S / 6). Throw InvalidInput unless the argument is between -1 and 1.
[[nodiscard]] double rank_correlation(double correlation);
[[nodiscard]] double correlation_of_ranks(double rank_correlation);

}  // namespace softland
