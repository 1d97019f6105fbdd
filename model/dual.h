// Forward-mode dual numbers: evaluating a law with them gives the law's exact derivatives. A plain dual number has the slope in
// one direction. A dual of duals has two directions: its value.slope and slope.value are the first derivatives, its slope.slope
// is the mixed second derivative. A dual whose slope is Directions<N> has N directions at once, for one evaluation of the
// value.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "base/select.h"
#include "model/power.h"

namespace softland {

/// Slopes of a dual number in N directions.
template <std::size_t N, class T = double>
struct Directions {
  std::array<T, N> along = {};

  /// Returns the unit vector of direction `k`: slope 1 in this direction, 0 in the others.
  static constexpr Directions unit(std::size_t k) {
    Directions d;
    d.along[k] = T(1);
    return d;
  }

  friend constexpr Directions operator+(Directions a, const Directions& b) {
    for (std::size_t k = 0; k < N; ++k) a.along[k] = a.along[k] + b.along[k];
    return a;
  }
  friend constexpr Directions operator-(Directions a, const Directions& b) {
    for (std::size_t k = 0; k < N; ++k) a.along[k] = a.along[k] - b.along[k];
    return a;
  }
  friend constexpr Directions operator-(Directions a) {
    for (T& slope : a.along) slope = -slope;
    return a;
  }
  friend constexpr Directions operator*(Directions a, const T& factor) {
    for (T& slope : a.along) slope = slope * factor;
    return a;
  }
  friend constexpr Directions operator*(const T& factor, const Directions& a) { return a * factor; }
  friend constexpr Directions operator/(Directions a, const T& divisor) {
    for (T& slope : a.along) slope = slope / divisor;
    return a;
  }
  template <class Condition>
  friend void assign_where(const Condition& condition, Directions& to, const Directions& from) {
    for (std::size_t k = 0; k < N; ++k) assign_where(condition, to.along[k], from.along[k]);
  }
};

template <class T, class Slope = T>
struct DualOf {
  T value = 0;
  Slope slope = {};

  constexpr DualOf(T v = 0, Slope s = {}) : value(v), slope(s) {}  // not explicit: formulas mix dual and plain numbers

  friend constexpr DualOf operator+(DualOf a, DualOf b) { return {a.value + b.value, a.slope + b.slope}; }
  friend constexpr DualOf operator-(DualOf a, DualOf b) { return {a.value - b.value, a.slope - b.slope}; }
  friend constexpr DualOf operator-(DualOf a) { return {-a.value, -a.slope}; }
  friend constexpr DualOf operator*(DualOf a, DualOf b) { return {a.value * b.value, a.slope * b.value + a.value * b.slope}; }
  friend constexpr DualOf operator/(DualOf a, DualOf b) {
    return {a.value / b.value, (a.slope - a.value / b.value * b.slope) / b.value};
  }
  friend DualOf sqrt(DualOf a) {
    using std::sqrt;
    const T root = sqrt(a.value);
    // The slope of a root at 0 is infinite. Take 0: the laws use a root only in a product whose slope at 0 has the limit 0.
    return {root, select(
                      root > 0, [&]() -> Slope { return a.slope / (2 * root); }, [] { return Slope{}; })};
  }
  friend DualOf exp(DualOf a) {
    using std::exp;
    const T raised = exp(a.value);
    return {raised, a.slope * raised};
  }
  friend DualOf log(DualOf a) {
    using std::log;
    return {log(a.value), a.slope / a.value};
  }
  friend DualOf sin(DualOf a) {
    using std::cos, std::sin;
    return {sin(a.value), cos(a.value) * a.slope};
  }
  friend DualOf cos(DualOf a) {
    using std::cos, std::sin;
    return {cos(a.value), -sin(a.value) * a.slope};
  }
  /// Returns a^exponent for a positive dual number a.
  friend DualOf power(DualOf a, double exponent) {
    const T raised = power(a.value, exponent);
    return {raised, T(exponent) * raised / a.value * a.slope};
  }
  friend DualOf abs(DualOf a) {
    return select(
        a.value < 0, [&] { return -a; }, [&] { return a; });
  }
  friend constexpr auto operator<(DualOf a, double b) { return a.value < b; }
  friend constexpr auto operator>(DualOf a, double b) { return a.value > b; }
  friend constexpr auto operator<(DualOf a, DualOf b) { return a.value < b.value; }
  friend constexpr auto operator>(DualOf a, DualOf b) { return a.value > b.value; }

  template <class Condition>
  friend void assign_where(const Condition& condition, DualOf& to, const DualOf& from) {
    assign_where(condition, to.value, from.value);
    assign_where(condition, to.slope, from.slope);
  }
};

using Dual = DualOf<double>;
/// A dual number with N directions.
template <std::size_t N>
using Gradient = DualOf<double, Directions<N>>;

}  // namespace softland
