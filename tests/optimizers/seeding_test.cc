#include "optimizers/seeding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace softland::internal {
namespace {

TEST(Draw, IsAFunctionOfItsArguments) {
  std::set<std::uint64_t> seen;
  for (const std::uint64_t seed : {0u, 1u, 2u}) {
    for (const Draw study : {Draw::sobol_shift, Draw::skew, Draw::library_seed, Draw::normals}) {
      for (std::uint64_t sample = 0; sample < 100; ++sample) {
        EXPECT_EQ(draw_bits(seed, study, sample), draw_bits(seed, study, sample));
        seen.insert(draw_bits(seed, study, sample));
      }
    }
  }
  EXPECT_EQ(seen.size(), 3u * 4u * 100u);
}

TEST(Draw, IsUniform) {
  constexpr int kSamples = 100000;
  double sum = 0;
  double squares = 0;
  for (std::uint64_t sample = 0; sample < kSamples; ++sample) {
    const double u = draw_uniform(7, Draw::normals, sample);
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  // Five standard deviations of the mean of kSamples uniform numbers, and of their squares.
  EXPECT_NEAR(sum / kSamples, 0.5, 5 * 0.289 / 316);
  EXPECT_NEAR(squares / kSamples, 1.0 / 3, 5 * 0.298 / 316);
}

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
      // One in each interval; the sequence leaves out its first point, which costs one interval and doubles another.
      EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 2);
      EXPECT_LE(std::count(counts.begin(), counts.end(), 0), 1);
    }
  }
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
