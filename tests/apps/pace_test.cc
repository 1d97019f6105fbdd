#include "apps/pace.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softland::apps {
namespace {

TEST(Pace, OfAFinerGridCountsThePointsThatWillBeTakenOver) {
  // A grid of 1000 points of which every other one is known.
  const Pace halfway{.remaining = 900, .computed = 50, .reused = 50, .earlier = 500, .seconds = 10};
  EXPECT_DOUBLE_EQ(halfway.to_compute(), 450);
  EXPECT_DOUBLE_EQ(halfway.seconds_left(), 90);
}

TEST(Pace, OfALargerSampleCountsItsNewPoints) {
  // 400 points of which the first 300 are known: all that was taken until now was taken over.
  EXPECT_DOUBLE_EQ((Pace{.remaining = 350, .reused = 50, .earlier = 300}).to_compute(), 100);
  EXPECT_TRUE(std::isnan((Pace{.remaining = 350, .reused = 50, .earlier = 300}).seconds_left()));
  // The time since the first point that had to be computed is that of the new points alone.
  EXPECT_DOUBLE_EQ((Pace{.remaining = 80, .computed = 20, .reused = 300, .earlier = 300, .seconds = 5}).seconds_left(), 20);
}

TEST(Pace, OfAPlanThatSharesNoPointCountsAllOfThem) {
  EXPECT_DOUBLE_EQ((Pace{.remaining = 90, .computed = 10, .earlier = 1000, .seconds = 1}).seconds_left(), 9);
}

TEST(Pace, IsNotKnownBeforeAnythingWasTaken) {
  EXPECT_TRUE(std::isnan((Pace{.remaining = 90}).to_compute()));
  EXPECT_TRUE(std::isnan((Pace{.remaining = 90}).seconds_left()));
}

TEST(Pace, IsOverWhenNothingRemains) {
  EXPECT_DOUBLE_EQ((Pace{.computed = 10, .reused = 5, .earlier = 5, .seconds = 1}).seconds_left(), 0);
}

}  // namespace
}  // namespace softland::apps
