#include "sampling/confidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/random.h"
#include "base/require.h"
#include "sampling/statistics.h"

namespace softland::confidence_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int repetitions = 1000;
constexpr double confidence = 0.9;

// Four standard deviations of the share of repetitions that cover the value, at the nominal confidence.
const double four_deviations = 4 * std::sqrt(confidence * (1 - confidence) / repetitions);

// A skewed distribution, so that nothing relies on symmetry: exponential with mean 1.
std::vector<double> exponential_sample(int repetition, std::size_t count) {
  std::vector<double> sample;
  for (std::size_t i = 0; i < count; ++i) {
    sample.push_back(-std::log1p(-random_uniform(static_cast<std::uint64_t>(repetition), Stream::scene, i)));
  }
  return sample;
}

template <class Covers>
double coverage(Covers covers) {
  int covered = 0;
  for (int repetition = 0; repetition < repetitions; ++repetition) covered += covers(repetition) ? 1 : 0;
  return static_cast<double>(covered) / repetitions;
}

TEST(WilsonInterval, HoldsThePublishedNumbers) {
  // 81 of 263 at 95 %: R. G. Newcombe, Statistics in Medicine 17 (1998) 857, table I, method 3, to its four digits; with 15 of
  // 148, 0 of 20 and 1 of 29.
  constexpr double printed = 0.5e-4;
  const auto expect = [](std::size_t s, std::size_t n, double low, double high) {
    const Interval interval = wilson_interval(s, n);
    EXPECT_NEAR(interval.low, low, printed);
    EXPECT_NEAR(interval.high, high, printed);
  };
  expect(81, 263, 0.2553, 0.3662);
  expect(15, 148, 0.0624, 0.1605);
  expect(0, 20, 0.0000, 0.1611);
  expect(1, 29, 0.0061, 0.1718);
}

TEST(WilsonInterval, StaysInsideTheUnitInterval) {
  for (std::size_t n = 1; n < 100; ++n) {
    EXPECT_EQ(wilson_interval(0, n).low, 0);
    EXPECT_EQ(wilson_interval(n, n).high, 1);
  }
  EXPECT_LT(wilson_interval(7, 7).low, 1);
  EXPECT_EQ(wilson_interval(0, 0).low, 0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1);
  EXPECT_THROW((void)wilson_interval(8, 7), InvalidInput);
  EXPECT_THROW((void)wilson_interval(1, 7, 1), InvalidInput);
}

TEST(WilsonInterval, CoversTheYieldAsOftenAsItSays) {
  // The coverage at n = 200 is the sum of the binomial probabilities of the counts whose interval contains the yield.
  for (const auto& [yield, expected] : {std::pair{0.35, 0.9121}, {0.8, 0.9076}}) {
    const double share = coverage([truth = yield](int repetition) {
      std::size_t successes = 0;
      for (std::uint64_t i = 0; i < 200; ++i) {
        successes += random_uniform(static_cast<std::uint64_t>(repetition), Stream::scene, i) < truth ? 1 : 0;
      }
      return wilson_interval(successes, 200, confidence).holds(truth);
    });
    EXPECT_NEAR(share, expected, four_deviations) << yield;
  }
}

TEST(QuantileInterval, IsMadeOfTheOrderStatisticsOfATable) {
  // 95 % for the median of ten: x_2 to x_9, with P(B < 2) = 11 / 1024 = 0.0107, and P(B < 3) = 56 / 1024 above 0.025.
  std::vector<double> sample{7, 3, 1, 9, 5, 2, 8, 4, 10, 6};
  EXPECT_EQ(quantile_interval(sample, 0.5).low, 2);
  EXPECT_EQ(quantile_interval(sample, 0.5).high, 9);
  // P(B < 3) = 0.0547 is allowed at 89 %.
  EXPECT_EQ(quantile_interval(sample, 0.5, 0.89).low, 3);
  EXPECT_EQ(quantile_interval(sample, 0.5, 0.89).high, 8);
}

TEST(QuantileInterval, HasNoBoundWhereTheSampleIsTooSmall) {
  const std::vector<double> sample{1, 2, 3, 4, 5};  // P(B = 0) = 1 / 32 for the median, more than 0.025
  EXPECT_EQ(quantile_interval(sample, 0.5).low, -infinity);
  EXPECT_EQ(quantile_interval(sample, 0.5).high, infinity);
  // The 0.99 quantile needs n with 0.99^n <= 0.025: n >= 367.02, so 368.
  EXPECT_EQ(quantile_interval(exponential_sample(0, 367), 0.99).high, infinity);
  EXPECT_LT(quantile_interval(exponential_sample(0, 368), 0.99).high, infinity);
}

TEST(QuantileInterval, EndsAtAFailureWhereItsOrderStatisticIsOne) {
  std::vector<double> sample{7, 3, 1, infinity, 5, 2, 8, 4, infinity, 6};
  EXPECT_EQ(quantile_interval(sample, 0.5).low, 2);
  EXPECT_EQ(quantile_interval(sample, 0.5).high, infinity);
  sample.push_back(std::nan(""));
  EXPECT_THROW((void)quantile_interval(sample, 0.5), InvalidInput);
  EXPECT_THROW((void)quantile_interval(std::vector<double>{}, 0.5), InvalidInput);
  EXPECT_THROW((void)quantile_interval(std::vector<double>{1}, 1), InvalidInput);
}

TEST(QuantileInterval, CoversTheQuantileAtLeastAsOftenAsItSays) {
  // The values at n = 150 are P(65 <= B < 86) for the median, and P(129 <= B < 142).
  for (const auto& [p, expected] : {std::pair{0.5, 0.9139}, {0.9, 0.9253}}) {
    const double truth = -std::log1p(-p);
    const double share = coverage(
        [&](int repetition) { return quantile_interval(exponential_sample(repetition, 150), p, confidence).holds(truth); });
    EXPECT_NEAR(share, expected, four_deviations) << p;
  }
}

TEST(BootstrapInterval, CoversAMeanNearlyAsOftenAsItSays_long) {
  const double share = coverage([](int repetition) {
    return bootstrap_interval(exponential_sample(repetition, 100), sample_mean,
                              {.confidence = confidence, .repetitions = 300, .seed = static_cast<std::uint64_t>(repetition)})
        .holds(1);
  });
  // At n = 100 the interval misses a few thousandths for a skewed distribution (Efron & Tibshirani, section 13.7).
  EXPECT_NEAR(share, confidence, four_deviations + 0.01);
}

TEST(BootstrapInterval, IsThatOfTheNormalApproximationForAMean) {
  const std::vector<double> sample = exponential_sample(1, 2000);
  const Interval interval = bootstrap_interval(sample, sample_mean, {.confidence = 0.95, .repetitions = 4000});
  const double half = 1.959964 * sample_standard_deviation(sample) / std::sqrt(2000.0), mean = sample_mean(sample);
  // Relative to the half width: an outer quantile of 4000 has an error of 4 %; skewness adds 2 %.
  constexpr double of_4000_repetitions = 0.1;
  EXPECT_NEAR(interval.low, mean - half, of_4000_repetitions * half);
  EXPECT_NEAR(interval.high, mean + half, of_4000_repetitions * half);
}

TEST(BootstrapInterval, IsTheSameForTheSameSeed) {
  const std::vector<double> sample = exponential_sample(1, 50);
  const Interval first = bootstrap_interval(sample, sample_mean, {.seed = 4}),
                 again = bootstrap_interval(sample, sample_mean, {.seed = 4});
  EXPECT_EQ(first.low, again.low);
  EXPECT_EQ(first.high, again.high);
  EXPECT_NE(first.low, bootstrap_interval(sample, sample_mean, {.seed = 5}).low);
}

TEST(BootstrapInterval, GoesOnWithFailuresAndWithFiguresThatAreNotKnown) {
  std::vector<double> sample = exponential_sample(1, 50);
  sample.insert(sample.end(), 10, infinity);
  const auto median = [](std::span<const double> x) { return sample_quantile(x, 0.5); };
  EXPECT_LT(bootstrap_interval(sample, median).high, infinity);
  EXPECT_EQ(bootstrap_interval(sample, sample_mean).high, infinity);
  EXPECT_TRUE(std::isnan(bootstrap_interval(sample, sample_skewness).low));
  EXPECT_THROW((void)bootstrap_interval(std::vector<double>{}, sample_mean), InvalidInput);
  EXPECT_THROW((void)bootstrap_interval(sample, sample_mean, {.repetitions = 1}), InvalidInput);
  EXPECT_THROW((void)bootstrap_interval(sample, sample_mean, {.confidence = 1.5}), InvalidInput);
}

}  // namespace
}  // namespace softland::confidence_test
