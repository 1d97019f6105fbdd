// Cosine and sine of the phase omega t by which a free mode, q'' = -omega^2 q + constant, advances in a time t: its exact
// motion follows from them. Several modes are computed at once, one per SIMD lane.
#pragma once

#include <array>
#include <cstddef>

#include "base/lanes.h"

namespace softland {

/// Largest phase [rad] for which turn() is accurate to rounding.
inline constexpr double largest_phase = 2;

struct Turn {
  Lane cosine, sine;
  Lane slack;  ///< 1 - cosine of the phase, without cancellation
};

/// Returns cosine and sine of a phase, from Taylor series of both at half the phase. The first omitted term is below 1e-18.
[[nodiscard]] inline Turn turn(const Lane& phase) {
  constexpr std::size_t degree = 18;
  constexpr auto factors = [] {  // (-1)^floor(k/2) / k!: even k of the cosine, odd k of the sine
    std::array<double, degree + 2> f{1, 1};
    for (std::size_t k = 2; k < degree + 2; ++k) f[k] = -f[k - 2] / static_cast<double>(k * (k - 1));
    return f;
  }();
  const Lane x = phase / 2, x2 = x * x;
  Lane cosine = Lane::Constant(factors[degree]), over_x = Lane::Constant(factors[degree + 1]);
  for (std::size_t k = degree; k > 0; k -= 2) {
    cosine = cosine * x2 + factors[k - 2];
    over_x = over_x * x2 + factors[k - 1];
  }
  const Lane sine = x * over_x, slack = 2 * sine * sine;
  return {.cosine = 1 - slack, .sine = 2 * sine * cosine, .slack = slack};
}

/// Returns cosine and sine of the sum of the phases of `a` and `b`.
[[nodiscard]] inline Turn operator+(const Turn& a, const Turn& b) {
  const Lane slack = a.slack + b.slack - a.slack * b.slack + a.sine * b.sine;
  return {.cosine = 1 - slack, .sine = a.sine * b.cosine + a.cosine * b.sine, .slack = slack};
}

}  // namespace softland
