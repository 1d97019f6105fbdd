// Piecewise linear interpolation.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace softland {

/// Returns the value at x of the piecewise linear function through the points (places, values). Both have the same size, at
/// least 2, and `places` increases. The first and the last line continue beyond the ends.
[[nodiscard]] inline double along_lines(const std::vector<double>& places, const std::vector<double>& values, double x) {
  const auto next = std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(places, x) - places.begin(), 1,
                                               static_cast<std::ptrdiff_t>(places.size()) - 1);
  const auto k = static_cast<std::size_t>(next);
  return std::lerp(values[k - 1], values[k], (x - places[k - 1]) / (places[k] - places[k - 1]));
}

}  // namespace softland
