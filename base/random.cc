#include "base/random.h"

#include <boost/math/distributions/normal.hpp>

namespace softland {

double random_normal(std::uint64_t seed, Stream stream, std::uint64_t counter) {
  // The middles of 2^52 intervals: neither 0 nor 1, where the quantile is infinite.
  const double probability = (static_cast<double>(random_bits(seed, stream, counter) >> 12) + 0.5) * 0x1p-52;
  return quantile(boost::math::normal_distribution<>(), probability);
}

}  // namespace softland
