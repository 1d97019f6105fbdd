// Quintic Hermite interpolation of a motion between two knots with position, velocity and acceleration: error of sixth order in
// the step.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace softland {

class Quintic {
 public:
  /// Matches position [m], velocity [m/s] and acceleration [m/s^2] at time t0 and t1 > t0 [s].
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
  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] double end() const { return begin_ + length_; }

 private:
  double begin_, length_;
  std::array<double, 6> c_{};
};

/// A zero of f in [low, high] where f(low) and f(high) differ in sign: bisection and regula falsi (ITP-like), to rounding of the
/// bracket.
template <class F>
double bracketed_zero(F&& f, double low, double high) {
  double f_low = f(low), f_high = f(high);
  if (f_low == 0) return low;
  if (f_high == 0) return high;
  for (int i = 0; i < 200; ++i) {
    const double middle = low + (high - low) / 2;
    if (!(middle > low && middle < high)) break;
    double t = i % 3 == 2 ? middle
                          : low - f_low * (high - low) / (f_high - f_low);  // every third step halves, so the bracket must shrink
    if (!(t > low && t < high)) t = middle;
    const double value = f(t);
    if (value == 0) return t;
    if ((value < 0) == (f_low < 0)) {
      low = t, f_low = value, f_high /= i % 3 == 1 ? 2 : 1;
    } else {
      high = t, f_high = value, f_low /= i % 3 == 1 ? 2 : 1;
    }
  }
  return std::abs(f_low) < std::abs(f_high) ? low : high;
}

}  // namespace softland
