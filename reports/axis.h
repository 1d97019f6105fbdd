// The axis of a picture: data to pixels, and the round numbers to write at it.
#pragma once

#include <vector>

#include "reports/chart.h"

namespace softland::internal {

inline constexpr const char* ink = "#1b1f24";    // of text and of what counts
inline constexpr const char* muted = "#5f6b76";  // of ticks and frames

/// A number as a chart takes it: NaN beyond 1e100 and 0 within 1e-100 of 0. Nothing of a switch is like that, and what a damaged
/// file holds would overflow on its way to the picture.
[[nodiscard]] double drawable(double value);
/// The points whose coordinates can be drawn.
[[nodiscard]] Points drawable(const Points& points);

/// Data to pixels along one axis.
struct Axis {
  Scale scale = Scale::linear;
  double low = 0, high = 1;  // data
  double pixel_low = 0, pixel_high = 1;

  [[nodiscard]] double transformed(double value) const;
  [[nodiscard]] double pixel(double value) const;
};

/// How far `value` is on the way from `low`, 0, to `high`, 1, for any numbers there are: the way may be longer than the largest
/// of them. In the middle where there is no way.
[[nodiscard]] double part_between(double low, double high, double value);

/// About `wanted` round numbers between the ends of the axis, or its decades; the ends themselves where no round number lies
/// between them that differs from both. None of an axis that has no ends.
[[nodiscard]] std::vector<double> ticks(const Axis& axis, int wanted);

}  // namespace softland::internal
