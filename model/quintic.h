// Quintic Hermite interpolation of a motion between two knots with position, velocity and acceleration: error of sixth order in
// the step. Zeros of functions and of polynomials, to find what happens between the knots.
#pragma once

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace softland {

/// A zero of f in [low, high] where f(low) and f(high) differ in sign, to rounding: TOMS algorithm 748 (Alefeld, Potra & Shi
/// 1995). Where they do not differ, the end at which |f| is less.
template <class F>
double bracketed_zero(F&& f, double low, double high) {
  const double f_low = f(low), f_high = f(high);
  double zero = low, least = std::abs(f_low);
  const auto keep = [&](double t, double value) {
    if (std::abs(value) < least) zero = t, least = std::abs(value);
    return value;
  };
  keep(high, f_high);
  if (!(f_low < 0 && f_high > 0) && !(f_low > 0 && f_high < 0)) return zero;
  const auto neighbours = [](double a, double b) {
    const double middle = a + (b - a) / 2;
    return !(middle > a && middle < b);
  };
  std::uintmax_t most = 200;  // evaluations
  boost::math::tools::toms748_solve([&](double t) { return keep(t, f(t)); }, low, high, f_low, f_high, neighbours, most);
  return zero;
}

/// Places in (0, 1) in order, at most N.
template <std::size_t N>
struct Places {
  std::array<double, N> at{};
  std::size_t count = 0;
  [[nodiscard]] const double* begin() const { return at.data(); }
  [[nodiscard]] const double* end() const { return at.data() + count; }
};

/// Where the polynomial c[0] + c[1] s + ... + c[N] s^N changes sign in 0 < s < 1: between the zeros of its derivative it is
/// monotone.
template <std::size_t M>
[[nodiscard]] Places<M - 1> sign_changes(const std::array<double, M>& c) {
  constexpr std::size_t degree = M - 1;
  Places<degree> places;
  if constexpr (degree > 0) {
    const auto value = [&](double s) {
      return std::accumulate(c.rbegin(), c.rend(), 0.0, [s](double v, double k) { return v * s + k; });
    };
    std::array<double, degree> slope;
    for (std::size_t k = 0; k < degree; ++k) slope[k] = static_cast<double>(k + 1) * c[k + 1];
    double low = 0;
    const auto look = [&](double high) {
      const double at_low = value(low), at_high = value(high);
      if ((at_low < 0 && at_high > 0) || (at_low > 0 && at_high < 0)) {
        places.at[places.count++] = bracketed_zero(value, low, high);
      }
      low = high;
    };
    for (const double turn : sign_changes(slope)) look(turn);
    look(1);
  }
  return places;
}

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
  /// Times in (begin, end) at which the velocity changes sign, in order.
  [[nodiscard]] Places<4> turns() const {
    Places<4> turns = sign_changes(std::array{c_[1], 2 * c_[2], 3 * c_[3], 4 * c_[4], 5 * c_[5]});
    for (double& t : turns.at) t = begin_ + t * length_;
    return turns;
  }
  /// Bounds of the position on [begin, end]: the curve stays among the control points of its Bernstein form.
  struct Bounds {
    double least = 0, most = 0;  ///< [m]
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
