#include "sampling/copula.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/random.h"
#include "sampling/points.h"
#include "tests/sampling/refused.h"

namespace softland::copula_test {
namespace {

using test::expect_parameter_refused;

Eigen::Matrix3d of_three(double r12, double r13, double r23) {
  Eigen::Matrix3d r;
  r << 1, r12, r13, r12, 1, r23, r13, r23, 1;
  return r;
}

std::vector<std::vector<double>> correlated_columns(const GaussianCopula& copula, std::uint64_t count) {
  const SamplePoints points(PointSet::monte_carlo, copula.dimensions(), 3, Stream::spread, count);
  std::vector<std::vector<double>> columns(copula.dimensions());
  std::vector<double> u(copula.dimensions());
  for (std::uint64_t k = 0; k < count; ++k) {
    points.point(k, u);
    copula.correlate(u);
    for (std::size_t i = 0; i < u.size(); ++i) columns[i].push_back(u[i]);
  }
  return columns;
}

double rank_correlation_of(const std::vector<double>& a, const std::vector<double>& b) {
  const auto ranks = [](const std::vector<double>& x) {
    std::vector<std::size_t> order(x.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) { return x[i] < x[k]; });
    std::vector<double> rank(x.size());
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<double>(i);
    return rank;
  };
  const std::vector<double> ra = ranks(a), rb = ranks(b);
  const double n = static_cast<double>(a.size());
  double differences = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differences += (ra[i] - rb[i]) * (ra[i] - rb[i]);
  return 1 - 6 * differences / (n * (n * n - 1));
}

TEST(GaussianCopula, GivesTheRankCorrelationsOfItsNormals_long) {
  constexpr std::uint64_t count = 100'000;
  const auto columns = correlated_columns(GaussianCopula(of_three(0.8, -0.5, 0.05)), count);
  const double five_deviations = 5 / std::sqrt(static_cast<double>(count));  // bound for independent columns, safe for others
  EXPECT_NEAR(rank_correlation_of(columns[0], columns[1]), 6 / std::numbers::pi * std::asin(0.4), five_deviations);
  EXPECT_NEAR(rank_correlation_of(columns[0], columns[2]), 6 / std::numbers::pi * std::asin(-0.25), five_deviations);
  EXPECT_NEAR(rank_correlation_of(columns[1], columns[2]), 6 / std::numbers::pi * std::asin(0.025), five_deviations);
}

TEST(GaussianCopula, LeavesEachVariableUniform) {
  constexpr std::uint64_t count = 100'000;
  for (std::vector<double>& column : correlated_columns(GaussianCopula(of_three(0.8, -0.5, 0.05)), count)) {
    std::sort(column.begin(), column.end());
    double distance = 0;
    for (std::size_t i = 0; i < count; ++i)
      distance = std::max(distance, std::abs(column[i] - (static_cast<double>(i) + 0.5) / count));
    EXPECT_LT(distance, 1.95 / std::sqrt(static_cast<double>(count)));  // Kolmogorov's statistic exceeds it once in 1000 cases
  }
}

TEST(GaussianCopula, OfTheUnitMatrixChangesNothing) {
  std::vector<double> u{1e-12, 0.3, 1 - 1e-9};
  const std::vector<double> before = u;
  GaussianCopula(Eigen::MatrixXd::Identity(3, 3)).correlate(u);
  constexpr double rounding =
      1e-14;  // relative to u and 1 - u: of a quantile and its inverse, amplified by the steepness of a tail
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(u[i], before[i], rounding * before[i] + 1e-16);
}

TEST(GaussianCopula, StaysInsideTheCube) {
  const GaussianCopula copula(of_three(0.99, 0.99, 0.99));
  for (const double extreme : {0x1p-53, 1 - 0x1p-53}) {
    std::vector<double> u(3, extreme);
    copula.correlate(u);
    for (const double x : u) EXPECT_TRUE(x > 0 && x < 1) << x;
  }
}

TEST(GaussianCopula, RefusesWhatIsNoCorrelationAndNamesThePair) {
  const std::vector<std::string> names{"gap", "length", "stress"};
  expect_parameter_refused([&] { GaussianCopula(of_three(0, 0, 1.2), names); }, "correlation",
                           {"length and stress is 1.2", "-1 and 1"});
  expect_parameter_refused([&] { GaussianCopula(of_three(0, std::nan(""), 0), names); }, "correlation",
                           {"gap and stress is nan"});
  // 1 and 2 agree, 2 and 3 agree, 1 and 3 do not: the eigenvalues are 1 - 2 rho = -0.8 and 1 + rho, twice.
  expect_parameter_refused([] { GaussianCopula(of_three(0.9, -0.9, 0.9)); }, "correlation",
                           {"variable 1, variable 2, variable 3", "eigenvalue", "-0.8", "at least"});
  expect_parameter_refused([&] { GaussianCopula(of_three(0, 1, 0), names); }, "correlation", {"gap, stress", "eigenvalue"});
  Eigen::Matrix3d crooked = of_three(0.1, 0.2, 0.3);
  crooked(2, 0) = 0.25;
  expect_parameter_refused([&] { GaussianCopula(crooked, names); }, "correlation", {"gap and stress is 0.2 above", "0.25 below"});
  expect_parameter_refused([&] { GaussianCopula(2 * Eigen::Matrix3d::Identity(), names); }, "correlation",
                           {"gap with itself is 2"});
  expect_parameter_refused([] { GaussianCopula(Eigen::MatrixXd::Identity(2, 3)); }, "correlation", {"2 rows and 3 columns"});
  std::vector<double> two(2, 0.5), outside{0.5, 1.0, 0.5};
  EXPECT_THROW(GaussianCopula(of_three(0, 0, 0)).correlate(two), InvalidInput);
  EXPECT_THROW(GaussianCopula(of_three(0, 0, 0)).correlate(outside), InvalidInput);
}

TEST(RankCorrelation, IsTheInverseOfCorrelationOfRanks) {
  for (const double rho : {-1.0, -0.3, 0.0, 0.7, 1.0}) EXPECT_NEAR(correlation_of_ranks(rank_correlation(rho)), rho, 1e-15);
  EXPECT_NEAR(rank_correlation(1), 1, 1e-15);
  EXPECT_THROW((void)rank_correlation(1.1), InvalidInput);
  EXPECT_THROW((void)correlation_of_ranks(std::nan("")), InvalidInput);
}

}  // namespace
}  // namespace softland::copula_test
