#include "sampling/confidence.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/engineering.h"
#include "base/random.h"
#include "base/require.h"
#include "base/standard_normal.h"
#include "sampling/statistics.h"

namespace softland {
namespace {

void require_confidence(double confidence) {
  require(0 < confidence && confidence < 1, "confidence = " + engineering(confidence, "") + " must be above 0 and below 1");
}

}  // namespace

Interval wilson_interval(std::size_t successes, std::size_t trials, double confidence) {
  require_confidence(confidence);
  require(successes <= trials,
          std::to_string(successes) + " successes must not be more than " + std::to_string(trials) + " trials");
  if (trials == 0) return {.low = 0, .high = 1};
  const double n = static_cast<double>(trials), share = static_cast<double>(successes) / n;
  const double z = standard_normal_quantile((1 + confidence) / 2), z2 = z * z;
  const double middle = (share + z2 / (2 * n)) / (1 + z2 / n);
  const double half = z / (1 + z2 / n) * std::sqrt(share * (1 - share) / n + z2 / (4 * n * n));
  // Without a success the low end is exactly 0, and without a failure the high end is exactly 1. Rounding must not change this.
  return {.low = successes == 0 ? 0 : middle - half, .high = successes == trials ? 1 : middle + half};
}

Interval quantile_interval(std::span<const double> sample, double p, double confidence) {
  require_confidence(confidence);
  require(0 < p && p < 1, "p = " + engineering(p, "") + " must be above 0 and below 1");
  internal::check_sample(sample);
  std::vector<double> sorted(sample.begin(), sample.end());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sample.size();
  const boost::math::binomial_distribution<> binomial(static_cast<double>(n), p);
  const double tail = (1 - confidence) / 2;
  // Bisect for the largest l with P(B < l) <= tail, where B is binomial: the condition holds for l = 0, and P rises with l.
  const auto fewer = [&](std::size_t l) { return l == 0 ? 0 : cdf(binomial, static_cast<double>(l - 1)); };
  std::size_t low = 0, beyond = n + 1;
  while (beyond - low > 1) {
    const std::size_t middle = (low + beyond) / 2;
    (fewer(middle) <= tail ? low : beyond) = middle;
  }
  // Bisect for the smallest u with P(B >= u) <= tail, where B is binomial: it holds for u = n + 1, and P falls with u.
  const auto at_least = [&](std::size_t u) { return u == 0 ? 1 : cdf(complement(binomial, static_cast<double>(u - 1))); };
  std::size_t before = 0, high = n + 1;
  while (high - before > 1) {
    const std::size_t middle = (before + high) / 2;
    (at_least(middle) <= tail ? high : before) = middle;
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {.low = low == 0 ? -infinity : sorted[low - 1], .high = high == n + 1 ? infinity : sorted[high - 1]};
}

Interval bootstrap_interval(std::span<const double> sample, const std::function<double(std::span<const double>)>& statistic,
                            const BootstrapOptions& options) {
  internal::check(options);
  require(!sample.empty(), "a sample must have at least one value");
  std::vector<double> drawn(sample.size()), values(static_cast<std::size_t>(options.repetitions));
  for (std::size_t repetition = 0; repetition < values.size(); ++repetition) {
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      drawn[i] = sample[internal::bootstrap_row(options.seed, repetition, i, sample.size())];
    }
    values[repetition] = statistic(drawn);
  }
  return internal::percentile_interval(values, options.confidence);
}

void internal::check(const BootstrapOptions& options) {
  require_confidence(options.confidence);
  require(options.repetitions >= 2, "repetitions = " + std::to_string(options.repetitions) + " must be at least 2");
}

std::size_t internal::bootstrap_row(std::uint64_t seed, std::size_t repetition, std::size_t place, std::size_t count) {
  const double u = random_uniform(seed, Stream::bootstrap, repetition * count + place);
  return static_cast<std::size_t>(u * static_cast<double>(count));
}

Interval internal::percentile_interval(std::span<const double> values, double confidence) {
  if (std::any_of(values.begin(), values.end(), [](double x) { return std::isnan(x); })) return {};
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return {.low = quantile_of_sorted(sorted, (1 - confidence) / 2), .high = quantile_of_sorted(sorted, (1 + confidence) / 2)};
}

}  // namespace softland
