// Fits a quantity, given on scattered mesh points near one place, by a polynomial (least squares). Internal to exchange/.
#pragma once

#include <array>
#include <optional>
#include <span>

namespace softland::internal {

/// A mesh point near the place on the axis at which a quantity is fitted, with the value of the quantity. `along` is its
/// distance from the place along the axis, from -1 to 1 within the fit's window. The coordinates `p` and `q` across the axis
/// are in units of the extent of the mesh.
struct NearPoint {
  double along = 0, p = 0, q = 0;
  double value = 0;
};

/// Returns the value of a quantity on the axis of a structure, a0, from the least-squares fit value = a0 + a1 along + a2
/// along^2 + a3 along^3 + (b0 + b1 along) p + (c0 + c1 along) q with weights 1 - along^2. The terms in p and q account for the
/// rotation of the section. Returns none if the points do not determine a0: fewer than sixteen points, or points at too few
/// places along the axis.
[[nodiscard]] std::optional<double> value_on_axis(std::span<const NearPoint> points);

}  // namespace softland::internal
