// An axis of a chart maps data to pixels and chooses the round numbers at which it has ticks.
#pragma once

#include <vector>

#include "document/chart.h"

namespace softland::internal {

inline constexpr const char* ink = "#1b1f24";    // colour of text and of curves of Role::best in a chart
inline constexpr const char* muted = "#5f6b76";  // colour of ticks and frames of a chart

/// Returns `value` if a chart can draw it, NaN if it is beyond 1e100, and 0 if it is within 1e-100 of 0. Only a damaged file
/// has values that large or small; such values would overflow the coordinates of a chart.
[[nodiscard]] double drawable(double value);
/// Returns the points whose two coordinates drawable(double) can draw.
[[nodiscard]] Points drawable(const Points& points);

/// Maps data to pixels along one axis.
struct Axis {
  AxisScale scale = AxisScale::linear;
  double low = 0, high = 1;  // values of the data at the ends of the axis
  double pixel_low = 0, pixel_high = 1;

  [[nodiscard]] double transformed(double value) const;
  [[nodiscard]] double pixel(double value) const;
};

/// Returns the position of `value` on a scale with 0 at `low` and 1 at `high`; 0.5 if `low` equals `high`. The numbers are
/// finite, but `high - low` may overflow.
[[nodiscard]] double part_between(double low, double high, double value);

/// Returns about `wanted` round numbers between the ends of the axis; for a logarithmic axis, powers of ten. Returns the ends
/// themselves if they are too close for round numbers between them, and nothing if they are not finite and ascending.
[[nodiscard]] std::vector<double> ticks(const Axis& axis, int wanted);

}  // namespace softland::internal
