// Compares the thinned record of a long closing with the full course.
#include "objectives/course_recorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace softland::course_recorder_test {
namespace {

constexpr double gap = 2e-6;
constexpr std::size_t few = 64;

// Falls onto the plane and bounces with decreasing height: half waves of a sine, with knots at their ends and between them,
// then a knot beyond the plane.
std::vector<TrajectoryPoint> bounces(int flights, int knots_each) {
  std::vector<TrajectoryPoint> all;
  for (int n = 0; n < flights; ++n) {
    const double height = gap * std::pow(0.99, n) * (1 + 0.3 * std::sin(7.0 * n));
    for (int k = 0; k <= knots_each; ++k) {
      const double phase = std::numbers::pi * (n == 0 ? 0.5 + 0.5 * k / knots_each : static_cast<double>(k) / knots_each);
      const double above = k == knots_each ? 0 : height * std::sin(phase);
      all.push_back({.time = n + phase / std::numbers::pi,
                     .position = gap - above,
                     .velocity = -height * std::numbers::pi * std::cos(phase),
                     .acceleration = height * std::numbers::pi * std::numbers::pi * std::sin(phase),
                     .contact_force = k == knots_each ? 1 + std::cos(3.0 * n) : 0});
    }
    all.push_back({.time = static_cast<double>(n + 1), .position = gap * (1 + 1e-3)});
  }
  return all;
}

struct Recorded {
  Trajectory run{.status = Status::done, .contact_gap = gap};
  Metrics metrics;
  std::vector<Rebound> rebounds;
  bool is_thinned = false;
};

Recorded record(const std::vector<TrajectoryPoint>& knots, std::size_t most) {
  CourseRecorder recorder(gap, {}, most);
  for (const TrajectoryPoint& p : knots) recorder.knot(p);
  recorder.touch({.begin = 0.5, .end = 1, .impact_velocity = 3, .peak_force = 2, .peak_energy = 1});
  Recorded r;
  recorder.hand_over(r.run);
  r.metrics = recorder.metrics(r.run);
  r.rebounds = recorder.rebounds();
  r.is_thinned = recorder.is_thinned();
  return r;
}

TEST(CourseRecorder, KeepsFiguresAndReboundsOfAllKnots) {
  Trajectory all{.status = Status::done, .contact_gap = gap, .points = bounces(300, 40), .touches = {}};
  const Recorded kept = record(all.points, few);
  all.touches = kept.run.touches;
  ASSERT_EQ(all.touches.size(), 1U);
  EXPECT_TRUE(kept.is_thinned);
  const Metrics expected = metrics(all);
  EXPECT_EQ(expected.bounce_count, 299);
  EXPECT_EQ(kept.metrics.bounce_count, expected.bounce_count);
  EXPECT_EQ(kept.metrics.major_bounce_height, expected.major_bounce_height);
  EXPECT_EQ(kept.metrics.initial_contact_time, expected.initial_contact_time);
  EXPECT_EQ(kept.metrics.peak_contact_force, expected.peak_contact_force);
  const std::vector<Rebound> of_all = rebounds(all);
  ASSERT_EQ(kept.rebounds.size(), of_all.size());
  for (std::size_t k = 0; k < of_all.size(); ++k) {
    EXPECT_EQ(kept.rebounds[k].height, of_all[k].height);
    EXPECT_EQ(kept.rebounds[k].begin, of_all[k].begin);
  }
}

TEST(CourseRecorder, KeepsTheExtremesOfWhatItLeavesOut) {
  const std::vector<TrajectoryPoint> all = bounces(300, 40);
  const std::vector<TrajectoryPoint> kept = record(all, few).run.points;
  EXPECT_LE(kept.size(), few);
  EXPECT_GT(kept.size(), few / 4);
  EXPECT_TRUE(std::ranges::is_sorted(kept, {}, &TrajectoryPoint::time));
  EXPECT_EQ(kept.front().time, all.front().time);
  EXPECT_EQ(kept.back().time, all.back().time);
  for (double TrajectoryPoint::*column :
       {&TrajectoryPoint::position, &TrajectoryPoint::velocity, &TrajectoryPoint::contact_force}) {
    EXPECT_EQ(std::ranges::max(kept, {}, column).*column, std::ranges::max(all, {}, column).*column);
    EXPECT_EQ(std::ranges::min(kept, {}, column).*column, std::ranges::min(all, {}, column).*column);
  }
  // Late times have as many points as early ones.
  const auto late = std::ranges::count_if(kept, [&](const TrajectoryPoint& p) { return p.time > all.back().time / 2; });
  EXPECT_NEAR(static_cast<double>(late), 0.5 * static_cast<double>(kept.size()), 0.2 * static_cast<double>(kept.size()));
}

TEST(CourseRecorder, KeepsTheFirstAndTheLastKnotOfABucket) {
  constexpr int count = 4096;  // buckets have a power of two of knots, so that the quarters are at ends of some buckets
  std::vector<TrajectoryPoint> all;
  for (int k = 0; k < count; ++k) {
    all.push_back({.time = static_cast<double>(k),
                   .position = gap * (1 + std::sin(0.7 * k)),
                   .velocity = std::sin(0.9 * k),
                   .contact_force = 1 + std::sin(1.1 * k)});
  }
  const std::vector<TrajectoryPoint> kept = record(all, few).run.points;
  ASSERT_LE(kept.size(), few);
  for (int end = count / 4; end < count; end += count / 4) {
    for (const int k : {end - 1, end}) EXPECT_EQ(std::ranges::count(kept, k, &TrajectoryPoint::time), 1) << k;
  }
}

TEST(CourseRecorder, LeavesNothingOutOfAShortCourseNorOfOneThatStaysOpen) {
  std::vector<TrajectoryPoint> all = bounces(300, 40);
  EXPECT_EQ(record(all, all.size()).run.points.size(), all.size());
  EXPECT_FALSE(record(all, all.size()).is_thinned);
  for (TrajectoryPoint& p : all) p.position -= gap;
  EXPECT_EQ(record(all, few).run.points.size(), all.size()) << "figures of an open switch take all knots";
}

}  // namespace
}  // namespace softland::course_recorder_test
