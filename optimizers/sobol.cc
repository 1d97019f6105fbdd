#include "optimizers/sobol.h"

#include <algorithm>
#include <boost/random/sobol.hpp>

#include "base/random.h"

namespace softland::internal {
namespace {

// Boost has direction numbers up to dimension 3667. The limit is lower, since in many dimensions a Sobol sequence of any
// affordable length is no better than random points.
constexpr std::size_t most_dimensions = 64;

}  // namespace

std::vector<std::vector<double>> sobol_points(std::uint64_t seed, std::size_t dimension, std::uint64_t first, std::size_t count) {
  std::vector<std::vector<double>> points(count, std::vector<double>(dimension));
  if (dimension == 0 || count == 0) return points;
  const std::size_t sobol_dimensions = std::min(dimension, most_dimensions);
  boost::random::sobol sequence(sobol_dimensions);
  sequence.seed(first);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < sobol_dimensions; ++i) {
      points[k][i] = to_unit_interval(sequence() ^ random_bits(seed, Stream::sobol_shift, i));
    }
    for (std::size_t i = sobol_dimensions; i < dimension; ++i) {
      points[k][i] = random_uniform(seed, Stream::sobol_shift, (first + k) * dimension + i);
    }
  }
  return points;
}

}  // namespace softland::internal
