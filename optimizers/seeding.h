// Random numbers without a state: every number is a function of (seed, study, sample), so that neither the order in which points
// are drawn nor the number of threads can change them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace softland::internal {

/// What a number is drawn for; keeps the streams of one seed apart.
enum class Draw : std::uint64_t { sobol_shift = 1, skew = 2, library_seed = 3, normals = 4, scene = 5, perturbation = 6 };

/// A well mixed hash of its arguments: the output function of splitmix64 (Steele, Lea, Flood 2014) applied once for each of them.
[[nodiscard]] std::uint64_t draw_bits(std::uint64_t seed, Draw study, std::uint64_t sample);
/// Uniform in [0, 1).
[[nodiscard]] double draw_uniform(std::uint64_t seed, Draw study, std::uint64_t sample);

/// `count` points of a Sobol sequence in [0, 1)^dimension, from number `first` on, shifted digit by digit (exclusive or) by the
/// seed: each point is uniform over the box, and together they keep the even spread of the sequence.
[[nodiscard]] std::vector<std::vector<double>> sobol_points(std::uint64_t seed, std::size_t dimension, std::uint64_t first,
                                                            std::size_t count);

}  // namespace softland::internal
