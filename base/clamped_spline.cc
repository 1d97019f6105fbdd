#include "base/clamped_spline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/gauss.h"
#include "base/require.h"

namespace softland {
namespace {

// Returns the integral of the product f(x) g(x) over x from the first to the last of the points, by Gauss' rule between
// neighbouring points. It is exact where the product is a polynomial of degree 7 at most between them.
template <class F, class G>
double integral_of_product(const std::vector<double>& points, F f, G g) {
  constexpr int exact = 4;
  static const GaussRule rule = gauss_rule(exact);
  double sum = 0;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const double half = (points[k + 1] - points[k]) / 2;
    for (std::size_t p = 0; p < rule.points.size(); ++p) {
      const double x = points[k] + half * (1 + rule.points[p]);
      sum += half * rule.weights[p] * f(x) * g(x);
    }
  }
  return sum;
}

}  // namespace

ClampedSpline::ClampedSpline(std::vector<double> x, std::vector<double> y, SplineEnd end) : x_(std::move(x)), y_(std::move(y)) {
  const std::size_t n = x_.size();
  require(n >= 2 && y_.size() == n, "the x and y of a spline must have the same size, at least 2");
  require(std::adjacent_find(x_.begin(), x_.end(), [](double a, double b) { return !(a < b); }) == x_.end(),
          "the x of a spline must increase from point to point");
  // Fill the rows of the tridiagonal system for the second derivatives s'' at the points: s' = 0 at the first point, a
  // continuous slope at the inner points, and s'' = 0 or s' = 0 at the last point.
  std::vector<double> diagonal(n), above(n), right(n);
  const auto width = [&](std::size_t k) { return x_[k + 1] - x_[k]; };
  const auto chord = [&](std::size_t k) { return (y_[k + 1] - y_[k]) / width(k); };
  diagonal[0] = width(0) / 3, above[0] = width(0) / 6, right[0] = chord(0);
  for (std::size_t k = 1; k < n; ++k) {
    const double below = k + 1 < n || end == SplineEnd::clamped ? width(k - 1) / 6 : 0, factor = below / diagonal[k - 1];
    const double own = k + 1 < n ? (width(k - 1) + width(k)) / 3 : end == SplineEnd::clamped ? width(k - 1) / 3 : 1;
    const double turn = k + 1 < n ? chord(k) - chord(k - 1) : end == SplineEnd::clamped ? -chord(k - 1) : 0;
    diagonal[k] = own - factor * above[k - 1];
    above[k] = k + 1 < n ? width(k) / 6 : 0;
    right[k] = turn - factor * right[k - 1];
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
  const auto own = [this](double x) { return value(x); };
  return integral_of_product(x_, own, own);
}

double ClampedSpline::integral_of_slopes(const ClampedSpline& other) const {
  return integral_of_product(
      x_, [this](double x) { return slope(x); }, [&](double x) { return other.slope(x); });
}

bool is_hinged(const std::vector<double>& x, const std::vector<double>& y) {
  // Compute the power of the distance x with which the deflection grows near the end, from the points 1 and 2. It is 1 at a
  // hinge and 2 at a clamp; 1.4 to 1.5 at the clamp of a thick beam, which deflects in shear too. A power below `between` means
  // a hinge. The points must lie in the first fifth (`near`) of the beam.
  constexpr double near = 0.2, between = 1.2;
  if (x.size() < 4 || !(x[2] < near * x.back()) || !(y[1] * y[2] > 0)) return false;
  return std::log(y[2] / y[1]) / std::log(x[2] / x[1]) < between;
}

bool is_hinged_at_end(std::vector<double> x, std::vector<double> y) {
  const double end = x.back();
  for (double& place : x) place = end - place;
  std::ranges::reverse(x);
  std::ranges::reverse(y);
  return is_hinged(x, y);
}

}  // namespace softland
