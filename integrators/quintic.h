// Quintic Hermite interpolation of a motion between two times at which position, velocity and acceleration are given. The error
// is of sixth order in the interval.
#pragma once

#include <algorithm>
#include <array>

#include "integrators/roots.h"

namespace softland {

class Quintic {
 public:
  /// Takes position [m], velocity [m/s] and acceleration [m/s^2] at the times t0 and t1 > t0 [s].
  Quintic(double t0, double p0, double v0, double a0, double t1, double p1, double v1, double a1) : begin_(t0), length_(t1 - t0) {
    const double h = length_, d = p1 - p0;
    const double v0h = v0 * h, v1h = v1 * h, a0h = a0 * h * h, a1h = a1 * h * h;
    c_ = {p0,
          v0h,
          a0h / 2,
          10 * d - 6 * v0h - 4 * v1h - 1.5 * a0h + 0.5 * a1h,
          -15 * d + 8 * v0h + 7 * v1h + 1.5 * a0h - a1h,
          6 * d - 3 * (v0h + v1h) - 0.5 * (a0h - a1h)};
  }

  [[nodiscard]] double position(double t) const {
    const double s = (t - begin_) / length_;
    return c_[0] + s * (c_[1] + s * (c_[2] + s * (c_[3] + s * (c_[4] + s * c_[5]))));
  }
  [[nodiscard]] double velocity(double t) const {
    const double s = (t - begin_) / length_;
    return (c_[1] + s * (2 * c_[2] + s * (3 * c_[3] + s * (4 * c_[4] + s * 5 * c_[5])))) / length_;
  }
  [[nodiscard]] double acceleration(double t) const {
    const double s = (t - begin_) / length_;
    return (2 * c_[2] + s * (6 * c_[3] + s * (12 * c_[4] + s * 20 * c_[5]))) / (length_ * length_);
  }
  /// Returns the times between t0 and t1 at which the velocity changes sign, in ascending order.
  [[nodiscard]] SignChanges<4> turns() const {
    SignChanges<4> turns = sign_changes(std::array{c_[1], 2 * c_[2], 3 * c_[3], 4 * c_[4], 5 * c_[5]});
    for (double& t : turns.at) t = begin_ + t * length_;
    return turns;
  }
  /// Bounds of the position between t0 and t1: the least and the largest coefficient of the polynomial in Bernstein form. The
  /// position is within the bounds at all times, but need not reach them.
  struct Bounds {
    double least = 0, most = 0;  ///< bounds of the interpolated position [m]
  };
  [[nodiscard]] Bounds bounds() const {
    const auto [c0, c1, c2, c3, c4, c5] = c_;
    const double b1 = c0 + 0.2 * c1, b2 = c0 + 0.4 * c1 + 0.1 * c2, b3 = c0 + 0.6 * c1 + 0.3 * c2 + 0.1 * c3;
    const double b4 = c0 + 0.8 * c1 + 0.6 * c2 + 0.4 * c3 + 0.2 * c4, b5 = c0 + c1 + c2 + c3 + c4 + c5;
    return {.least = std::min({c0, b1, b2, b3, b4, b5}), .most = std::max({c0, b1, b2, b3, b4, b5})};
  }
  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] double end() const { return begin_ + length_; }

 private:
  double begin_, length_;
  std::array<double, 6> c_{};
};

}  // namespace softland
