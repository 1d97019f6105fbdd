#include "tests/support/invariants.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/literals.h"
#include "studies/closing/prepared.h"
#include "tests/support/devices.h"
#include "tests/support/random_scenes.h"

namespace softland::test {
namespace {

using namespace literals;

TEST(MissedTouch, IsFoundInEitherRunAsLongAsTheyAgree) {
  const Switch model(gold_cantilever());
  const std::vector<Signal> drives{Signal::constant(17.771)};
  const auto run = [&](double tolerance) {
    return simulate_closing(model, drives, {.duration = 100_us, .tolerance = tolerance});
  };
  const Trajectory one = run(1e-8), tighter = run(1e-10);
  EXPECT_EQ(missed_touch(one, tighter), "");
  constexpr std::size_t agree = 6;  // number of touches
  ASSERT_GT(one.touches.size(), agree);
  for (std::size_t i = 0; i < agree; ++i) {
    Trajectory without = one;
    without.touches.erase(without.touches.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(missed_touch(without, tighter), "") << i;
    EXPECT_NE(missed_touch(tighter, without), "") << i;
  }
  Trajectory none = one;
  none.touches.clear();
  EXPECT_NE(missed_touch(none, tighter), "");
  EXPECT_EQ(missed_touch(none, none), "");
}

TEST(MissedTouch, IsNoneWhereRunsPartLittleByLittle) {
  const PreparedScene p = prepare(random_scene(2, 2368));  // a soft landing with two hundred touches in the dent
  const auto run = [&](double tolerance) {
    return simulate_closing(p.model, p.signals(), {.duration = p.duration, .tolerance = tolerance});
  };
  const Trajectory one = run(1e-7), tighter = run(1e-9);
  EXPECT_GT(one.touches.size(), 100u);
  EXPECT_EQ(missed_touch(one, tighter), "");
}

TEST(MissedTouch, IsNoneWhereATouchIsGentlerThanWhatTheRunsDifferBy) {
  Trajectory one{.contact_gap = 1, .points = {{.time = 0}, {.time = 1, .velocity = 1}, {.time = 3}}};
  one.touches = {{.begin = 1, .impact_velocity = 1}};
  const auto with = [&](double speed) {
    Trajectory other = one;
    other.touches.push_back({.begin = 2, .impact_velocity = speed});
    return other;
  };
  EXPECT_EQ(missed_touch(one, with(5e-4)), "");
  EXPECT_NE(missed_touch(one, with(5e-3)), "");
}

}  // namespace
}  // namespace softland::test
