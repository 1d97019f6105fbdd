// The power x^y for force laws along the beam. For doubles it is written so that a loop over points becomes vector
// instructions. The standard library's pow is a call per point, which takes many times as long as the rest of a film law.
//
//   x = 2^e m, sqrt(1/2) <= m < sqrt(2);   log2 x = e + (2 / ln 2) (f + f^3/3 + ... + f^21/21),  f = (m - 1)/(m + 1)
//   2^z = 2^n (1 + r + ... + r^13/13!),    n = round z,  r = (z - n) ln 2
//
// Valid for positive normal x; relative error below 1e-14 for |y log2 x| < 50 (tested). The result must be a normal number.
// Source: textbook series, cut where the next term is below the rounding.
#pragma once

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>

#include "base/select.h"

namespace softland {

// The function is always inlined: a call would keep the caller's loop from becoming vector instructions.
template <class S>
requires std::same_as<S, double> || LaneOfNumbers<S>
[[nodiscard, gnu::always_inline]] inline S power(const S& x, double y) {
  constexpr double ln2 = 0.69314718055994530942;
  // 2^52 + 2^51: adding this number to a number of moderate size rounds the latter and leaves the rounded value in the low bits
  // of the sum, also for negative values.
  static constexpr double shift = 6755399441055744.0;
  constexpr auto one = std::bit_cast<std::int64_t>(1.0), low_root = std::bit_cast<std::int64_t>(0.70710678118654752440);
  const S m = one_by_one(x, [](double number) {
    // With x = 2^e m: after the bits of sqrt(1/2) are subtracted, the exponent bits hold e, and the other bits how much m
    // exceeds sqrt(1/2).
    const std::int64_t above = std::bit_cast<std::int64_t>(number) - low_root;
    return std::bit_cast<double>((above & 0xFFFFFFFFFFFFF) + low_root);
  });
  const S e = one_by_one(x, [](double number) {
    const std::int64_t above = std::bit_cast<std::int64_t>(number) - low_root;
    // Vector units cannot shift signed 64-bit numbers to the right. A bias of 1024 makes e positive before the shift, and is
    // subtracted after it.
    const auto biased = static_cast<std::uint64_t>(above + (std::int64_t{1024} << 52)) >> 52;
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(shift) + biased) - (shift + 1024);
  });
  const S f = (m - 1.0) / (m + 1.0), s = f * f;
  S series = 1.0 / 21;
  for (int k = 19; k >= 1; k -= 2) series = series * s + 1.0 / k;
  const S z = y * (e + (2 / ln2) * f * series);
  const S shifted = z + shift;
  const S n = shifted - shift, r = (z - n) * ln2;
  S sum = 1;
  for (int k = 13; k >= 1; --k) sum = 1.0 + sum * (r * (1.0 / k));
  return sum * one_by_one(shifted,
                          [](double number) { return std::bit_cast<double>((std::bit_cast<std::int64_t>(number) << 52) + one); });
}

/// Returns h^(-1/4) of a positive normal number, or of every number of a SIMD vector, to rounding. The function avoids division
/// and root, the slowest instructions:
///
///   w <- w (1 - e)^(-1/4),   e = 1 - h w^4,   the power by its series in e
///
/// The first guess of w divides the exponent of h by -4; its error is up to 4 %. A step with the series to fifth order reduces
/// the error to 2e-6, and a step with the series to second order then to 1e-17.
template <class S>
requires std::same_as<S, double> || LaneOfNumbers<S>
[[nodiscard, gnu::always_inline]] inline S inverse_fourth_root(const S& h) {
  // Five quarters of the bits of 1.0, which make the guess right for h = 1, less an amount that minimises the largest error of
  // the guess.
  constexpr std::uint64_t offset = 0x4FEB000000000000;
  S w = one_by_one(h, [](double x) { return std::bit_cast<double>(offset - (std::bit_cast<std::uint64_t>(x) >> 2)); });
  S square = w * w, e = 1.0 - h * (square * square);
  w += (w * e) * (0.25 + e * (5.0 / 32 + e * (15.0 / 128 + e * (195.0 / 2048 + e * (663.0 / 8192)))));
  square = w * w, e = 1.0 - h * (square * square);
  return w + (w * e) * (0.25 + e * (5.0 / 32));
}

/// Computes h^(-1/4) by roots for scalars other than double and SIMD vectors.
template <class S>
[[nodiscard]] S inverse_fourth_root(const S& h) {
  using std::sqrt;
  return S(1) / sqrt(sqrt(h));
}

/// Computes x^y by the standard library's pow for scalars other than double and SIMD vectors (complex numbers in tests).
template <class S>
[[nodiscard]] S power(const S& x, double y) {
  using std::pow;
  return pow(x, y);
}

}  // namespace softland
