// The axis of a picture maps data to pixels and chooses the round numbers to write beside it.
#pragma once

#include <vector>

#include "document/chart.h"

namespace softland::internal {

inline constexpr const char* ink = "#1b1f24";    // colour of text and of the main curves
inline constexpr const char* muted = "#5f6b76";  // colour of ticks and frames

/// Returns a number that a chart can draw: NaN beyond 1e100 and 0 within 1e-100 of 0. No quantity of a switch is that large or
/// small, but a damaged file may hold such a number, and the picture would overflow.
[[nodiscard]] double drawable(double value);
/// Returns the points whose coordinates can be drawn.
[[nodiscard]] Points drawable(const Points& points);

/// Maps data to pixels along one axis.
struct Axis {
  AxisScale scale = AxisScale::linear;
  double low = 0, high = 1;  // ends of the axis in units of the data
  double pixel_low = 0, pixel_high = 1;

  [[nodiscard]] double transformed(double value) const;
  [[nodiscard]] double pixel(double value) const;
};

/// Returns the position of `value` between `low`, 0, and `high`, 1, for all finite numbers: `high - low` may exceed the largest
/// of them. The position is in the middle where both ends are equal.
[[nodiscard]] double part_between(double low, double high, double value);

/// Returns about `wanted` round numbers between the ends of the axis, or its decades. Returns the ends themselves if they
/// are too close for round numbers between them, and nothing if they are not finite and ascending.
[[nodiscard]] std::vector<double> ticks(const Axis& axis, int wanted);

}  // namespace softland::internal
