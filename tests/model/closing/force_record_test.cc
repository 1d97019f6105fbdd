// The contact force of whole closings: the time from which on it is steady, and its minimum, against knots and contact law.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/literals.h"
#include "integrators/quintic.h"
#include "model/closing.h"
#include "model/contact/contact_law.h"
#include "model/pull_in.h"
#include "tests/model/gold.h"
#include "tests/support/devices.h"
#include "waveforms/pulse.h"
#include "waveforms/step.h"

namespace softland {
namespace {

using namespace literals;

/// Returns drives for a softer landing: released before the touch, and pulled again after it.
std::vector<Signal> thrown() { return {signal(Pulse{.levels = {21_V, 0_V, 17_V}, .times = {20_us, 33_us}, .edge = 0.5_us})}; }

struct Brackets {
  double steady_from = std::numeric_limits<double>::quiet_NaN();  // bounds of the time from which on the force is steady [s]
  double steady_by = steady_from;
  double least = std::numeric_limits<double>::infinity();  // [N]
};

/// Finds brackets of both figures from the knots alone.
Brackets by_knots(const Trajectory& t, double threshold) {
  Brackets found;
  const double touch = t.touches.front().begin;
  bool rises = false, falls = false;
  for (std::size_t i = 1; i < t.points.size(); ++i) {
    const TrajectoryPoint &a = t.points[i - 1], &b = t.points[i];
    if (b.time <= touch) continue;
    falls = falls || (rises && b.contact_force < a.contact_force);
    rises = rises || b.contact_force > a.contact_force;
    if (falls) found.least = std::min(found.least, b.contact_force);
    if (a.contact_force < threshold && b.contact_force >= threshold) found.steady_from = a.time, found.steady_by = b.time;
  }
  return found;
}

TEST(ForceRecord, IsBracketedByTheKnotsUnderEveryLaw) {
  int steady = 0, lost = 0;
  std::vector<Contact> all = test::contacts();
  for (const Contact& padded : test::pad_contacts()) all.push_back(padded);
  for (const Contact& contact : all) {
    Device device = test::gold_cantilever();
    device.contacts = {contact};
    const Switch model(device);
    for (const std::vector<Signal>& drives : {std::vector{Signal::constant(test::step_level)}, thrown()}) {
      SCOPED_TRACE(fmt::format("{}, {} pieces", test::described(contact), drives[0].pieces().size()));
      const auto closed = closed_equilibrium(model, hold_levels(drives));
      const double threshold = 0.1 * (closed ? closed->contact_force : 1e-7);
      const Trajectory t = simulate_closing(model, drives, {.duration = 150_us, .tolerance = 1e-7, .steady_force = threshold});
      ASSERT_EQ(t.status, Status::done) << t.message;
      ASSERT_FALSE(t.touches.empty());
      const Brackets expected = by_knots(t, threshold);
      if (t.points.back().contact_force < threshold) {
        EXPECT_TRUE(std::isnan(t.force.steady_force_time));
        ++lost;
      } else {
        EXPECT_GE(t.force.steady_force_time, expected.steady_from);
        ++steady;
      }
      EXPECT_LE(t.force.least_force_after_touch, expected.least + 1e-15) << "[N]: no rounding of the place where it opens";
      EXPECT_GE(t.force.least_force_after_touch, expected.least - 0.05 * std::abs(expected.least) - 1e-9);
      const Trajectory unasked = simulate_closing(model, drives, {.duration = 150_us, .tolerance = 1e-7});
      EXPECT_TRUE(std::isnan(unasked.force.steady_force_time));
      EXPECT_EQ(unasked.force.least_force_after_touch, t.force.least_force_after_touch);
      EXPECT_EQ(unasked.points.back().position, t.points.back().position) << "measuring changes nothing";
    }
  }
  EXPECT_GE(steady, 5);
  EXPECT_GE(lost, 1);
}

/// The force of an undamped law without memory depends on the position alone.
TEST(ForceRecord, IsThatOfTheLawAlongTheMotion) {
  const Switch& model = test::gold();
  const std::vector<Signal> drives = thrown();
  const double hold = closed_equilibrium(model, hold_levels(drives))->contact_force;
  int inside = 0;
  for (double share = 0.01; share < 1; share += 0.03) {
    SCOPED_TRACE(share);
    const Trajectory t = simulate_closing(model, drives, {.duration = 150_us, .tolerance = 1e-8, .steady_force = share * hold});
    double last_below = 0, least = std::numeric_limits<double>::infinity(), before = 0;
    bool falls = false;
    for (std::size_t i = 1; i < t.points.size(); ++i) {
      const TrajectoryPoint &a = t.points[i - 1], &b = t.points[i];
      if (b.time <= t.touches.front().begin || !(b.time > a.time)) continue;
      const Quintic tip(a.time, a.position, a.velocity, a.acceleration, b.time, b.position, b.velocity, b.acceleration);
      constexpr int samples = 50;
      for (int s = 1; s <= samples; ++s) {
        const double at = a.time + (b.time - a.time) * s / samples, d = tip.position(at) - t.contact_gap;
        const double force = d > 0 ? contact_force(model.contact(), d, true, 0) : 0;
        falls = falls || force < before;
        if (falls) least = std::min(least, force);
        if (force < share * hold) last_below = at;
        before = force;
      }
    }
    EXPECT_LE(t.force.least_force_after_touch, least + 1e-12 * hold);
    EXPECT_NEAR(t.force.least_force_after_touch, least, 1e-3 * hold);
    if (std::isnan(t.force.steady_force_time)) {
      EXPECT_GT(last_below, t.points.back().time - 1e-9) << "below at the end";
      continue;
    }
    ++inside;
    constexpr double sampled = 5e-9;  // [s]; a fiftieth of a piece
    EXPECT_NEAR(t.force.steady_force_time, last_below, sampled);
    EXPECT_GT(t.force.steady_force_time, t.touches.front().begin);
  }
  EXPECT_GT(inside, 10);
}

/// The largest pull of an adhesive contact as it opens depends on the law alone.
TEST(ForceRecord, OfAContactThatPullsIsTheMostThatItPulls) {
  for (const double energy : {0.05, 0.2}) {
    Device device = test::gold_cantilever();
    AdhesiveAsperities law = AdhesiveAsperities::example();
    law.adhesion_energy = energy;
    device.contacts.front().model = law;
    const Switch model(device);
    double most = 0;
    for (double d = 0; d < 20e-9; d += 1e-13) most = std::min(most, contact_force(model.contact(), d, true, 0));
    ASSERT_LT(most, 0);
    const std::vector<Signal> drives{Signal::constant(test::step_level)};
    for (const double tolerance : {1e-5, 1e-9}) {
      const Trajectory t = simulate_closing(model, drives, {.duration = 150_us, .tolerance = tolerance});
      ASSERT_GT(t.touches.size(), 1U) << "it leaves its contact";
      EXPECT_NEAR(t.force.least_force_after_touch, most, 1e-6 * std::abs(most)) << energy << " J/m^2, " << tolerance;
    }
  }
}

TEST(ForceRecord, IsNothingWhereTheContactOpens) {
  int opened = 0;
  for (double volts = 16; volts < 22; volts += 0.1) {
    const Trajectory t =
        simulate_closing(test::gold(), std::vector{Signal::constant(volts)}, {.duration = 100_us, .tolerance = 1e-7});
    if (t.touches.size() < 2) continue;
    ++opened;
    EXPECT_EQ(t.force.least_force_after_touch, 0) << volts;
  }
  EXPECT_GT(opened, 30);
}

TEST(ForceRecord, OfWhatNeverTouchesIsNotKnown) {
  const Trajectory t =
      simulate_closing(test::gold(), std::vector{Signal::constant(5)}, {.duration = 100_us, .steady_force = 1e-9});
  EXPECT_TRUE(std::isnan(t.force.steady_force_time));
  EXPECT_TRUE(std::isnan(t.force.least_force_after_touch));
}

/// A plate without a rebound rests at once: the contact force is that of the electrode less that of the spring.
TEST(ForceRecord, FollowsAPlateAtRest) {
  Device device = test::nickel_plate();
  device.contacts = {Contact{.model = RigidStop{.restitution = 0}}};
  const Switch model(device);
  const double volts = 1.2 * dynamic_pull_in(model, 0, static_pull_in(model, 0)).voltage, later = 1_ms;
  const std::vector<Signal> drives{Signal::piecewise_linear({{0, volts}, {later, volts}, {2 * later, 2 * volts}})};
  const auto at = [&](double steady) {
    return simulate_closing(model, drives, {.duration = 3 * later, .tolerance = 1e-8, .steady_force = steady});
  };
  const Trajectory first = at(0);
  ASSERT_EQ(first.status, Status::done) << first.message;
  ASSERT_EQ(first.touches.size(), 1U);
  const double touch = first.touches[0].begin, hold = first.points.back().contact_force;
  EXPECT_LT(touch, later);
  EXPECT_EQ(first.force.steady_force_time, touch);
  EXPECT_GT(first.force.least_force_after_touch, 0);
  const double begun = first.force.least_force_after_touch;
  EXPECT_EQ(at(0.99 * begun).force.steady_force_time, touch);
  const Trajectory between = at((begun + hold) / 2);
  EXPECT_GT(between.force.steady_force_time, later);
  EXPECT_LT(between.force.steady_force_time, 2 * later);
  EXPECT_TRUE(std::isnan(at(1.01 * hold).force.steady_force_time));
  device.contacts.front().model = RigidStop{.restitution = 0.5};
  const Trajectory bouncing = simulate_closing(Switch(device), drives, {.duration = 3 * later, .tolerance = 1e-8});
  EXPECT_EQ(bouncing.force.least_force_after_touch, 0) << "it opens";
}

}  // namespace
}  // namespace softland
