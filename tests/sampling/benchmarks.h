// Functions of independent uniform numbers whose Sobol' indices are known.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace softland::test {

/// sin x1 + a sin^2 x2 + b x3^4 sin x1, x uniform in (-pi, pi), a = 7, b = 0.1. T. Ishigami & T. Homma, Proc. ISUMA 1990, 398.
struct Ishigami {
  static constexpr double a = 7, b = 0.1, pi = std::numbers::pi;
  static constexpr double pi4 = pi * pi * pi * pi;
  static constexpr double of_1 = (1 + b * pi4 / 5) * (1 + b * pi4 / 5) / 2, of_2 = a * a / 8;
  static constexpr double of_13 = b * b * pi4 * pi4 * (1.0 / 18 - 1.0 / 50);
  static constexpr double mean = a / 2, variance = of_1 + of_2 + of_13;

  static double at(std::span<const double> u) {
    const auto x = [&](std::size_t i) { return pi * (2 * u[i] - 1); };
    return std::sin(x(0)) + a * std::pow(std::sin(x(1)), 2) + b * std::pow(x(2), 4) * std::sin(x(0));
  }
  static std::vector<double> first_order() { return {of_1 / variance, of_2 / variance, 0}; }
  static std::vector<double> total() { return {(of_1 + of_13) / variance, of_2 / variance, of_13 / variance}; }
};

/// Sobol's g-function: the product of (|4 u_i - 2| + a_i) / (1 + a_i); a factor has mean 1 and variance 1 / (3 (1 + a_i)^2).
struct GFunction {
  std::vector<double> a;

  double at(std::span<const double> u) const {
    double product = 1;
    for (std::size_t i = 0; i < a.size(); ++i) product *= (std::abs(4 * u[i] - 2) + a[i]) / (1 + a[i]);
    return product;
  }
  double of_factor(std::size_t i) const { return 1 / (3 * (1 + a[i]) * (1 + a[i])); }
  double variance() const {
    double product = 1;
    for (std::size_t i = 0; i < a.size(); ++i) product *= 1 + of_factor(i);
    return product - 1;
  }
  double first_order(std::size_t i) const { return of_factor(i) / variance(); }
  double total(std::size_t i) const { return of_factor(i) / (1 + of_factor(i)) * (variance() + 1) / variance(); }
};

}  // namespace softland::test
