// Forward-mode dual numbers with one direction: evaluating a law with them gives the law's exact derivative. A dual of duals has
// two directions: its value.slope and slope.value are the first derivatives, its slope.slope is the mixed second one.
#pragma once

#include <cmath>

#include "model/power.h"

namespace softland {

template <class T>
struct DualOf {
  T value = 0;
  T slope = 0;

  constexpr DualOf(T v = 0, T s = 0) : value(v), slope(s) {}  // NOLINT: plain numbers take part in formulas

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
    // At 0 the laws use roots only in products that vanish faster than the slope grows: their limit is 0.
    return {root, root > 0 ? a.slope / (2 * root) : T(0)};
  }
  friend DualOf exp(DualOf a) {
    using std::exp;
    const T grown = exp(a.value);
    return {grown, a.slope * grown};
  }
  friend DualOf log(DualOf a) {
    using std::log;
    return {log(a.value), a.slope / a.value};
  }
  /// For positive a.
  friend DualOf power(DualOf a, double exponent) {
    const T raised = power(a.value, exponent);
    return {raised, T(exponent) * raised / a.value * a.slope};
  }
  friend DualOf abs(DualOf a) { return a.value < 0 ? -a : a; }
  friend constexpr bool operator<(DualOf a, double b) { return a.value < b; }
  friend constexpr bool operator>(DualOf a, double b) { return a.value > b; }
};

using Dual = DualOf<double>;

}  // namespace softland
