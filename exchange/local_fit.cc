#include "exchange/local_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace softland::internal {
namespace {

constexpr std::size_t fit_terms = 8;
// One equation of the least-squares fit; its last element is the right-hand side.
using Equation = std::array<double, fit_terms + 1>;

// Returns the first unknown of the equations, by Gaussian elimination with pivoting; none if the equations are singular.
std::optional<double> first_unknown(std::array<Equation, fit_terms>& rows) {
  constexpr double nothing = 1e-10;  // a pivot below this share of the largest element counts as zero
  double largest = 0;
  for (const Equation& row : rows) {
    for (std::size_t k = 0; k < fit_terms; ++k) largest = std::max(largest, std::abs(row[k]));
  }
  // Eliminate the unknowns from the last to the second, so that the first equation contains the first unknown only.
  for (std::size_t k = fit_terms; k-- > 0;) {
    std::size_t pivot = 0;
    for (std::size_t i = 0; i <= k; ++i) {
      if (std::abs(rows[i][k]) > std::abs(rows[pivot][k])) pivot = i;
    }
    if (!(std::abs(rows[pivot][k]) > nothing * largest)) return std::nullopt;
    std::swap(rows[pivot], rows[k]);
    for (std::size_t i = 0; i < k; ++i) {
      const double factor = rows[i][k] / rows[k][k];
      for (std::size_t j = 0; j <= fit_terms; ++j) rows[i][j] -= factor * rows[k][j];
    }
  }
  return rows[0][fit_terms] / rows[0][0];
}

}  // namespace

std::optional<double> value_on_axis(std::span<const NearPoint> points) {
  constexpr std::size_t fewest = 2 * fit_terms;
  if (points.size() < fewest) return std::nullopt;
  std::array<Equation, fit_terms> rows{};
  double flat_p = 0, flat_q = 0;
  for (const NearPoint& point : points) {
    const double x = point.along, weight = std::max(1 - x * x, 0.0);
    const std::array<double, fit_terms> basis{1, x, x * x, x * x * x, point.p, point.q, x * point.p, x * point.q};
    for (std::size_t i = 0; i < fit_terms; ++i) {
      for (std::size_t j = 0; j < fit_terms; ++j) rows[i][j] += weight * basis[i] * basis[j];
      rows[i][fit_terms] += weight * basis[i] * point.value;
    }
    flat_p = std::max(flat_p, std::abs(point.p)), flat_q = std::max(flat_q, std::abs(point.q));
  }
  // A mesh without extent along p or q does not determine the coefficients of p or q (b0, b1 or c0, c1), so set them to 0.
  if (flat_p == 0) rows[4][4] = rows[6][6] = 1;
  if (flat_q == 0) rows[5][5] = rows[7][7] = 1;
  return first_unknown(rows);
}

}  // namespace softland::internal
