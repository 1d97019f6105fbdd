// Tests that the motion which pages show is that of the closing with the reported figures.
#include "studies/closing/shown_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>

namespace softland {
namespace {

PreparedScene shipped(const char* name, std::initializer_list<const char*> settings = {}) {
  SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/" + name);
  for (const char* setting : settings) file.set(setting);
  return prepare(file);
}

// Returns the sum of the modes at a position, positive towards the near electrode [m].
double deflection(const ShownMotion& motion, std::size_t row, double at) {
  const auto place = std::ranges::find(motion.places, at) - motion.places.begin();
  double sum = 0;
  for (std::size_t i = 0; i < motion.shapes.size(); ++i)
    sum += motion.amplitudes[i][row] * motion.shapes[i][static_cast<std::size_t>(place)];
  return sum;
}

// Compares the knots of a course with the sums of the modes. The integrator repeats a step with a touch up to the touch, and
// the knots before the touch belong to the longer step, whose interpolant has errors of the tolerance.
void expect_the_course(const ShownMotion& motion, const ShownMotion::Contact& contact,
                       const std::vector<TrajectoryPoint>& points) {
  constexpr double rounding = 1e-11, of_longer_step = 1e-8;  // over the gap
  ASSERT_TRUE(std::ranges::find(motion.places, contact.at) != motion.places.end());
  std::size_t compared = 0, exact = 0;
  for (std::size_t row = 0; row < motion.time.size(); ++row) {
    const auto knot = std::ranges::lower_bound(points, motion.time[row], {}, &TrajectoryPoint::time);
    if (knot == points.end() || knot->time != motion.time[row]) continue;
    ++compared;
    const double position = (contact.far_side ? -1 : 1) * deflection(motion, row, contact.at);
    const double error = std::abs(position - knot->position) / contact.gap;
    exact += error <= rounding ? 1 : 0;
    EXPECT_TRUE(error <= of_longer_step) << motion.time[row] << ": off by " << error;
  }
  EXPECT_GT(exact, compared * 9 / 10);
  EXPECT_GT(compared, motion.time.size() / 2);
}

bool holds(const ShownMotion& motion, double time) { return std::ranges::find(motion.time, time) != motion.time.end(); }

TEST(ShownMotion, AddsUpToTheCourseOfTheContactPoint) {
  for (const char* name : {"mem-gold.toml", "mem-gold-pzt.toml", "two-electrodes.toml", "ohmic-gold.toml",
                           "capacitive-bridge.toml", "mem-gold-modes.toml", "new/plate.toml", "nem-casimir.toml"}) {
    SCOPED_TRACE(name);
    const PreparedScene scene = shipped(name);
    for (const bool judged : {false, true}) {
      const Closing closing = simulate(scene, judged);
      const auto motion = shown_motion(scene, closing);
      ASSERT_TRUE(motion);
      EXPECT_LE(motion->time.size(), most_instants);
      EXPECT_EQ(motion->time.front(), closing.trajectory.points.front().time);
      EXPECT_EQ(motion->time.back(), closing.trajectory.points.back().time);
      expect_the_course(*motion, motion->contacts.front(), closing.trajectory.points);
    }
  }
}

TEST(ShownMotion, FollowsEachOfSeveralContacts) {
  const PreparedScene scene = shipped("new/two-contacts.toml");
  const Closing closing = simulate(scene, false);
  const auto motion = shown_motion(scene, closing);
  ASSERT_TRUE(motion);
  ASSERT_EQ(motion->contacts.size(), 3U);
  EXPECT_TRUE(motion->contacts[2].far_side);
  for (std::size_t c = 0; c < motion->contacts.size(); ++c)
    expect_the_course(*motion, motion->contacts[c], closing.trajectory.contacts[c].points);
}

TEST(ShownMotion, HoldsTheExtremesOfRebounds) {
  const PreparedScene scene = shipped("mem-gold.toml");
  const Closing closing = simulate(scene, true);
  const auto motion = shown_motion(scene, closing);
  ASSERT_TRUE(motion);
  ASSERT_GT(closing.rebounds.size(), 3U);
  constexpr double quintic = 1e-4;  // error of the course's polynomial over the height of a rebound
  for (const Rebound& rebound : closing.rebounds) {
    if (!(rebound.height > scene.scene.metrics.significant_rebound)) continue;
    for (const double time : {rebound.begin, rebound.time_of_height, rebound.end}) EXPECT_TRUE(holds(*motion, time)) << time;
    const auto row = std::ranges::find(motion->time, rebound.time_of_height) - motion->time.begin();
    const double gap = motion->contacts[0].gap - deflection(*motion, static_cast<std::size_t>(row), motion->contacts[0].at);
    EXPECT_TRUE(std::abs(gap - rebound.height) <= quintic * rebound.height) << rebound.time_of_height;
  }
}

TEST(ShownMotion, IsMissedByStraightLinesByATenthOfAPercentAtTheMost) {
  const PreparedScene scene = shipped("mem-gold.toml");
  const Closing closing = simulate(scene, false);
  const auto motion = shown_motion(scene, closing);
  ASSERT_TRUE(motion);
  const ShownMotion::Contact& contact = motion->contacts[0];
  double worst = 0;
  for (const TrajectoryPoint& point : closing.trajectory.points) {
    const auto next = std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(motion->time, point.time) - motion->time.begin(), 1,
                                                 static_cast<std::ptrdiff_t>(motion->time.size()) - 1);
    const auto row = static_cast<std::size_t>(next);
    const double share = (point.time - motion->time[row - 1]) / (motion->time[row] - motion->time[row - 1]);
    const double drawn = std::lerp(deflection(*motion, row - 1, contact.at), deflection(*motion, row, contact.at), share);
    worst = std::max(worst, std::abs(drawn - point.position));
  }
  EXPECT_TRUE(worst <= 1e-3 * contact.gap) << worst / contact.gap;
}

TEST(ShownMotion, HasFewerInstantsWhereThereAreMoreModes) {
  const PreparedScene scene = shipped("mem-gold.toml", {"structure.modes=20", "simulate.duration=100 us"});
  const auto motion = shown_motion(scene, simulate(scene, false));
  ASSERT_TRUE(motion);
  EXPECT_LE(motion->time.size() * motion->amplitudes.size(), most_amplitudes);
}

TEST(ShownMotion, IsNotThereWhereTheRunFailed) {
  const PreparedScene scene = shipped("mem-gold.toml");
  Closing closing = simulate(scene, false);
  closing.trajectory.status = Status::numerical_failure;
  EXPECT_FALSE(shown_motion(scene, closing));
}

}  // namespace
}  // namespace softland
