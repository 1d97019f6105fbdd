// Nonlinear least squares with a robust loss, by Ceres (Agarwal, Mierle and others, ceres-solver.org): the trust-region method
// of Levenberg and Marquardt, with a dense QR decomposition. Ceres is in a shared library (ceres_module.h), which is loaded at
// the first use.
//
//   minimise  sum over the first `robust` residuals of rho(r_i^2) + sum over the others of r_i^2
//
//   huber     rho(s) = s up to a^2, 2 a sqrt(s) - a^2 beyond        (Huber 1964)
//   cauchy    rho(s) = a^2 ln(1 + s / a^2)
//   none      rho(s) = s
//
// Residuals and the scale a are in standard deviations.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/choice.h"
#include "base/progress.h"

namespace softland {

enum class Loss { huber, cauchy, none };
inline constexpr std::array losses{Named<Loss>{Loss::huber, "huber"}, Named<Loss>{Loss::cauchy, "cauchy"},
                                   Named<Loss>{Loss::none, "none"}};
static_assert(is_complete<losses>());

/// The scale a of the robust losses, in standard deviations: for larger residuals a loss deviates from the square.
inline constexpr double loss_scale = 3;
/// Returns rho'(r^2), the weight of a residual r in the Fisher information of the data.
[[nodiscard]] double loss_weight(Loss loss, double residual);
/// Returns the robust loss rho(r^2), which deviates from the square for residuals above `scale`.
[[nodiscard]] double loss_value(Loss loss, double residual, double scale = loss_scale);

struct LeastSquares {
  std::size_t unknowns = 0, residuals = 0;
  std::size_t robust = 0;  ///< number of residuals, from the first on, to which the robust loss is applied
  Loss loss = Loss::huber;
  /// Writes the residuals at x and, if `jacobian` is not null, their derivatives, row by row. Returns false if the residuals
  /// cannot be computed at x.
  std::function<bool(std::span<const double> x, std::span<double> residuals, double* jacobian)> evaluate;
};

struct LeastSquaresEnd {
  bool converged = false;      ///< true if the search of the minimum converged
  std::vector<double> x = {};  ///< x at the end of the search; empty if the residuals cannot be computed at its start
  double cost = 0;             ///< half of the minimised sum of losses and squares at the end of the search
  long evaluations = 0, with_jacobian = 0;
  std::string message = {};  ///< message of the Ceres solver about the end of the search
};

/// True if the shared library with the Ceres solver is available.
[[nodiscard]] bool has_ceres();

/// Minimises the sum of the problem from the point `start`. The result does not depend on other solves that run at the same
/// time. Throws the exceptions of `evaluate`, Interrupted if `progress` asks to stop, and InvalidInput if Ceres is not
/// available.
[[nodiscard]] LeastSquaresEnd solve(const LeastSquares& problem, std::vector<double> start, const Progress& progress = {});

/// The ends of least-squares searches from several starts. The ends do not depend on the number of threads.
struct ManyEnds {
  std::vector<LeastSquaresEnd> ends;  ///< ends of the searches, in the order of the starts
  std::size_t best = 0;               ///< index of the end with the least sum, among the ends whose x is not empty
  std::size_t minima = 0;             ///< number of distinct minima among the converged ends
  [[nodiscard]] bool found() const { return !ends.empty() && !ends[best].x.empty(); }
};
/// Solves a least-squares problem from all starts. `make` makes a separate problem for each search. `same` returns true if two
/// ends are the same minimum.
[[nodiscard]] ManyEnds solve_from(const std::function<LeastSquares()>& make, const std::vector<std::vector<double>>& starts,
                                  int jobs, const std::function<bool(const LeastSquaresEnd&, const LeastSquaresEnd&)>& same,
                                  const Progress& progress = {});

}  // namespace softland
