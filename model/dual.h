// Forward-mode dual number with one direction: evaluating a law with it gives the law's exact derivative.
#pragma once

#include <cmath>

namespace softland {

struct Dual {
  double value = 0;
  double slope = 0;

  constexpr Dual(double v = 0, double s = 0) : value(v), slope(s) {}  // NOLINT: plain numbers take part in formulas
};

constexpr Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.slope + b.slope}; }
constexpr Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.slope - b.slope}; }
constexpr Dual operator-(Dual a) { return {-a.value, -a.slope}; }
constexpr Dual operator*(Dual a, Dual b) { return {a.value * b.value, a.slope * b.value + a.value * b.slope}; }
constexpr Dual operator/(Dual a, Dual b) { return {a.value / b.value, (a.slope - a.value / b.value * b.slope) / b.value}; }
inline Dual sqrt(Dual a) {
  const double root = std::sqrt(a.value);
  // At 0 the laws use roots only in products that vanish faster than the slope grows: their limit is 0.
  return {root, root > 0 ? a.slope / (2 * root) : 0};
}
inline Dual log(Dual a) { return {std::log(a.value), a.slope / a.value}; }
inline Dual abs(Dual a) { return a.value < 0 ? -a : a; }
constexpr bool operator<(Dual a, double b) { return a.value < b; }
constexpr bool operator>(Dual a, double b) { return a.value > b; }

}  // namespace softland
