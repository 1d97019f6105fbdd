#include "base/clamped_spline.h"

#include <algorithm>
#include <utility>

#include "base/gauss.h"
#include "base/require.h"

namespace softland {

ClampedSpline::ClampedSpline(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {
  const std::size_t n = x_.size();
  require(n >= 2 && y_.size() == n, "a spline needs two points at least, and as many y as x");
  require(std::adjacent_find(x_.begin(), x_.end(), [](double a, double b) { return !(a < b); }) == x_.end(),
          "the points of a spline must rise");
  // Rows of the tridiagonal system of the curvatures: the slope at the first point, continuous slopes between, s'' = 0 at the
  // last.
  std::vector<double> diagonal(n), above(n), right(n);
  const auto width = [&](std::size_t k) { return x_[k + 1] - x_[k]; };
  const auto chord = [&](std::size_t k) { return (y_[k + 1] - y_[k]) / width(k); };
  diagonal[0] = width(0) / 3, above[0] = width(0) / 6, right[0] = chord(0);
  for (std::size_t k = 1; k < n; ++k) {
    const double below = k + 1 < n ? width(k - 1) / 6 : 0, factor = below / diagonal[k - 1];
    diagonal[k] = (k + 1 < n ? (width(k - 1) + width(k)) / 3 : 1) - factor * above[k - 1];
    above[k] = k + 1 < n ? width(k) / 6 : 0;
    right[k] = (k + 1 < n ? chord(k) - chord(k - 1) : 0) - factor * right[k - 1];
  }
  curvature_.resize(n);
  for (std::size_t k = n; k-- > 0;) curvature_[k] = (right[k] - (k + 1 < n ? above[k] * curvature_[k + 1] : 0)) / diagonal[k];
}

std::size_t ClampedSpline::interval(double x) const {
  const auto above = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
  return static_cast<std::size_t>(above - x_.begin()) - 1;
}

double ClampedSpline::value(double x) const {
  const std::size_t k = interval(x);
  const double h = x_[k + 1] - x_[k], a = (x_[k + 1] - x) / h, b = 1 - a;
  return a * y_[k] + b * y_[k + 1] + ((a * a * a - a) * curvature_[k] + (b * b * b - b) * curvature_[k + 1]) * h * h / 6;
}

double ClampedSpline::slope(double x) const {
  const std::size_t k = interval(x);
  const double h = x_[k + 1] - x_[k], a = (x_[k + 1] - x) / h, b = 1 - a;
  return (y_[k + 1] - y_[k]) / h + ((1 - 3 * a * a) * curvature_[k] + (3 * b * b - 1) * curvature_[k + 1]) * h / 6;
}

double ClampedSpline::integral_of_square() const {
  constexpr int exact = 4;  // points for a polynomial of degree 6
  static const GaussRule rule = gauss_rule(exact);
  double sum = 0;
  for (std::size_t k = 0; k + 1 < x_.size(); ++k) {
    const double half = (x_[k + 1] - x_[k]) / 2;
    for (std::size_t p = 0; p < rule.points.size(); ++p) {
      const double at = value(x_[k] + half * (1 + rule.points[p]));
      sum += half * rule.weights[p] * at * at;
    }
  }
  return sum;
}

}  // namespace softland
