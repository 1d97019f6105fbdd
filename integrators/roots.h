// Zeros of functions and of polynomials on an interval.
#pragma once

#include <array>
#include <cstddef>
#include <numeric>

namespace softland {

namespace internal {
/// A reference to a function double -> double, which must outlive the reference. With this type the solver is not a template,
/// so that its code is compiled once, in roots.cc.
struct Function {
  const void* object;
  double (*call)(const void* object, double at);
  double operator()(double at) const { return call(object, at); }
};
double bracketed_zero(Function f, double low, double high);
}  // namespace internal

/// Returns a zero of f in [low, high], to rounding, by TOMS algorithm 748 (Alefeld, Potra & Shi 1995), when f(low) and f(high)
/// differ in sign. Otherwise returns the end at which |f| is less.
template <class F>
double bracketed_zero(const F& f, double low, double high) {
  return internal::bracketed_zero(
      {&f, [](const void* object, double at) -> double { return (*static_cast<const F*>(object))(at); }}, low, high);
}

/// Roots of a polynomial in (0, 1) in ascending order, at most N.
template <std::size_t N>
struct SignChanges {
  std::array<double, N> at{};
  std::size_t count = 0;
  [[nodiscard]] const double* begin() const { return at.data(); }
  [[nodiscard]] const double* end() const { return at.data() + count; }
};

/// Returns the roots at which the polynomial c[0] + c[1] s + ... + c[N] s^N changes sign in 0 < s < 1. Each root is bracketed
/// by zeros of the derivative, between which the polynomial is monotone.
template <std::size_t M>
[[nodiscard]] SignChanges<M - 1> sign_changes(const std::array<double, M>& c) {
  constexpr std::size_t degree = M - 1;
  SignChanges<degree> places;
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

}  // namespace softland
