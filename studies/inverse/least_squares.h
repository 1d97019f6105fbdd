// Nonlinear least squares with a robust loss, by Ceres (Agarwal, Mierle and others, ceres-solver.org): Levenberg and Marquardt's
// method in a trust region, with a dense QR decomposition. Ceres is a module of its own (ceres_module.h), loaded at the first
// use.
//
//   minimise  sum over the first `robust` residuals of rho(r_i^2) + sum over the others of r_i^2
//
//   huber     rho(s) = s up to a^2, 2 a sqrt(s) - a^2 beyond        (Huber 1964)
//   cauchy    rho(s) = a^2 ln(1 + s / a^2)
//   none      rho(s) = s
//
// Residuals are in standard deviations, and so is a.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/choice.h"
#include "base/watch.h"

namespace softland {

enum class Loss { huber, cauchy, none };
inline constexpr std::array losses{Named<Loss>{Loss::huber, "huber"}, Named<Loss>{Loss::cauchy, "cauchy"},
                                   Named<Loss>{Loss::none, "none"}};
static_assert(is_complete<losses>());

/// Residuals from which on the loss deviates from squares.
inline constexpr double loss_scale = 3;
/// rho'(r^2): the weight that the residual has in the information.
[[nodiscard]] double loss_weight(Loss loss, double residual);
/// rho(r^2).
[[nodiscard]] double loss_value(Loss loss, double residual);

struct LeastSquares {
  std::size_t unknowns = 0, residuals = 0;
  std::size_t robust = 0;  ///< number of first residuals under the loss
  Loss loss = Loss::huber;
  /// Writes the residuals at x and, if `jacobian` is not null, their derivatives, row by row. False if they do not exist.
  std::function<bool(std::span<const double> x, std::span<double> residuals, double* jacobian)> evaluate;
};

struct LeastSquaresEnd {
  bool converged = false;      ///< true at a point from which no step helps
  std::vector<double> x = {};  ///< empty if the start has no residuals
  double cost = 0;             ///< half of the minimised sum
  long evaluations = 0, with_jacobian = 0;
  std::string message = {};  ///< message of Ceres
};

/// True if Ceres is available.
[[nodiscard]] bool has_ceres();

/// Minimises from this start. The result does not depend on other solves at the same time. Throws what `evaluate` throws,
/// Interrupted, and InvalidInput if Ceres is not available.
[[nodiscard]] LeastSquaresEnd solve(const LeastSquares& problem, std::vector<double> start, const Watch& watch = {});

/// The ends of searches from several starts. The number of threads does not change them.
struct ManyEnds {
  std::vector<LeastSquaresEnd> ends;  ///< ends by start
  std::size_t best = 0;               ///< index of the end with least cost among those that have an x
  std::size_t minima = 0;             ///< distinct minima among the converged ends; 0 if none converged
  [[nodiscard]] bool found() const { return !ends.empty() && !ends[best].x.empty(); }
};
/// Solves from all starts; `make` gives every search a problem of its own. Two ends are one minimum if `same` says so.
[[nodiscard]] ManyEnds solve_from(const std::function<LeastSquares()>& make, const std::vector<std::vector<double>>& starts,
                                  int jobs, const std::function<bool(const LeastSquaresEnd&, const LeastSquaresEnd&)>& same,
                                  const Watch& watch = {});

}  // namespace softland
