// A quantity of scattered points at one place: least squares of a polynomial nearby. Internal to exchange/.
#pragma once

#include <array>
#include <optional>
#include <span>

namespace softland::internal {

/// A point near the place: `along` from it, in units of the window, from -1 to 1; `p` and `q` across, in units of the extent.
struct NearPoint {
  double along = 0, p = 0, q = 0;
  double value = 0;
};

/// a0 of value = a0 + a1 along + a2 along^2 + a3 along^3 + (b0 + b1 along) p + (c0 + c1 along) q, weighted by 1 - along^2: what
/// stands on the axis, whatever the rotation of the section. Nothing where the points do not tell it: fewer than sixteen, or all
/// of them at few places along.
[[nodiscard]] std::optional<double> value_on_axis(std::span<const NearPoint> points);

}  // namespace softland::internal
