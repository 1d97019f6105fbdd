// Points sorted into classes.
#include "sampling/classes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "base/require.h"
#include "sampling/distribution.h"

namespace softland::classes_test {
namespace {

// Equidistant quantiles of the standard normal distribution, on a line.
std::vector<PlanePoint> normal_points(std::size_t count) {
  const Distribution normal(Normal{.mean = 0, .standard_deviation = 1});
  std::vector<PlanePoint> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({normal.quantile((static_cast<double>(i) + 0.5) / static_cast<double>(count)), 0});
  return points;
}

TEST(Classes, OfANormalQuantityAreThoseOfMax) {
  const std::vector<PlanePoint> points = normal_points(4000);
  constexpr double tolerance = 5e-3;  // of a local minimum for 4000 points
  // J. Max, IRE Trans. Inf. Theory 6 (1960) 7, table I.
  for (const std::vector<double>& published : {std::vector{-1.510, -0.4528, 0.4528, 1.510},
                                               std::vector{-2.152, -1.344, -0.7560, -0.2451, 0.2451, 0.7560, 1.344, 2.152}}) {
    const Classes classes = classes_of(points, published.size(), 1);
    ASSERT_EQ(classes.centres.size(), published.size());
    for (std::size_t c = 0; c < published.size(); ++c) EXPECT_NEAR(classes.centres[c][0], published[c], 2 * tolerance) << c;
    EXPECT_NEAR(std::accumulate(classes.shares.begin(), classes.shares.end(), 0.0), 1, 1e-12);
    EXPECT_GT(classes.shares[published.size() / 2], classes.shares[0]) << "the outermost hold the fewest";
  }
}

TEST(Classes, AreTheClumpsOfThePlaneWhateverTheSeed) {
  std::vector<PlanePoint> points;
  for (const PlanePoint clump : {PlanePoint{0, 0}, PlanePoint{0, 10}, PlanePoint{10, 0}}) {
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
  const std::vector<PlanePoint> points{{1, 1}, {2, 2}, {1, 1}};
  const Classes classes = classes_of(points, 7, 1);
  ASSERT_EQ(classes.centres.size(), 2U);
  EXPECT_DOUBLE_EQ(classes.shares[0], 2.0 / 3);
}

TEST(Classes, RefuseWhatCannotBeSorted) {
  const std::vector<PlanePoint> good{{1, 1}}, bad{{1, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_THROW(static_cast<void>(classes_of(good, 0, 1)), InvalidInput);
  EXPECT_THROW(static_cast<void>(classes_of({}, 2, 1)), InvalidInput);
  EXPECT_THROW(static_cast<void>(classes_of(bad, 2, 1)), InvalidInput);
}

}  // namespace
}  // namespace softland::classes_test
