// B-spline waveform: a cubic spline of the voltage with continuous curvature. The voltage need not reach its control levels,
// but stays between the smallest and the largest. With n levels, the knots are n - 2 evenly spaced times from 0 to the
// duration; the first and the last count fourfold:
//
//   V(t) = sum over i of levels_i B_i(t) on [0, duration], B_i the cubic B-splines of these knots (de Boor, A Practical Guide to
//   Splines, 1978, chapter IX)
//
// The voltage begins at the first level, which may be a jump at t = 0, and ends at the last level, which is held without end.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "waveforms/parameter.h"
#include "waveforms/signal.h"

namespace softland {

template <class P>
struct BSplineOf {
  std::vector<P> levels = {};  ///< control levels of the voltage [V]; at least 4
  P duration = 0;              ///< time from t = 0 until the last voltage level is reached [s], > 0
};
using BSpline = BSplineOf<double>;

template <>
struct FamilyOf<BSpline> {
  static constexpr std::string_view name = "bspline";
  static constexpr auto parameters = std::to_array<Parameter<BSpline>>({
      {"levels", ParameterKind::level, &BSpline::levels, true,
       "four or more levels that draw a cubic B-spline from the first to the last, which is held; "
       "it stays between the smallest and the largest"},
      {"duration", ParameterKind::time, &BSpline::duration, true, "duration of the curve, > 0"},
  });
  [[nodiscard]] static BSpline example() { return {.levels = {1, -2, 0.5, 3, 0.7}, .duration = 7}; }
};

namespace internal {

/// Returns the four B-splines of a spline of n levels that are not 0 in span j, the interval between inner knots j and j + 1.
/// Each is a cubic polynomial of the position in the span (0 to 1), coefficients in rising order. The first one belongs to
/// level j.
[[nodiscard]] std::array<std::array<double, 4>, 4> bsplines_of_span(std::size_t j, std::size_t n);

/// Returns true if all knots that affect span j are evenly spaced; all such spans have the same four B-splines.
[[nodiscard]] constexpr bool has_even_knots(std::size_t j, std::size_t n) { return j >= 3 && j + 7 <= n; }

/// Returns knot `i` of the n + 4 knots of a spline of n levels, in units of the distance between two inner knots.
[[nodiscard]] double bspline_knot(std::size_t i, std::size_t n);

}  // namespace internal

/// Returns the voltage of a valid B-spline waveform as polynomial pieces.
template <class P>
[[nodiscard]] Pieces<P> pieces(const BSplineOf<P>& spline) {
  const std::size_t n = spline.levels.size(), spans = n - 3;
  const P per_time = P(static_cast<double>(spans)) / spline.duration;
  Pieces<P> all;
  all.reserve(spans + 1);
  std::array<std::array<double, 4>, 4> basis;
  for (std::size_t j = 0; j < spans; ++j) {
    if (!internal::has_even_knots(j, n) || !internal::has_even_knots(j - 1, n)) basis = internal::bsplines_of_span(j, n);
    std::array<P, 4> cubic = {};
    P power = P(1);
    for (std::size_t k = 0; k < 4; ++k, power = power * per_time) {
      P sum = P(0);
      for (std::size_t i = 0; i < 4; ++i) sum = sum + P(basis[i][k]) * spline.levels[j + i];
      cubic[k] = sum * power;
    }
    SignalPieceOf<P> piece{.begin = P(static_cast<double>(j)) / per_time, .value = cubic[0], .slope = cubic[1]};
    piece.terms.push_back({.cosine = {P(0), P(0), cubic[2], cubic[3]}});
    all.push_back(std::move(piece));
  }
  all.push_back({.begin = spline.duration, .value = spline.levels.back()});
  return all;
}
/// Compiles the B-spline to a voltage signal. Throws InvalidParameter for an invalid B-spline.
[[nodiscard]] Signal signal(const BSpline& spline, double before = 0);

}  // namespace softland
