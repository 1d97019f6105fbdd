#include "base/random.h"

#include "base/standard_normal.h"

namespace softland {

double random_normal(std::uint64_t seed, Stream stream, std::uint64_t counter) {
  return standard_normal_quantile(random_probability(seed, stream, counter));
}

}  // namespace softland
