#include "sampling/statistics.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "base/require.h"

namespace softland::statistics_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double rounding = 1e-14;

TEST(SampleFigures, AreTheirFormulas) {
  const std::vector<double> sample{2, 4, 4, 10};  // mean 5, deviations -3, -1, -1, 5
  EXPECT_EQ(sample_mean(sample), 5);
  EXPECT_NEAR(sample_standard_deviation(sample), std::sqrt(36.0 / 3), rounding);
  EXPECT_NEAR(sample_skewness(sample), std::sqrt(12.0) / 2 * (96 / 4.0) / std::pow(36 / 4.0, 1.5), rounding);
}

TEST(SampleFigures, OfFewValuesAreNotKnown) {
  EXPECT_EQ(sample_mean(std::vector<double>{3}), 3);
  EXPECT_TRUE(std::isnan(sample_standard_deviation(std::vector<double>{3})));
  EXPECT_TRUE(std::isnan(sample_skewness(std::vector<double>{3, 4})));
  // Equal values, whose mean may be rounded.
  for (std::size_t n = 3; n < 20; ++n) EXPECT_TRUE(std::isnan(sample_skewness(std::vector<double>(n, 0.1)))) << n;
}

TEST(SampleFigures, AreInfiniteWhereASwitchFailed) {
  const std::vector<double> sample{1, infinity, 2, 3, infinity};
  EXPECT_EQ(sample_mean(sample), infinity);
  EXPECT_EQ(sample_standard_deviation(sample), infinity);
  EXPECT_TRUE(std::isnan(sample_skewness(sample)));
  EXPECT_EQ(sample_quantile(sample, 0.25), 2);
  EXPECT_EQ(sample_quantile(sample, 0.5), 3);          // a single order statistic
  EXPECT_EQ(sample_quantile(sample, 0.51), infinity);  // between 3 and infinity
  EXPECT_EQ(sample_quantile(sample, 0.9), infinity);   // between two infinite values
  EXPECT_EQ(sample_quantile(sample, 1), infinity);
  EXPECT_EQ(conditional_value_at_risk(sample, 0.5), infinity);
}

TEST(SampleFigures, RefuseWhatIsNoSample) {
  const std::vector<double> none, with_nan{1, std::nan("")}, with_minus{1, -infinity}, fine{1, 2};
  const std::vector<std::function<void(const std::vector<double>&)>> figures{
      [](const auto& x) { (void)sample_mean(x); },
      [](const auto& x) { (void)sample_standard_deviation(x); },
      [](const auto& x) { (void)sample_skewness(x); },
      [](const auto& x) { (void)sample_quantile(x, 0.5); },
      [](const auto& x) { (void)conditional_value_at_risk(x, 0.5); },
      [](const auto& x) { (void)histogram(x); }};
  for (const auto& figure : figures) {
    for (const auto& bad : {none, with_nan, with_minus}) EXPECT_THROW(figure(bad), InvalidInput);
    EXPECT_NO_THROW(figure(fine));
  }
  EXPECT_THROW((void)sample_quantile(fine, -0.1), InvalidInput);
  EXPECT_THROW((void)sample_quantile(fine, std::nan("")), InvalidInput);
  EXPECT_THROW((void)conditional_value_at_risk(fine, 1), InvalidInput);
  EXPECT_THROW((void)histogram(fine, 0), InvalidInput);
}

TEST(SampleQuantile, IsLinearBetweenOrderStatistics) {
  const std::vector<double> sample{8, 1, 4, 2};
  EXPECT_EQ(sample_quantile(sample, 0), 1);
  EXPECT_NEAR(sample_quantile(sample, 0.5), 3, rounding);
  EXPECT_NEAR(sample_quantile(sample, 0.9), 4 + 0.7 * 4, rounding);
  EXPECT_EQ(sample_quantile(sample, 1), 8);
}

TEST(ConditionalValueAtRisk, IsTheClosedFormOfANormal) {
  constexpr int n = 100'000;
  const boost::math::normal_distribution<> normal(3, 2);
  std::vector<double> sample;
  for (int i = 0; i < n; ++i) sample.push_back(quantile(normal, (i + 0.5) / n));
  for (const double alpha : {0.0, 0.5, 0.9, 0.99}) {
    const double expected = alpha == 0 ? 3 : 3 + 4 * pdf(normal, quantile(normal, alpha)) / (1 - alpha);
    // Equal weights on quantiles miss the outermost tail: about 1 / (n (1 - alpha)) of a few standard deviations.
    EXPECT_NEAR(conditional_value_at_risk(sample, alpha), expected, 10 / (n * (1 - alpha))) << alpha;
  }
}

TEST(ConditionalValueAtRisk, IsTheLeastOfRockafellarAndUryasev) {
  const std::vector<double> sample{5, 1, 7, 2, 11, 3, 3};
  for (const double alpha : {0.0, 0.3, 0.5, 0.8, 0.95}) {
    double least = infinity;  // convex and piecewise linear in c: least at one of the values
    for (const double c : sample) {
      double sum = 0;
      for (const double x : sample) sum += std::max(x - c, 0.0);
      least = std::min(least, c + sum / static_cast<double>(sample.size()) / (1 - alpha));
    }
    EXPECT_NEAR(conditional_value_at_risk(sample, alpha), least, 10 * rounding) << alpha;
  }
}

TEST(Histogram, CountsEveryValueOnce) {
  std::vector<double> sample;
  for (int i = 0; i < 900; ++i) sample.push_back(std::fmod(i * 0.618034, 1.0));
  sample.insert(sample.end(), {0.0, 1.0, infinity, infinity});
  const Histogram made = histogram(sample);
  EXPECT_EQ(made.low, 0);
  EXPECT_EQ(made.high, 1);
  EXPECT_EQ(made.infinite, 2u);
  EXPECT_EQ(std::accumulate(made.counts.begin(), made.counts.end(), std::size_t{0}), 902u);
  // The interquartile range is 1/2: 902^(1/3) = 9.7 bins, rounded up. The values are evenly spread, and so are the counts.
  ASSERT_EQ(made.counts.size(), 10u);
  for (const std::size_t count : made.counts) EXPECT_NEAR(static_cast<double>(count), 90.2, 3);
}

TEST(Histogram, HasBoundedBinsWhateverTheSample) {
  std::vector<double> outlier(1000, 0);
  std::iota(outlier.begin(), outlier.end(), 0.0);
  outlier.push_back(1e9);
  EXPECT_EQ(histogram(outlier).counts.size(), 100u);
  EXPECT_EQ(histogram(outlier, 7).counts.size(), 7u);
  std::vector<double> equal_middle(100, 5.0);
  equal_middle.push_back(6);
  EXPECT_EQ(histogram(equal_middle).counts.size(), 8u);  // 1 + log2(101), rounded up
  const Histogram equal = histogram(std::vector<double>(10, 5.0));
  EXPECT_EQ(equal.counts, std::vector<std::size_t>{10});
  EXPECT_EQ(equal.low, equal.high);
  const Histogram failed = histogram(std::vector<double>(3, infinity));
  EXPECT_TRUE(failed.counts.empty());
  EXPECT_EQ(failed.infinite, 3u);
}

}  // namespace
}  // namespace softland::statistics_test
