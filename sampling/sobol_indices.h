// Sobol' indices: the share of the variance of a figure that is due to each of its d variables.
//
//   first order   S_i = V(E(y | u_i)) / V(y),     estimated by  1/n sum f(B) (f(A_B^i) - f(A)) / V
//   total         T_i = 1 - V(E(y | u_~i)) / V(y),              1/(2n) sum (f(A) - f(A_B^i))^2 / V
//
// The variables u_i are independent and uniform; u_~i are all but u_i. Row j of A and of B is two points of the unit cube,
// A_B^i is A with coordinate i of B, and V is the variance of f over A and B together. S_i is the share of the variance that
// would disappear if u_i were known. T_i is the share that would remain if all variables but u_i were known. 0 <= S_i <= T_i;
// the sum of S_i is at most 1, and 1 without interactions. The mean of f is subtracted first, which changes no expected value
// but removes most of the noise of S_i.
//
// Estimates may leave these bounds: an estimate of a first-order index near zero is as often below zero as above. Each index
// has a bootstrap interval over the rows of the design. It assumes independent rows, so it is too wide for Sobol' points. An
// index is distinguishable from zero if its interval lies above zero.
//
// A failed switch has a figure that is not finite, for which no variance exists. A row with such a figure is left out as a
// whole, so that the indices are those of the switches that do not fail. There are no indices when more than `most_failed` of
// the rows are left out.
//
// Sources: A. Saltelli, P. Annoni, I. Azzini, F. Campolongo, M. Ratto & S. Tarantola, Computer Physics Communications 181
// (2010) 259, table 2 (b); M. J. W. Jansen, Computer Physics Communications 117 (1999) 35 (total).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "sampling/confidence.h"
#include "sampling/points.h"

namespace softland {

/// The points at which the figure must be evaluated to estimate Sobol' indices of d variables. Evaluation m belongs to row m /
/// (d + 2), and within this row to A (0), B (1) or A_B^i (2 + i). So the evaluations of a row are consecutive, and with Sobol'
/// or Monte Carlo points a design of fewer rows is the beginning of a larger one.
class SobolDesign {
 public:
  /// Takes points of 2 d dimensions from the random stream `indices`. Throws InvalidParameter as SamplePoints does.
  SobolDesign(PointSet kind, std::size_t dimensions, std::uint64_t seed, std::uint64_t rows);

  [[nodiscard]] std::size_t dimensions() const { return points_.dimensions() / 2; }
  [[nodiscard]] std::uint64_t rows() const { return points_.size(); }
  [[nodiscard]] std::uint64_t evaluations() const { return rows() * (dimensions() + 2); }

  /// Writes the coordinates of the point of evaluation m to `u`. Throws InvalidInput unless m < evaluations() and u has
  /// dimensions() elements.
  void point(std::uint64_t m, std::span<double> u) const;

 private:
  SamplePoints points_;
};

struct SobolIndex {
  double value = std::numeric_limits<double>::quiet_NaN();
  Interval interval = {};
  bool above_zero = false;  ///< true when the confidence interval of the index is above zero
};

/// Sobol' indices of all variables. They are NaN when all figures are equal, so that the variance is zero.
struct SobolIndices {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double variance = std::numeric_limits<double>::quiet_NaN();
  std::vector<SobolIndex> first_order = {}, total = {};
};

struct SobolEstimate {
  std::size_t rows = 0, failed_rows = 0;
  std::optional<SobolIndices> indices = {};  ///< Sobol' indices; none when too many rows failed, or fewer than two are left
};

struct SobolOptions {
  BootstrapOptions bootstrap = {};
  /// Largest share of the rows that may be left out because of figures that are not finite. Leaving out one row in a hundred
  /// can change an index by some hundredths, as much as its statistical error with a thousand rows.
  double most_failed = 0.01;
};

/// Estimates the Sobol' indices from the figures of all evaluations of a design, in the order of the evaluations. Throws
/// InvalidInput unless the number of figures is a positive multiple of d + 2, and for bootstrap options that
/// bootstrap_interval() refuses.
[[nodiscard]] SobolEstimate sobol_indices(std::size_t dimensions, std::span<const double> figures,
                                          const SobolOptions& options = {});

}  // namespace softland
