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
  // The bits of 2^52 + 2^51. Adding this number to another puts the rounded other number, negative or not, into the low bits.
  static constexpr double shift = 6755399441055744.0;
  constexpr auto one = std::bit_cast<std::int64_t>(1.0), low_root = std::bit_cast<std::int64_t>(0.70710678118654752440);
  const S m = one_by_one(x, [](double number) {
    // With x = 2^e m, the integer `above` holds e in its exponent bits, and the excess of m over sqrt(1/2) in the other bits.
    const std::int64_t above = std::bit_cast<std::int64_t>(number) - low_root;
    return std::bit_cast<double>((above & 0xFFFFFFFFFFFFF) + low_root);
  });
  const S e = one_by_one(x, [](double number) {
    const std::int64_t above = std::bit_cast<std::int64_t>(number) - low_root;
    // Vector units cannot shift signed 64-bit numbers: a bias, subtracted afterwards, makes the number positive.
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
/// The first guess of w is good to 4 %: the exponent divided by -4. The fifth order leaves an error of 2e-6, the second order
/// then 1e-17.
template <class S>
requires std::same_as<S, double> || LaneOfNumbers<S>
[[nodiscard, gnu::always_inline]] inline S inverse_fourth_root(const S& h) {
  // Five quarters of the bits of 1.0, less an amount that minimises the error of the first guess of h^(-1/4).
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
