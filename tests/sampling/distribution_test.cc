#include "sampling/distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/sampling/refused.h"

namespace softland::distribution_test {
namespace {

using test::expect_parameter_refused;

struct Case {
  std::string name;
  Distribution distribution;
};

// Returns each kind without truncation, and truncated at either or both ends.
std::vector<Case> all_cases() {
  const std::vector<std::pair<std::string, Distribution::Parameters>> kinds{
      {"normal", Normal{.mean = 2, .standard_deviation = 0.5}},
      {"lognormal", Lognormal{.mean = 2, .standard_deviation = 1.5}},
      {"uniform", Uniform{.low = 1, .high = 4}},
      {"triangular", Triangular{.low = 0.5, .mode = 2, .high = 3.5}},
      {"rising triangle", Triangular{.low = 0.5, .mode = 3.5, .high = 3.5}},
      {"falling triangle", Triangular{.low = 0.5, .mode = 0.5, .high = 3.5}},
      {"empirical", Empirical{.values = {2.5, 0.7, 1.1, 3.9, 1.9, 1.3}}},
  };
  std::vector<Case> cases;
  for (const auto& [name, parameters] : kinds) {
    cases.push_back({name, Distribution(parameters)});
    cases.push_back({name + ", cut below", Distribution(parameters, {.low = 1.2})});
    cases.push_back({name + ", cut above", Distribution(parameters, {.high = 2.9})});
    cases.push_back({name + ", cut at both ends", Distribution(parameters, {.low = 1.2, .high = 2.9})});
  }
  return cases;
}

TEST(Distribution, CdfOfTheQuantileIsTheProbability) {
  constexpr double tolerance = 1e-14;  // a few roundings of numbers near 1
  for (const Case& c : all_cases()) {
    for (const double p : {1e-9, 1e-3, 0.1, 0.3, 0.5, 0.77, 0.999, 1 - 1e-9}) {
      const double error = std::abs(c.distribution.cdf(c.distribution.quantile(p)) - p);
      EXPECT_TRUE(error <= tolerance) << c.name << " at " << p << ": " << error;
    }
  }
}

TEST(Distribution, TruncationIsConditioning) {
  // P(X <= x | low <= X <= high), from the cdf without truncation.
  const Distribution::Parameters parameters = Lognormal{.mean = 2, .standard_deviation = 1.5};
  const Distribution whole(parameters), cut(parameters, {.low = 1.2, .high = 2.9});
  const double kept = whole.cdf(2.9) - whole.cdf(1.2);
  for (const double x : {1.2, 1.5, 2.0, 2.8, 2.9}) EXPECT_NEAR(cut.cdf(x), (whole.cdf(x) - whole.cdf(1.2)) / kept, 1e-15);
  EXPECT_EQ(cut.cdf(1.1), 0);
  EXPECT_EQ(cut.cdf(3.0), 1);
  EXPECT_EQ(cut.support().low, 1.2);
  EXPECT_EQ(cut.support().high, 2.9);
}

// An independent method: equal weights on the quantiles in the middles of equal intervals of probability.
TEST(Distribution, MomentsAreThoseOfItsQuantiles_long) {
  constexpr int points = 200'000;
  for (const Case& c : all_cases()) {
    double sum = 0, squares = 0;
    for (int i = 0; i < points; ++i) {
      const double x = c.distribution.quantile((i + 0.5) / points) - 2;
      sum += x;
      squares += x * x;
    }
    const double mean = sum / points, deviation = std::sqrt(squares / points - mean * mean);
    // The part beyond the outermost points adds a few times 1 / points of the variance to the tail of a lognormal.
    const double tolerance = c.name.starts_with("lognormal") ? 2e-4 : 2e-5;
    EXPECT_TRUE(std::abs(c.distribution.mean() - (mean + 2)) <= tolerance)
        << c.name << ": " << c.distribution.mean() << " " << mean + 2;
    EXPECT_TRUE(std::abs(c.distribution.standard_deviation() - deviation) <= tolerance * 5)
        << c.name << ": " << c.distribution.standard_deviation() << " " << deviation;
  }
}

TEST(Distribution, MomentsAreTheClosedForms) {
  constexpr double rounding = 1e-14;
  const Distribution uniform(Uniform{.low = 1, .high = 4});
  EXPECT_NEAR(uniform.mean(), 2.5, rounding);
  EXPECT_NEAR(uniform.standard_deviation(), 3 / std::sqrt(12.0), rounding);
  const Distribution triangular(Triangular{.low = 1, .mode = 2, .high = 5});
  EXPECT_NEAR(triangular.mean(), 8.0 / 3, rounding);
  EXPECT_NEAR(triangular.standard_deviation(), std::sqrt((1.0 + 4 + 25 - 2 - 5 - 10) / 18), rounding);
  const Distribution lognormal(Lognormal{.mean = 2, .standard_deviation = 5});
  EXPECT_EQ(lognormal.mean(), 2);
  EXPECT_EQ(lognormal.standard_deviation(), 5);
  // Half a normal: the mean is sqrt(2 / pi), the variance 1 - 2 / pi.
  const double pi = std::acos(-1);
  const Distribution half(Normal{.mean = 0, .standard_deviation = 1}, {.low = 0});
  EXPECT_NEAR(half.mean(), std::sqrt(2 / pi), rounding);
  EXPECT_NEAR(half.standard_deviation(), std::sqrt(1 - 2 / pi), rounding);
  // A lognormal above its median exp(m): mean exp(m + s^2/2) Phi(s) / (1/2).
  const double variance = std::log1p(0.25), m = std::log(2.0) - variance / 2, s = std::sqrt(variance);
  const Distribution upper(Lognormal{.mean = 2, .standard_deviation = 1}, {.low = std::exp(m)});
  EXPECT_NEAR(upper.mean(), 2 * std::erfc(-s / std::sqrt(2.0)), 4 * rounding);
  // Two values: uniform between them.
  const Distribution pair(Empirical{.values = {3, 1}});
  EXPECT_NEAR(pair.mean(), 2, rounding);
  EXPECT_NEAR(pair.standard_deviation(), 2 / std::sqrt(12.0), rounding);
}

// Compares the given mean and deviation of a lognormal with the quadrature for a truncated one.
TEST(Distribution, ATruncationThatKeepsNearlyAllKeepsTheMoments) {
  for (const double deviation : {0.1, 1.0, 10.0}) {
    const Distribution lognormal(Lognormal{.mean = 1, .standard_deviation = deviation}, {.low = 1e-5});
    ASSERT_LT(lognormal.cdf(2e-5), 2e-4);
    EXPECT_NEAR(lognormal.mean(), 1, 1e-4);  // the truncated part
    EXPECT_NEAR(lognormal.standard_deviation(), deviation, 1e-4 * deviation);
  }
}

TEST(Distribution, EmpiricalQuantilesAreLinearBetweenOrderStatistics) {
  const Distribution d(Empirical{.values = {4, 1, 2, 2, 8}});
  EXPECT_EQ(d.quantile(0.125), 1.5);
  EXPECT_EQ(d.quantile(0.3), 2);  // a step, where two values are equal
  EXPECT_EQ(d.quantile(0.75), 4);
  EXPECT_EQ(d.quantile(0.875), 6);
  EXPECT_EQ(d.cdf(2), 0.5);
  EXPECT_EQ(d.cdf(1.5), 0.125);
  EXPECT_EQ(d.cdf(8), 1);
  EXPECT_EQ(d.cdf(0.9), 0);
  // A truncation at a value that occurs twice keeps its whole probability.
  const Distribution upper(Empirical{.values = {4, 1, 2, 2, 8}}, {.low = 2});
  EXPECT_NEAR(upper.cdf(2), 0.25 / 0.75, 1e-15);
  EXPECT_NEAR(upper.mean(), (2 + 3 + 6) / 3.0, 1e-14);
}

TEST(Distribution, NeverLeavesItsSupport) {
  for (const Case& c : all_cases()) {
    for (const double p : {std::numeric_limits<double>::denorm_min(), 1e-300, 0.5, 1 - 0x1p-53}) {
      const double x = c.distribution.quantile(p);
      EXPECT_TRUE(std::isfinite(x) && c.distribution.support().holds(x)) << c.name << " at " << p << ": " << x;
    }
  }
}

TEST(Distribution, NeverLeavesItsSupportByRounding) {
  // The probability is below 1 by less than half a rounding: the quantile at 1 would be infinite.
  EXPECT_LT(Distribution(Normal{.mean = 0, .standard_deviation = 1}, {.low = 1}).quantile(1 - 0x1p-53), 9);
  for (int i = 1; i < 100; ++i) {
    const double low = 0.1 + 0.006 * i;
    EXPECT_GE(Distribution(Uniform{.low = 0.1, .high = 0.7}, {.low = low}).quantile(1e-300), low);
  }
}

TEST(Distribution, RefusesWhatIsNoDistribution) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_parameter_refused([] { Distribution(Normal{.mean = 1}); }, "standard_deviation", {"0", "above 0"});
  expect_parameter_refused([&] { Distribution(Normal{.mean = nan, .standard_deviation = 1}); }, "mean", {"nan", "finite"});
  expect_parameter_refused([] { Distribution(Lognormal{.mean = -2, .standard_deviation = 1}); }, "mean", {"-2", "above 0"});
  expect_parameter_refused([] { Distribution(Uniform{.low = 2, .high = 1}); }, "high", {"high = 1", "above low = 2"});
  expect_parameter_refused([] { Distribution(Triangular{.low = 0, .mode = 3, .high = 2}); }, "mode", {"mode = 3", "between"});
  expect_parameter_refused([] { Distribution(Empirical{.values = {1}}); }, "values", {"1 values", "at least 2"});
  expect_parameter_refused([&] { Distribution(Empirical{.values = {1, nan}}); }, "values", {"value 2", "finite"});
  expect_parameter_refused([] { Distribution(Uniform{.low = 0, .high = 1}, {.low = 2, .high = 1}); }, "truncate_high",
                           {"truncate_high = 1", "below truncate_low = 2"});
  expect_parameter_refused([] { Distribution(Normal{.mean = 0, .standard_deviation = 1}, {.low = 6}); }, "truncate_low",
                           {"[6, ", "at least"});
  expect_parameter_refused([] { Distribution(Uniform{.low = 0, .high = 1}, {.high = -1}); }, "truncate_high", {"keeps 0"});
  EXPECT_THROW((void)Distribution(Uniform{.low = 0, .high = 1}).quantile(0), InvalidInput);
  EXPECT_THROW((void)Distribution(Uniform{.low = 0, .high = 1}).quantile(nan), InvalidInput);
}

TEST(Distribution, KnowsItsKind) {
  EXPECT_EQ(Distribution(Empirical{.values = {1, 2}}).kind(), DistributionKind::empirical);
  EXPECT_EQ(name_of(distribution_kinds, Distribution(Lognormal{.mean = 1, .standard_deviation = 1}).kind()), "lognormal");
}

}  // namespace
}  // namespace softland::distribution_test
