// Polynomial chaos: approximates a figure of merit by a sum of polynomials, which are orthonormal over the distribution of the
// variables.
//
//   y(xi) = sum c_a psi_a(xi),   psi_a(xi) = prod psi_(a_i)(xi_i),   |a| = sum a_i <= p
//
// xi_i are independent germs: uniform in (-1, 1) with Legendre polynomials, or standard normal with Hermite's. c_0 is the mean,
// sum_(a != 0) c_a^2 the variance. The share of the terms that hold xi_i alone in this variance is Sobol's first-order index of
// variable i, and the share of all terms that hold xi_i its total index (B. Sudret, Reliability Engineering & System Safety 93
// (2008) 964).
//
// Choice of terms: orthogonal matching pursuit begins with the constant, and adds the term with which the residual correlates
// most. The number k of terms, at most half the number of figures y_i, and the degree p are those that predict best in a
// tenfold cross-validation. It predicts each tenth of the figures from the others alone, by terms that were chosen without it,
//
//   q2 = 1 - sum (y_i - prediction_i)^2 / sum (y_i - mean)^2
//
// Leave-one-out errors of a fit with all figures and given terms would be cheaper but too optimistic: 60 random numbers would
// get 29 terms and a q2 of 0.6. The choice of k and p still makes q2 too high, by 0.1 to 0.2 times 1 - q2. q2 is 1 for a
// polynomial, and near or below 0 where the sum predicts no better than the mean. Degrees are tried up to `most_degree`, as
// long as there are at most ten times as many terms as figures. The sum converges slowly, and q2 is low, for a figure that
// jumps or whose slope jumps.
//
// Sources: N. Agarwal & N. R. Aluru, Journal of Microelectromechanical Systems 18 (2009) 1454 (electrostatic MEMS); G. Blatman
// & B. Sudret, Journal of Computational Physics 230 (2011) 2345 (sparse terms); Y. C. Pati, R. Rezaiifar & P. S. Krishnaprasad,
// 27th Asilomar Conference, 1993, 40 (matching pursuit); M. Stone, J. R. Stat. Soc. B 36 (1974) 111 (cross-validation).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "base/choice.h"

namespace softland {

enum class Germ { uniform, normal };

inline constexpr std::array germs{
    Named<Germ>{Germ::uniform, "uniform"},
    Named<Germ>{Germ::normal, "normal"},
};
static_assert(is_complete<germs>());

class PolynomialChaos {
 public:
  /// Fits the sum to figures. Row j of `points`, in the open unit cube, is the point of figure j; the germ (standard variable)
  /// of a coordinate u is 2 u - 1 if uniform, Phi^-1(u) if normal. Throws InvalidParameter: `points` unless the points are
  /// inside the cube, with a column for each germ; `figures` unless they are finite, at least four, and as many as points;
  /// `most_degree` unless it is between 1 and 50.
  PolynomialChaos(const std::vector<Germ>& germs_of_variables, const Eigen::MatrixXd& points, std::span<const double> figures,
                  int most_degree = 10);

  [[nodiscard]] std::size_t dimensions() const { return germs_.size(); }
  /// Largest degree of the chosen terms; 0 when no term predicts better than the mean.
  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] std::size_t terms() const { return terms_.size(); }  ///< number of polynomial terms, including the constant
  /// Share q2 of the variance of the figures that the sum predicts in cross-validation; NaN when all figures are equal.
  [[nodiscard]] double q2() const { return q2_; }

  /// Returns the value of the polynomial sum at a point of the open unit cube. Throws InvalidInput unless `u` has dimensions()
  /// coordinates, all inside.
  [[nodiscard]] double operator()(std::span<const double> u) const;

  [[nodiscard]] double mean() const { return coefficients_[0]; }
  [[nodiscard]] double variance() const;
  /// Return the first-order and the total Sobol' index of variable i; NaN where the variance is zero. Throw InvalidInput unless
  /// i < dimensions().
  [[nodiscard]] double first_order(std::size_t i) const;
  [[nodiscard]] double total(std::size_t i) const;

 private:
  std::vector<Germ> germs_;
  int degree_ = 0;
  double q2_ = 0;
  std::vector<std::vector<int>> terms_;  // exponents of each polynomial term, the constant first
  std::vector<double> coefficients_;     // coefficients of the polynomial terms
};

}  // namespace softland
