// Sorts points, given by coordinates, into classes: every point belongs to the class of the nearest centre, and the centres are
// chosen so that the mean square distance of the points to their centres is small.
//
//   minimise  sum_i min_c |x_i - c|^2   over `count` centres c
//
// For a measured quantity this is the quantizer of least mean square error. Its classes are narrow where points are dense and
// wide where they are sparse, but less so than classes with equal numbers of points, whose outermost classes are very wide.
// Lloyd's iteration finds the centres from several starts; a better local minimum may exist. The centres of a start are drawn
// one by one from the points, with a probability in proportion to the square distance to the nearest centre drawn before.
//
// Sources: S. P. Lloyd, "Least squares quantization in PCM", IEEE Trans. Inf. Theory 28 (1982) 129; J. Max, "Quantizing for
// minimum distortion", IRE Trans. Inf. Theory 6 (1960) 7; D. Arthur & S. Vassilvitskii, "k-means++", SODA 2007 (starts).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace softland {

using SpacePoint = std::array<double, 3>;
[[nodiscard]] bool is_finite(const SpacePoint& point);

struct Classes {
  std::vector<SpacePoint> centres;  ///< centres of the classes in ascending order
  std::vector<double> shares;       ///< share of the points in each class

  /// Returns the index of the class to which a point belongs: that of the nearest centre, the lowest index if several are as
  /// near.
  [[nodiscard]] std::size_t nearest(const SpacePoint& point) const;
};

/// Returns the classes, which depend on the arguments alone. There are fewer classes than `count` when there are fewer distinct
/// points. Throws InvalidInput when `count` is 0, when there are no points, and for a point that is not finite.
[[nodiscard]] Classes classes_of(std::span<const SpacePoint> points, std::size_t count, std::uint64_t seed);

}  // namespace softland
