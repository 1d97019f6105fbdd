// Points of a Sobol sequence, which spread evenly over a box. Each point is computed without the points before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace softland::internal {

/// Returns `count` points of a Sobol sequence in [0, 1)^dimension, from number `first` on. A random shift from the seed is
/// applied to the binary digits (exclusive or): each point is then uniform over the box, and together they keep the even spread
/// of the sequence.
[[nodiscard]] std::vector<std::vector<double>> sobol_points(std::uint64_t seed, std::size_t dimension, std::uint64_t first,
                                                            std::size_t count);

}  // namespace softland::internal
