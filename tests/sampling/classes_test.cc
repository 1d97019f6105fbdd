// Sorts points into classes.
#include "sampling/classes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "base/require.h"
#include "sampling/distribution.h"

namespace softland::classes_test {
namespace {

// Equidistant quantiles of the standard normal distribution, on a line.
std::vector<SpacePoint> normal_points(std::size_t count) {
  const Distribution normal(Normal{.mean = 0, .standard_deviation = 1});
  std::vector<SpacePoint> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({normal.quantile((static_cast<double>(i) + 0.5) / static_cast<double>(count)), 0});
  return points;
}

struct Published {
  std::vector<double> centres;  // centres above 0
  double mean_square;           // mean square distance to the centre
};

TEST(Classes, OfANormalQuantityAreThoseOfMax_long) {
  const std::vector<SpacePoint> points = normal_points(4000);
  // The mean square is flat around its minimum, and the iteration ends when no point changes its class.
  constexpr double of_a_centre = 0.02, of_the_mean_square = 5e-3;
  // J. Max, IRE Trans. Inf. Theory 6 (1960) 7, table I.
  for (const Published& published : {Published{{0.4528, 1.510}, 0.1175}, Published{{0.2451, 0.7560, 1.344, 2.152}, 0.03454}}) {
    const std::size_t half = published.centres.size();
    const Classes classes = classes_of(points, 2 * half, 1);
    ASSERT_EQ(classes.centres.size(), 2 * half);
    for (std::size_t c = 0; c < half; ++c) {
      EXPECT_NEAR(classes.centres[half + c][0], published.centres[c], of_a_centre) << c;
      EXPECT_NEAR(classes.centres[half - 1 - c][0], -published.centres[c], of_a_centre) << c;
    }
    double square = 0;
    for (const SpacePoint& p : points) square += std::pow(p[0] - classes.centres[classes.nearest(p)][0], 2);
    const double mean_square = square / static_cast<double>(points.size());
    EXPECT_NEAR(mean_square, published.mean_square, of_the_mean_square * published.mean_square);
    EXPECT_NEAR(std::accumulate(classes.shares.begin(), classes.shares.end(), 0.0), 1, 1e-12);
    EXPECT_GT(classes.shares[half], classes.shares[0]) << "the outermost hold the fewest";
  }
}

TEST(Classes, AreTheClumpsOfThePlaneWhateverTheSeed) {
  std::vector<SpacePoint> points;
  for (const SpacePoint clump : {SpacePoint{0, 0}, SpacePoint{0, 10}, SpacePoint{10, 0}}) {
    for (int i = 0; i < 5; ++i) points.push_back({clump[0] + 0.1 * i, clump[1] - 0.1 * i});
  }
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const Classes classes = classes_of(points, 3, seed);
    ASSERT_EQ(classes.centres.size(), 3U);
    EXPECT_NEAR(classes.centres[0][0], 0.2, 1e-12);
    EXPECT_NEAR(classes.centres[0][1], -0.2, 1e-12);
    EXPECT_NEAR(classes.centres[1][1], 9.8, 1e-12);
    EXPECT_NEAR(classes.centres[2][0], 10.2, 1e-12);
    EXPECT_EQ(classes.nearest({9, 1}), 2U);
    for (const double share : classes.shares) EXPECT_DOUBLE_EQ(share, 1.0 / 3);
  }
}

TEST(Classes, AreFewerWherePointsAreFewer) {
  const std::vector<SpacePoint> points{{1, 1}, {2, 2}, {1, 1}};
  const Classes classes = classes_of(points, 7, 1);
  ASSERT_EQ(classes.centres.size(), 2U);
  EXPECT_DOUBLE_EQ(classes.shares[0], 2.0 / 3);
}

TEST(Classes, RefuseWhatCannotBeSorted) {
  const std::vector<SpacePoint> good{{1, 1}}, bad{{1, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_THROW(static_cast<void>(classes_of(good, 0, 1)), InvalidInput);
  EXPECT_THROW(static_cast<void>(classes_of({}, 2, 1)), InvalidInput);
  EXPECT_THROW(static_cast<void>(classes_of(bad, 2, 1)), InvalidInput);
}

}  // namespace
}  // namespace softland::classes_test
