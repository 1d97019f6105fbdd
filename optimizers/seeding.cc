#include "optimizers/seeding.h"

#include <boost/random/sobol.hpp>

namespace softland::internal {
namespace {

constexpr std::uint64_t kGoldenRatio = 0x9e3779b97f4a7c15u;

std::uint64_t mix(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

double to_unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

// Boost's tables end at 3667 dimensions; far earlier, a Sobol sequence of any affordable length is no better than random points.
constexpr std::size_t kSobolDimensions = 64;

}  // namespace

std::uint64_t draw_bits(std::uint64_t seed, Draw study, std::uint64_t sample) {
  std::uint64_t bits = mix(seed + kGoldenRatio);
  bits = mix(bits + kGoldenRatio * (static_cast<std::uint64_t>(study) + 1));
  return mix(bits + kGoldenRatio * (sample + 1));
}

double draw_uniform(std::uint64_t seed, Draw study, std::uint64_t sample) {
  return to_unit_interval(draw_bits(seed, study, sample));
}

std::vector<std::vector<double>> sobol_points(std::uint64_t seed, std::size_t dimension, std::uint64_t first, std::size_t count) {
  std::vector<std::vector<double>> points(count, std::vector<double>(dimension));
  if (dimension == 0 || count == 0) return points;
  const std::size_t sobol_dimensions = std::min(dimension, kSobolDimensions);
  boost::random::sobol sequence(sobol_dimensions);
  sequence.seed(first);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < sobol_dimensions; ++i) {
      points[k][i] = to_unit_interval(sequence() ^ draw_bits(seed, Draw::sobol_shift, i));
    }
    for (std::size_t i = sobol_dimensions; i < dimension; ++i) {
      points[k][i] = draw_uniform(seed, Draw::sobol_shift, (first + k) * dimension + i);
    }
  }
  return points;
}

}  // namespace softland::internal
