#include "base/random.h"

#include <boost/math/distributions/normal.hpp>

namespace softland {

double random_normal(std::uint64_t seed, Stream stream, std::uint64_t counter) {
  return quantile(boost::math::normal_distribution<>(), random_probability(seed, stream, counter));
}

}  // namespace softland
