#include "sampling/points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <map>
#include <set>

#include "tests/sampling/refused.h"

namespace softland::points_test {
namespace {

using Point = std::vector<double>;

Point point_of(const SamplePoints& points, std::uint64_t k) {
  Point u(points.dimensions());
  points.point(k, u);
  return u;
}

std::vector<Point> all_of(const SamplePoints& points) {
  std::vector<Point> all;
  for (std::uint64_t k = 0; k < points.size(); ++k) all.push_back(point_of(points, k));
  return all;
}

std::size_t cell(double u, std::size_t cells) { return static_cast<std::size_t>(u * static_cast<double>(cells)); }

// A (0, m, 2)-net in base 2: each elementary interval of area 2^-m, of any side lengths, contains one point. Blocks of a
// sequence that begin at a multiple of their length are nets as well.
TEST(SobolPoints, AreANetInTheFirstTwoDimensions) {
  constexpr std::size_t m = 8, count = 1u << m;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{5 * count}}) {
      const SamplePoints points(PointSet::sobol, 2, seed, Stream::spread, first + count);
      for (std::size_t split = 0; split <= m; ++split) {
        const std::size_t columns = std::size_t{1} << split, rows = count / columns;
        std::vector<int> held(count, 0);
        for (std::uint64_t k = first; k < first + count; ++k) {
          const Point u = point_of(points, k);
          ++held[cell(u[0], columns) * rows + cell(u[1], rows)];
        }
        EXPECT_EQ(std::count(held.begin(), held.end(), 1), static_cast<std::ptrdiff_t>(count))
            << seed << " " << first << " " << split;
      }
    }
  }
}

TEST(SobolPoints, HaveOnePerIntervalInEachOfAHundredDimensions) {
  constexpr std::size_t count = 256;
  const auto points = all_of(SamplePoints(PointSet::sobol, 100, 4, Stream::spread, count));
  for (std::size_t i = 0; i < 100; ++i) {
    std::set<std::size_t> cells;
    for (const Point& u : points) cells.insert(cell(u[i], count));
    EXPECT_EQ(cells.size(), count) << i;
  }
}

// Nested scrambling keeps the number of leading bits that two points have in common, so that it equals that of Boost's points,
// which are not scrambled.
TEST(SobolPoints, AreAScrambledSequenceOfJoeAndKuo) {
  constexpr std::size_t dimensions = 40, count = 200;
  const SamplePoints points(PointSet::sobol, dimensions, 9, Stream::spread, count);
  boost::random::sobol sequence(dimensions);
  std::vector<std::vector<std::uint64_t>> plain(count, std::vector<std::uint64_t>(dimensions, 0));  // Boost leaves out the first
  for (std::uint64_t k = 0; k + 1 < count; ++k) {
    for (std::size_t i = 0; i < dimensions; ++i) {
      const std::uint64_t gray = (k + 1) ^ ((k + 1) >> 1), bits = sequence();
      if (gray < count) plain[gray][i] = bits;  // its order is that of the Gray code
    }
  }
  const auto common = [](std::uint64_t a, std::uint64_t b) { return a == b ? 64 : __builtin_clzll(a ^ b); };
  const auto bits_of = [](double u) { return static_cast<std::uint64_t>(u * 0x1p52) << 12; };
  const Point first = point_of(points, 0);
  for (std::uint64_t k = 1; k < 128; ++k) {  // smaller numbers have a Gray code below the count as well
    const Point u = point_of(points, k);
    for (std::size_t i = 0; i < dimensions; ++i) {
      ASSERT_EQ(common(bits_of(u[i]), bits_of(first[i])), common(plain[k][i], plain[0][i])) << k << " " << i;
    }
  }
}

double smooth(const Point& u) {
  double product = 1;
  for (const double x : u) product *= 1 + (std::exp(x) - (std::exp(1.0) - 1)) / 2;
  return product;  // the mean is 1
}

// Returns the root mean square error of a mean over seeds.
double error_of_mean(PointSet kind, std::uint64_t size) {
  constexpr int seeds = 20;
  double squares = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    double sum = 0;
    for (const Point& u : all_of(SamplePoints(kind, 4, static_cast<std::uint64_t>(seed), Stream::spread, size))) sum += smooth(u);
    squares += std::pow(sum / static_cast<double>(size) - 1, 2);
  }
  return std::sqrt(squares / seeds);
}

TEST(SobolPoints, IntegrateASmoothFunctionFasterThanTheirNumber) {
  const double order = std::log2(error_of_mean(PointSet::sobol, 256) / error_of_mean(PointSet::sobol, 4096)) / 4;
  EXPECT_GT(order, 1.2);  // 3/2 except for a power of the logarithm; Monte Carlo has 1/2, an unscrambled sequence 1
}

TEST(MonteCarloPoints, IntegrateAsTheRootOfTheirNumber) {
  const double order = std::log2(error_of_mean(PointSet::monte_carlo, 256) / error_of_mean(PointSet::monte_carlo, 4096)) / 4;
  EXPECT_NEAR(order, 0.5, 0.25);  // 20 seeds give each error to 16 %, and the order to 0.08; allow three of these
}

// M. Stein, Technometrics 29 (1987) 143: the remaining variance of a mean is that of the interactions.
TEST(LatinHypercube, LeavesTheErrorOfTheInteractions) {
  constexpr std::uint64_t size = 512;
  const double e = std::exp(1.0), of_factor = ((e * e - 1) / 2 - (e - 1) * (e - 1)) / 4;
  const double of_interactions = std::pow(1 + of_factor, 4) - 1 - 4 * of_factor;
  const double expected = std::sqrt(of_interactions / static_cast<double>(size));
  EXPECT_NEAR(error_of_mean(PointSet::latin_hypercube, size), expected, 0.5 * expected);  // 20 seeds give it to 16 %
}

TEST(LatinHypercube, HasOnePointInEachStratumOfEachDimension) {
  for (const std::uint64_t size : {1u, 2u, 3u, 5u, 16u, 17u, 100u, 1023u, 1025u}) {
    const auto points = all_of(SamplePoints(PointSet::latin_hypercube, 7, 5, Stream::spread, size));
    for (std::size_t i = 0; i < 7; ++i) {
      std::set<std::size_t> strata;
      for (const Point& u : points) strata.insert(cell(u[i], size));
      EXPECT_EQ(strata.size(), size) << size << " " << i;
      EXPECT_LT(*strata.rbegin(), size);
    }
  }
}

// All 24 permutations of four strata occur about equally often.
TEST(LatinHypercube, PermutesTheStrataAtRandom) {
  constexpr int seeds = 24'000;
  std::map<std::vector<std::size_t>, int> counts;
  for (int seed = 0; seed < seeds; ++seed) {
    std::vector<std::size_t> order;
    for (const Point& u :
         all_of(SamplePoints(PointSet::latin_hypercube, 1, static_cast<std::uint64_t>(seed), Stream::spread, 4))) {
      order.push_back(cell(u[0], 4));
    }
    ++counts[order];
  }
  ASSERT_EQ(counts.size(), 24u);
  double chi_squared = 0;
  for (const auto& [order, count] : counts) chi_squared += std::pow(count - 1000, 2) / 1000.0;
  EXPECT_LT(chi_squared, 23 + 5 * std::sqrt(2.0 * 23));  // mean and five standard deviations
}

TEST(LatinHypercube, HasStrataThatAreUncorrelatedBetweenDimensionsAndInOrder) {
  constexpr std::size_t size = 10'000;
  const auto points = all_of(SamplePoints(PointSet::latin_hypercube, 3, 8, Stream::spread, size));
  const auto correlation = [&](auto first, auto second) {
    double sum = 0;
    for (std::size_t k = 0; k < size; ++k) sum += (first(k) - 0.5) * (second(k) - 0.5) * 12 / size;
    return sum;
  };
  constexpr double five_deviations = 5 / 100.0;  // deviation of the correlation of 10000 independent pairs
  const auto of = [&](std::size_t i) { return [&points, i](std::size_t k) { return points[k][i]; }; };
  const auto next = [&](std::size_t k) { return points[(k + 1) % size][0]; };
  const auto number = [](std::size_t k) { return static_cast<double>(k) / size; };
  EXPECT_LT(std::abs(correlation(of(0), of(1))), five_deviations);
  EXPECT_LT(std::abs(correlation(of(1), of(2))), five_deviations);
  EXPECT_LT(std::abs(correlation(of(0), next)), five_deviations);
  EXPECT_LT(std::abs(correlation(of(0), number)), five_deviations);
}

class EveryPointSet : public testing::TestWithParam<PointSet> {};
INSTANTIATE_TEST_SUITE_P(, EveryPointSet, testing::Values(PointSet::sobol, PointSet::latin_hypercube, PointSet::monte_carlo),
                         [](const auto& set) { return std::string(name_of(point_sets, set.param)); });

// A recorded seed must keep its meaning.
TEST_P(EveryPointSet, GivesThePointsOfEarlierVersions) {
  const std::map<PointSet, Point> kept{
      {PointSet::sobol, {0x1.ec8745d03bec7p-1, 0x1.8ac7caea8ac8dp-1, 0x1.a381369e8604cp-3}},
      {PointSet::latin_hypercube, {0x1.afda64a650434p-1, 0x1.df7062bf6cc46p-3, 0x1.c9322632e8fb9p-1}},
      {PointSet::monte_carlo, {0x1.2837d414a9823p-1, 0x1.61daabd2ac8c8p-4, 0x1.1951b502608cap-2}},
  };
  EXPECT_EQ(point_of(SamplePoints(GetParam(), 3, 20240101, Stream::spread, 1000), 777), kept.at(GetParam()));
}

TEST_P(EveryPointSet, GivesAPointWhateverWasAskedBefore) {
  const SamplePoints points(GetParam(), 5, 6, Stream::spread, 100), others(GetParam(), 5, 6, Stream::spread, 100);
  const auto all = all_of(points);
  for (std::uint64_t k = 100; k-- > 0;) EXPECT_EQ(point_of(others, k), all[k]);
}

TEST_P(EveryPointSet, HasTheSamePointsInALargerSet) {
  if (GetParam() == PointSet::latin_hypercube) return;  // its strata depend on its size
  const SamplePoints small(GetParam(), 5, 6, Stream::spread, 100),
      large(GetParam(), 5, 6, Stream::spread, SamplePoints::largest_size);
  for (std::uint64_t k = 0; k < 100; ++k) EXPECT_EQ(point_of(small, k), point_of(large, k));
}

TEST_P(EveryPointSet, HasTheSameCoordinatesInFewerDimensions) {
  const SamplePoints few(GetParam(), 2, 6, Stream::spread, 100), many(GetParam(), 5, 6, Stream::spread, 100);
  for (std::uint64_t k = 0; k < 100; ++k) {
    Point u = point_of(many, k);
    u.resize(2);
    EXPECT_EQ(point_of(few, k), u);
  }
}

TEST_P(EveryPointSet, DependsOnSeedAndStream) {
  const auto points = all_of(SamplePoints(GetParam(), 3, 6, Stream::spread, 64));
  for (const auto& others : {all_of(SamplePoints(GetParam(), 3, 7, Stream::spread, 64)),
                             all_of(SamplePoints(GetParam(), 3, 6, Stream::indices, 64))}) {
    for (std::size_t k = 0; k < points.size(); ++k) EXPECT_NE(points[k], others[k]);
  }
}

TEST_P(EveryPointSet, HasUniformCoordinatesOverTheSeeds) {
  constexpr int seeds = 20'000;
  std::array<int, 8> counts{};
  for (int seed = 0; seed < seeds; ++seed) {
    // The last dimension of a point other than the first.
    ++counts[cell(point_of(SamplePoints(GetParam(), 3, static_cast<std::uint64_t>(seed), Stream::spread, 10), 7)[2], 8)];
  }
  double chi_squared = 0;
  for (const int count : counts) chi_squared += std::pow(count - seeds / 8.0, 2) / (seeds / 8.0);
  EXPECT_LT(chi_squared, 7 + 5 * std::sqrt(2.0 * 7));  // mean and five standard deviations
}

TEST_P(EveryPointSet, StaysInsideTheCubeUpToItsLastPoint) {
  const SamplePoints points(GetParam(), 3, 6, Stream::spread, SamplePoints::largest_size);
  for (std::uint64_t k = SamplePoints::largest_size - 10'000; k < SamplePoints::largest_size; ++k) {
    for (const double x : point_of(points, k)) ASSERT_TRUE(x > 0 && x < 1) << k;
  }
}

TEST_P(EveryPointSet, RefusesWhatItHasNot) {
  test::expect_parameter_refused([] { SamplePoints(GetParam(), 0, 1, Stream::spread, 10); }, "dimensions",
                                 {"= 0", "between 1 and 3667"});
  test::expect_parameter_refused([] { SamplePoints(GetParam(), 3668, 1, Stream::spread, 10); }, "dimensions", {"= 3668"});
  test::expect_parameter_refused([] { SamplePoints(GetParam(), 2, 1, Stream::spread, 0); }, "size", {"= 0"});
  test::expect_parameter_refused([] { SamplePoints(GetParam(), 2, 1, Stream::spread, SamplePoints::largest_size + 1); }, "size",
                                 {"2147483648"});
  const SamplePoints points(GetParam(), 2, 1, Stream::spread, 10);
  Point two(2), three(3);
  EXPECT_THROW(points.point(10, two), InvalidInput);
  EXPECT_THROW(points.point(0, three), InvalidInput);
}

}  // namespace
}  // namespace softland::points_test
