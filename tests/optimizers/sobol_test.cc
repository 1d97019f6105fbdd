#include "optimizers/sobol.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace softland::internal {
namespace {

TEST(SobolPoints, MayBeTakenInPieces) {
  const auto whole = sobol_points(3, 5, 0, 40);
  for (std::uint64_t first : {0u, 1u, 7u, 32u}) {
    const auto piece = sobol_points(3, 5, first, 8);
    for (std::size_t k = 0; k < piece.size(); ++k) EXPECT_EQ(piece[k], whole[first + k]);
  }
}

TEST(SobolPoints, SpreadEvenlyAlongEveryAxisWhateverTheSeed) {
  constexpr std::size_t kPoints = 64;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto points = sobol_points(seed, 7, 0, kPoints);
    for (std::size_t i = 0; i < 7; ++i) {
      std::vector<int> counts(kPoints, 0);
      for (const auto& point : points) {
        ASSERT_GE(point[i], 0);
        ASSERT_LT(point[i], 1);
        ++counts[static_cast<std::size_t>(point[i] * kPoints)];
      }
      // One point in each interval; the sequence leaves out its first point, so that one interval is empty and another one has
      // two.
      EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 2);
      EXPECT_LE(std::count(counts.begin(), counts.end(), 0), 1);
    }
  }
}

// The points are those of earlier versions, also for dimensions beyond the sequence.
TEST(SobolPoints, AreThoseOfEarlierVersions) {
  const std::vector<std::vector<double>> expected{{0x1.997cacf986ffp-5, 0x1.f620b7a498d1fp-1, 0x1.a3056e0b90b6fp-1},
                                                  {0x1.1997cacf986ffp-1, 0x1.ec416f4931a3ep-2, 0x1.460adc17216dep-2}};
  EXPECT_EQ(sobol_points(3, 3, 5, 2), expected);
  const auto wide = sobol_points(1, 66, 2, 1);
  EXPECT_EQ(wide[0][63], 0x1.5041b557bc6d7p-1);
  EXPECT_EQ(wide[0][65], 0x1.1c0c125060774p-1);
}

TEST(SobolPoints, DifferBetweenSeeds) { EXPECT_NE(sobol_points(1, 3, 0, 1), sobol_points(2, 3, 0, 1)); }

TEST(SobolPoints, GoOnBeyondTheDimensionsOfTheSequence) {
  const auto points = sobol_points(1, 100, 0, 2);
  EXPECT_EQ(points[0].size(), 100u);
  EXPECT_EQ(std::set<double>(points[0].begin(), points[0].end()).size(), 100u);
  EXPECT_NE(points[0][99], points[1][99]);
}

}  // namespace
}  // namespace softland::internal
