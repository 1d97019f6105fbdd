// A cubic spline through points. The first point is clamped, the last one free or clamped as well.
//
//   s(x_k) = y_k,   s''' is constant between points,   s'(x_0) = 0,   s''(x_n) = 0 or s'(x_n) = 0
//
// A beam that is clamped at x_0 bends in this way: a natural spline (s''(x_0) = 0) is wrong at the clamp, where the curvature
// of a beam is largest. The error falls with the fourth power of the distance of the points for a smooth function that
// satisfies both end conditions. Source: de Boor, A Practical Guide to Splines, 1978, ch. IV.
#pragma once

#include <vector>

namespace softland {

/// The support of the last point of a spline.
enum class SplineEnd { free, clamped };

class ClampedSpline {
 public:
  /// Throws InvalidInput unless x and y have the same size, at least 2, and x increases.
  ClampedSpline(std::vector<double> x, std::vector<double> y, SplineEnd end = SplineEnd::free);

  /// Returns the value of the spline at x; the outermost cubics continue beyond the ends.
  [[nodiscard]] double value(double x) const;
  [[nodiscard]] double slope(double x) const;
  /// Returns the integral of s(x)^2, s being this spline, from the first point to the last.
  [[nodiscard]] double integral_of_square() const;
  /// Returns the integral of s' t' from the first point to the last, s being this spline and t another spline through points at
  /// the same x.
  [[nodiscard]] double integral_of_slopes(const ClampedSpline& other) const;

 private:
  [[nodiscard]] std::size_t interval(double x) const;

  std::vector<double> x_, y_, curvature_;  // points (x, y) of the spline s, and its second derivative s'' at the points
};

/// Returns true when the deflections y [m] show a hinge at the end of the beam from which the positions x [m] are measured. The
/// deflection grows with the distance from a hinge, but with the square of the distance from a clamp. Returns false when
/// fewer than three of the positions lie in the first fifth of the beam.
[[nodiscard]] bool is_hinged(const std::vector<double>& x, const std::vector<double>& y);
/// Returns true when the deflections y show a hinge at the far end of the beam; is_hinged() tests the end at x = 0.
[[nodiscard]] bool is_hinged_at_end(std::vector<double> x, std::vector<double> y);

}  // namespace softland
