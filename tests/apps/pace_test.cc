#include "apps/pace.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softland::apps {
namespace {

TEST(Pace, OfAFinerGridCountsThePointsThatWillBeTakenOver) {
  // A grid of 1000 points, of which every second one is known.
  const Pace halfway{.remaining = 900, .computed = 50, .reused = 50, .earlier = 500, .seconds = 10};
  EXPECT_DOUBLE_EQ(halfway.to_compute(), 450);
  EXPECT_DOUBLE_EQ(halfway.seconds_left(), 90);
}

TEST(Pace, OfALargerSampleCountsItsNewPoints) {
  // 400 points of which the first 300 are known: all points so far were taken over.
  EXPECT_DOUBLE_EQ((Pace{.remaining = 350, .reused = 50, .earlier = 300}).to_compute(), 100);
  EXPECT_TRUE(std::isnan((Pace{.remaining = 350, .reused = 50, .earlier = 300}).seconds_left()));
  // The time since the first computed point is the time of new points only.
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

TEST(WorkPace, EstimatesTheRemainingTimeFromTheCurrentTask) {
  WorkPace pace;
  pace.note("dynamic pull-in voltage", 0.9, 4);
  pace.note("closing", 0, 6);
  EXPECT_EQ(pace.words(6), "closing: 0 %, 6 s");
  pace.note("closing", 0.25, 8);
  EXPECT_EQ(pace.words(8), "closing: 25 %, 8 s, about 6 s left");
  pace.note("closing", 1, 14);
  EXPECT_EQ(pace.words(14), "closing: 100 %, 14 s");
  pace.note("closing", 0.1, 15);  // the same note again
  EXPECT_EQ(pace.words(15), "closing: 10 %, 15 s");
  pace.note("closing", 0.4, 18);
  EXPECT_EQ(pace.words(18), "closing: 40 %, 18 s, about 6 s left");
}

TEST(WorkPace, LeavesOutTheTimeBeforeTheFirstEvaluation) {
  WorkPace pace;
  pace.note("", 1.0 / 20'000, 36);  // the only search of a run has no name
  EXPECT_FALSE(pace.seconds_left(36));
  pace.note("", 4001.0 / 20'000, 46);
  EXPECT_NEAR(pace.seconds_left(46).value(), 40, 0.01);
}

}  // namespace
}  // namespace softland::apps
