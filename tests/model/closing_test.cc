// Events, ends and invalid arguments of a closing.
#include "model/closing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "base/literals.h"
#include "integrators/quintic.h"
#include "model/contact/contact_law.h"
#include "model/pull_in.h"
#include "objectives/metrics.h"
#include "tests/model/expect_refused.h"
#include "tests/model/gold.h"
#include "tests/support/devices.h"
#include "waveforms/harmonic.h"
#include "waveforms/pulse.h"

namespace softland {
namespace {

using namespace literals;
using test::gold;
using test::step_level;

const std::vector<Signal>& step() {
  static const std::vector<Signal> drives{Signal::constant(step_level)};
  return drives;
}

TEST(Closing, BeginsAtRestAndKeepsItsKnotsInOrder) {
  const Trajectory t = simulate_closing(gold(), step(), {.duration = 100_us});
  ASSERT_EQ(t.status, Status::done);
  EXPECT_EQ(t.points.front().time, 0);
  EXPECT_EQ(t.points.front().position, 0);
  EXPECT_EQ(t.points.front().velocity, 0);
  EXPECT_GT(t.points.front().acceleration, 0);
  EXPECT_DOUBLE_EQ(t.points.back().time, 100_us);
  for (std::size_t i = 1; i < t.points.size(); ++i) EXPECT_GE(t.points[i].time, t.points[i - 1].time);
  EXPECT_EQ(t.contact_gap, 2_um);
  EXPECT_EQ(t.in_contact_period, gold().basis().in_contact_period());
  EXPECT_GT(t.work.steps, 0);
  EXPECT_GT(t.work.rhs_evaluations, t.work.steps);
  EXPECT_TRUE(t.message.empty());
  EXPECT_TRUE(t.warnings.empty());
}

TEST(Closing, BeginsOnTheContactWhereItIsTold) {
  int closed_ones = 0;
  for (const Contact& contact : test::contacts()) {
    SCOPED_TRACE(name_of(contact.model));
    Device device = test::gold_cantilever();
    device.contacts = {contact};
    const Switch model(device);
    const std::vector<double> holds{step_level};
    const auto closed = closed_equilibrium(model, holds);
    if (!closed) continue;
    ++closed_ones;
    const auto run = [&](const Signal& drive) {
      return simulate_closing(model, std::vector{drive},
                              {.duration = 100_us, .tolerance = 1e-9, .begins_closed = closed->coordinates()});
    };
    // The beam is at rest under the voltage that holds it.
    const Trajectory held = run(Signal::constant(step_level));
    ASSERT_EQ(held.status, Status::done) << held.message;
    const double rests = held.points.front().position;
    EXPECT_GE(rests, held.contact_gap);
    for (const TrajectoryPoint& p : held.points)
      EXPECT_NEAR(p.position, rests, 1e-6 * (rests - held.contact_gap) + 1e-15) << p.time;
    ASSERT_EQ(held.touches.size(), 1U);
    EXPECT_EQ(held.touches[0].begin, 0);
    EXPECT_EQ(held.touches[0].impact_velocity, 0);
    EXPECT_TRUE(std::isnan(held.touches[0].end));
    EXPECT_NEAR(held.points.back().contact_force, closed->contact_force, 1e-6 * closed->contact_force);
    EXPECT_LT(held.energy_error, 1e-6 * model.bending_energy());

    const Trajectory open = run(Signal());
    ASSERT_EQ(open.status, Status::done) << open.message;
    EXPECT_LT(open.energy_error, 1e-5 * model.bending_energy());
    EXPECT_LT(open.points.back().position, open.contact_gap);
    ASSERT_FALSE(open.touches.empty());
    EXPECT_GT(open.touches.back().end, 0);
  }
  EXPECT_EQ(closed_ones, static_cast<int>(test::contacts().size()));
}

TEST(Closing, TouchesAreKnotsOnThePlaneAndForceActsOnlyInside) {
  const Trajectory t = simulate_closing(gold(), step(), {.duration = 100_us});
  ASSERT_GE(t.touches.size(), 8u);
  for (std::size_t i = 0; i < t.touches.size(); ++i) {
    const Touch& touch = t.touches[i];
    const auto at = [&](double time) {
      return std::find_if(t.points.begin(), t.points.end(), [&](const TrajectoryPoint& p) { return p.time == time; });
    };
    ASSERT_NE(at(touch.begin), t.points.end());
    EXPECT_EQ(at(touch.begin)->position, t.contact_gap);
    EXPECT_EQ(std::abs(at(touch.begin)->velocity), touch.impact_velocity);
    EXPECT_GT(at(touch.begin)->velocity, 0);
    EXPECT_GT(touch.end, touch.begin);
    ASSERT_NE(at(touch.end), t.points.end());
    EXPECT_EQ(at(touch.end)->position, t.contact_gap);
    EXPECT_LT(at(touch.end)->velocity, 0);
    if (i > 0) {
      EXPECT_GT(touch.begin, t.touches[i - 1].end);
    }
  }
  double peak_force = 0;
  for (const TrajectoryPoint& p : t.points) {
    const bool inside = p.position > t.contact_gap;
    EXPECT_EQ(p.contact_force > 0, inside) << p.time;
    if (inside) {
      EXPECT_DOUBLE_EQ(p.contact_force, contact_force(gold().contact(), p.position - t.contact_gap));
    }
    peak_force = std::max(peak_force, p.contact_force);
  }
  double recorded = 0, energy = 0;
  for (const Touch& touch : t.touches) {
    recorded = std::max(recorded, touch.peak_force);
    energy = std::max(energy, touch.peak_energy);
  }
  EXPECT_GE(recorded, peak_force);
  EXPECT_LT(recorded, 1.1 * peak_force);
  EXPECT_NEAR(energy, contact_energy(gold().contact(), t.deepest_penetration), 1e-12 * energy);
  EXPECT_NEAR(recorded, contact_force(gold().contact(), t.deepest_penetration), 1e-12 * recorded);
}

TEST(Closing, MissesNoTouchThatADenseRunSees) {
  // A sine of negligible amplitude makes the integrator take steps of nanoseconds, without restarts.
  const std::vector<Signal> dense{signal(Harmonic{.base = step_level, .amplitude = 1e-12_V, .angular_frequency = 1e8_rad_s})};
  constexpr double tolerance = 1e-9;
  const Trajectory fine = simulate_closing(gold(), dense, {.duration = 90_us, .tolerance = tolerance});
  const Trajectory coarse = simulate_closing(gold(), step(), {.duration = 90_us, .tolerance = tolerance});
  EXPECT_GT(fine.work.steps, 5 * coarse.work.steps);
  ASSERT_EQ(coarse.touches.size(), fine.touches.size());
  for (std::size_t i = 0; i < fine.touches.size(); ++i) {
    constexpr double drift = 0.1_ns;  // effect of the tolerance after the last of these touches
    EXPECT_NEAR(coarse.touches[i].begin, fine.touches[i].begin, drift) << "touch " << i;
    if (std::isfinite(fine.touches[i].end)) {
      EXPECT_NEAR(coarse.touches[i].end, fine.touches[i].end, drift) << "touch " << i;
    }
  }
}

TEST(Closing, InterpolantBetweenKnotsNeverCrossesThePlaneUnseen) {
  for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
    const Trajectory t = simulate_closing(gold(), step(), {.duration = 300_us, .tolerance = tolerance});
    std::size_t next = 0;  // index of the touch that is in progress, or next
    for (std::size_t i = 1; i < t.points.size(); ++i) {
      const TrajectoryPoint &a = t.points[i - 1], &b = t.points[i];
      while (next < t.touches.size() && !(a.time < t.touches[next].end)) {
        if (std::isnan(t.touches[next].end)) break;
        ++next;
      }
      if (!(b.time > a.time)) continue;
      const bool inside = next < t.touches.size() && a.time >= t.touches[next].begin;
      const Quintic tip(a.time, a.position, a.velocity, a.acceleration, b.time, b.position, b.velocity, b.acceleration);
      for (int k = 1; k < 8; ++k) {
        const double depth = tip.position(a.time + (b.time - a.time) * k / 8) - t.contact_gap;
        constexpr double rounding = 1e-15;  // [m], of positions near the plane
        EXPECT_TRUE(inside ? depth > -rounding : depth < rounding) << tolerance << " at " << a.time << ": " << depth;
      }
    }
  }
}

TEST(Closing, IntegratorsAgree) {
  // Multistep methods have the largest errors, and so determine the tolerances.
  const Metrics reference = metrics(simulate_closing(gold(), step(), {.duration = 60_us, .tolerance = 1e-11}));
  constexpr double time_digits = 1e-6, velocity_digits = 1e-4, height_digits = 1e-3;  // relative
  for (const Integrator integrator :
       {Integrator::lawson, Integrator::arkode_erk, Integrator::esdirk, Integrator::bdf, Integrator::adams}) {
    const Metrics m = metrics(simulate_closing(gold(), step(), {.duration = 60_us, .tolerance = 1e-8, .integrator = integrator}));
    const auto expect = [&](double value, double expected, double digits) {
      EXPECT_NEAR(value, expected, digits * expected) << static_cast<int>(integrator);
    };
    expect(m.initial_contact_time, reference.initial_contact_time, time_digits);
    expect(m.impact_velocity, reference.impact_velocity, velocity_digits);
    expect(m.major_bounce_height, reference.major_bounce_height, height_digits);
    EXPECT_EQ(m.bounce_count, reference.bounce_count);
  }
}

TEST(Closing, RepeatsItselfBitForBit) {
  const Trajectory a = simulate_closing(gold(), step(), {.duration = 300_us}),
                   b = simulate_closing(gold(), step(), {.duration = 300_us});
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].time, b.points[i].time);
    EXPECT_EQ(a.points[i].position, b.points[i].position);
  }
  EXPECT_EQ(a.energy.source_work, b.energy.source_work);
}

TEST(Closing, StopsAtEveryBreakpoint) {
  const Signal drive = signal(Pulse{.levels = {16_V, 11_V, 17_V}, .times = {12.3_us, 25.1_us}, .edge = 0.5_us});
  const Trajectory t = simulate_closing(gold(), std::vector<Signal>{drive}, {.duration = 40_us});
  for (const double time : drive.breakpoints()) {
    EXPECT_TRUE(std::any_of(t.points.begin(), t.points.end(), [&](const TrajectoryPoint& p) { return p.time == time; })) << time;
  }
}

TEST(Closing, SeesAPulseFarShorterThanItsSteps) {
  // A pulse of 300 V for two nanoseconds while the beam is at rest under 0 V: one long step would miss it.
  const std::vector<Signal> kick{Signal::piecewise_linear({{0, 0}, {10_us, 0}, {10_us, 300}, {10.002_us, 300}, {10.002_us, 0}})};
  Device d = test::gold_cantilever();
  d.gas.reset();
  d.structure.modes = 1;
  const Switch device(d);
  const Trajectory t = simulate_closing(device, kick, {.duration = 40_us});
  Switch::Workspace work = device.workspace();
  const double rest = 0;
  double force = 0;
  device.accelerations(&rest, &rest, std::vector<double>{300}, false, work, &force);
  const double expected = force * device.basis().contact_shape()[0] * 2_ns;  // velocity after the kick
  double fastest = 0;
  for (const TrajectoryPoint& p : t.points) fastest = std::max(fastest, std::abs(p.velocity));
  EXPECT_NEAR(fastest, expected, 1e-3 * expected);
}

TEST(Closing, WithoutDrivesStaysAtRest) {
  const Trajectory t = simulate_closing(gold(), std::vector<Signal>{Signal()}, {.duration = 100_us});
  EXPECT_EQ(t.status, Status::done);
  EXPECT_TRUE(t.touches.empty());
  for (const TrajectoryPoint& p : t.points) EXPECT_EQ(p.position, 0);
  EXPECT_EQ(t.energy.source_work, 0);
}

TEST(Closing, ThatDoesNotReachTheContactHasNoTouches) {
  const Trajectory t = simulate_closing(gold(), std::vector<Signal>{Signal::constant(10_V)}, {.duration = 300_us});
  EXPECT_EQ(t.status, Status::done);
  EXPECT_TRUE(t.touches.empty());
  EXPECT_EQ(metrics(t).status, Status::no_contact);
  EXPECT_EQ(t.deepest_penetration, 0);
  EXPECT_LT(t.smallest_gap, 3.5_um);
  EXPECT_GT(t.smallest_gap, 1.5_um);
}

TEST(Closing, EndsAGivenTimeAfterContact) {
  const Trajectory t = simulate_closing(gold(), step(), {.duration = 600_us, .after_contact = 20_us});
  EXPECT_EQ(t.status, Status::done);
  EXPECT_GE(t.points.back().time, t.touches.front().begin + 20_us);
  EXPECT_LT(t.points.back().time, t.touches.front().begin + 30_us);
  const Trajectory later = simulate_closing(
      gold(), step(), {.duration = 600_us, .after_contact = 20_us, .no_end_before = t.touches.front().begin + 50_us});
  EXPECT_GE(later.points.back().time, t.touches.front().begin + 50_us);
  EXPECT_LT(later.points.back().time, t.touches.front().begin + 55_us);
  const Trajectory at_touch = simulate_closing(gold(), step(), {.duration = 600_us, .after_contact = 0});
  EXPECT_EQ(at_touch.touches.size(), 1u);
  EXPECT_EQ(at_touch.points.back().time, at_touch.touches[0].begin);
}

TEST(Closing, GivesUpWaitingForContactWhenTold) {
  const std::vector<Signal> weak{Signal::constant(10_V)};
  const Trajectory t = simulate_closing(gold(), weak, {.duration = 600_us, .no_contact_before = 50_us});
  EXPECT_EQ(t.status, Status::done);
  EXPECT_TRUE(t.touches.empty());
  EXPECT_GE(t.points.back().time, 50_us);
  EXPECT_LT(t.points.back().time, 80_us);
  // The limit has no effect after a touch.
  const Trajectory closing = simulate_closing(gold(), step(), {.duration = 100_us, .no_contact_before = 50_us});
  EXPECT_DOUBLE_EQ(closing.points.back().time, 100_us);
}

TEST(Closing, EndsWhereTheBeamReachesTheElectrode) {
  Device d = test::gold_cantilever();
  d.contacts.front().model = LinearSpring{.stiffness = 1_N_m};  // far too soft to hold the beam
  const Switch device(d);
  for (const Integrator integrator :
       {Integrator::lawson, Integrator::arkode_erk, Integrator::esdirk, Integrator::bdf, Integrator::adams}) {
    for (const double volts : {20.0, 40.0, 100.0}) {
      const Trajectory t =
          simulate_closing(device, std::vector<Signal>{Signal::constant(volts)}, {.duration = 200_us, .integrator = integrator});
      EXPECT_EQ(t.status, Status::collapsed_onto_electrode) << volts;
      EXPECT_EQ(t.collapse_time, t.points.back().time);
      EXPECT_NE(t.message.find("the beam came within 35 nm of the electrode"), std::string::npos) << t.message;
      EXPECT_EQ(t.message.rfind("at t = ", 0), 0u) << t.message;
      EXPECT_LT(t.smallest_gap, device.gap_floor());
      EXPECT_TRUE(std::isfinite(t.points.back().position));
      EXPECT_EQ(metrics(t).status, Status::collapsed_onto_electrode);
    }
  }
}

TEST(Closing, EndsWhereTheBeamReachesTheFarSide) {
  const std::vector<Signal> drives{Signal(), Signal::constant(200)};
  const Trajectory t = simulate_closing(Switch(test::plate_between_electrodes()), drives, {.duration = 200_us});
  EXPECT_EQ(t.status, Status::collapsed_onto_electrode);
  EXPECT_THAT(t.message, testing::HasSubstr("the beam came within a hundredth of the gap on its far side"));
  EXPECT_LT(t.points.back().position, -3.7_um);
}

TEST(Closing, FailsWhenItNeedsMoreStepsThanAllowed) {
  const Trajectory t = simulate_closing(gold(), step(), {.duration = 600_us, .max_steps = 50});
  EXPECT_EQ(t.status, Status::numerical_failure);
  EXPECT_EQ(t.work.steps, 50);
  EXPECT_NE(t.message.find("more than 50 steps needed"), std::string::npos) << t.message;
}

TEST(Closing, IsInterruptedFromOutside) {
  std::atomic<bool> stop{true};
  const Trajectory t = simulate_closing(gold(), step(), {.duration = 600_us, .stop = &stop});
  EXPECT_EQ(t.status, Status::interrupted);
  EXPECT_LE(t.work.steps, 1);
  stop = false;
  EXPECT_EQ(simulate_closing(gold(), step(), {.duration = 60_us, .stop = &stop}).status, Status::done);
}

TEST(Closing, ShowsEveryStepToItsObserverAndEndsAtItsWord) {
  double last = -1;
  long calls = 0;
  const auto progress = [&](double t, const double* q, const double* v) {
    EXPECT_GE(t, last);
    last = t;
    ++calls;
    EXPECT_TRUE(std::isfinite(q[0]) && std::isfinite(v[0]));
    return t > 20_us;
  };
  const Trajectory t = simulate_closing(gold(), step(), {.duration = 600_us, .observer = progress});
  EXPECT_EQ(t.status, Status::done);
  EXPECT_EQ(calls, t.work.steps);
  EXPECT_EQ(t.points.back().time, last);
  EXPECT_GT(last, 20_us);
  EXPECT_LT(last, 30_us);
}

TEST(Closing, WithoutAContactLawEndsAtFirstTouch) {
  Device d = test::gold_cantilever();
  d.contacts.clear();
  const Trajectory t = simulate_closing(Switch(d), step(), {.duration = 100_us});
  EXPECT_EQ(t.status, Status::done);
  EXPECT_TRUE(t.ends_at_touch);
  ASSERT_EQ(t.touches.size(), 1u);
  EXPECT_EQ(t.points.back().time, t.touches[0].begin);
  EXPECT_EQ(t.points.back().position, 2_um);
  ASSERT_EQ(t.warnings.size(), 1u);
  EXPECT_EQ(t.warnings[0], "no [contact] section: the run ends at first touch");
}

TEST(Closing, WarnsWhenTheAsperitiesAreCrushed) {
  Device d = test::gold_cantilever();
  test::rough(d).height = 2_nm;
  const Trajectory t = simulate_closing(Switch(d), step(), {.duration = 60_us});
  ASSERT_EQ(t.warnings.size(), 1u);
  EXPECT_EQ(t.warnings[0].rfind("contact law asperity-uniform: interference ", 0), 0u) << t.warnings[0];
  EXPECT_NE(t.warnings[0].find("exceeds the asperity height 2 nm"), std::string::npos) << t.warnings[0];
}

TEST(ContactMemory, TakesFromTheMotionWhatTheDentSays) {
  const HystereticSpring spring{.stiffness = 1e5_N_m, .unloading_stiffness = 2e5_N_m};
  for (const ContactModel& law : {ContactModel(spring), ContactModel(PlasticAsperities::example())}) {
    Device d = test::gold_cantilever();
    d.gas.reset();
    d.structure.modes = 1;
    d.contacts.front().model = law;
    const Switch device(d);
    // One undamped mode gets an impulse, reaches the contact, and then has no drive.
    const std::vector<Signal> kick{Signal::piecewise_linear({{0, 0}, {0, 300}, {0.3_us, 300}, {0.3_us, 0}})};
    const Trajectory t = simulate_closing(device, kick, {.duration = 200_us, .tolerance = 1e-9});
    ASSERT_EQ(t.status, Status::done);
    ASSERT_GE(t.touches.size(), 2u);
    const auto speed = [&](double time) {
      return std::find_if(t.points.begin(), t.points.end(), [&](const TrajectoryPoint& p) { return p.time == time; })->velocity;
    };
    const double mass = 1 / std::pow(device.basis().contact_shape()[0], 2);
    const double before = t.touches[0].impact_velocity, after = speed(t.touches[0].end);
    const double expected = dent(device.contact(), t.deepest_penetration).lost;
    EXPECT_LT(after, 0);
    EXPECT_NEAR(mass * (before * before - after * after) / 2, expected, 1e-6 * expected);
    // The beam moves through its rest position, and without a drive returns at the same speed.
    EXPECT_NEAR(t.touches[1].impact_velocity, -after, 1e-6 * before);
    if (std::holds_alternative<HystereticSpring>(law)) {
      // The beam's own spring acts beside the contact: its effect is the interference over the gap.
      EXPECT_NEAR(std::pow(after / before, 2), 0.5, 0.01);
      EXPECT_NEAR(std::pow(speed(t.touches[1].end) / after, 2), 0.5, 0.02) << "the dent heals";
    } else {
      EXPECT_NEAR(speed(t.touches[1].end), after, 1e-6 * before) << "a lighter impact on the dent is elastic";
    }
  }
}

// Compares only touches on which tighter runs agree: later touches magnify the errors of the earlier ones.
TEST(ThroughContact, IsTheSameClosingUnderEveryLawWithoutMemory) {
  constexpr std::size_t compared = 3;  // number of compared touches
  constexpr double drift = 1_ns, digits = 1e-4;
  std::vector<Contact> contacts = test::contacts();
  for (const Contact& c : test::pad_contacts()) contacts.push_back(c);
  int tried = 0;
  for (const Contact& contact : contacts) {
    Device device = test::gold_cantilever();
    device.contacts = {contact};
    const Switch with(device);
    if (!why_always_restarted(with).empty()) continue;
    ++tried;
    SCOPED_TRACE(test::described(contact));
    ClosingOptions options{.duration = 60_us, .tolerance = 1e-9};
    const Trajectory restarted = simulate_closing(with, step(), options);
    options.restart_at_contact = false;
    const Trajectory through = simulate_closing(with, step(), options);
    ASSERT_EQ(through.status, Status::done) << through.message;
    ASSERT_GE(restarted.touches.size(), compared);
    ASSERT_GE(through.touches.size(), compared);
    for (std::size_t i = 0; i < compared; ++i) {
      const Touch &a = through.touches[i], &b = restarted.touches[i];
      EXPECT_NEAR(a.begin, b.begin, drift) << i;
      EXPECT_NEAR(a.impact_velocity, b.impact_velocity, digits * restarted.touches[0].impact_velocity) << i;
      EXPECT_NEAR(a.peak_force, b.peak_force, digits * restarted.touches[0].peak_force) << i;
      if (std::isfinite(b.end)) {
        EXPECT_NEAR(a.end, b.end, drift) << i;
      }
    }
  }
  EXPECT_GE(tried, 10);
}

TEST(ThroughContact, GoesOnWhereADefaultRunStopsAndStartsAnew) {
  const auto steps_that_end_at_a_touch = [](bool restart) {
    std::vector<double> ends;
    ClosingOptions options{.duration = 60_us, .restart_at_contact = restart};
    options.observer = [&](double t, const double*, const double*) { return ends.push_back(t), false; };
    const Trajectory t = simulate_closing(gold(), step(), options);
    EXPECT_GE(t.touches.size(), 3u);
    for (std::size_t i = 1; i < t.points.size(); ++i) EXPECT_GE(t.points[i].time, t.points[i - 1].time);
    return std::count_if(t.touches.begin(), t.touches.end(),
                         [&](const Touch& touch) { return std::find(ends.begin(), ends.end(), touch.begin) != ends.end(); });
  };
  EXPECT_GE(steps_that_end_at_a_touch(true), 3);
  EXPECT_EQ(steps_that_end_at_a_touch(false), 0);
}

TEST(ThroughContact, IsRefusedWhereTheContactIsNoFunctionOfTheState) {
  const auto run = [](const Device& device) {
    return [=] { (void)simulate_closing(Switch(device), step(), {.duration = 1e-4, .restart_at_contact = false}); };
  };
  Device device = test::gold_cantilever();
  device.contacts.front().model = HystereticSpring{.stiffness = 1e4, .unloading_stiffness = 2e4};
  test::expect_refused(run(device), "restart_at_contact = false: a contact law with memory turns at the deepest point");
  device = test::full_plate();
  device.electrodes.pop_back();
  device.contacts = {Contact{.model = RigidStop{.restitution = 0.5}}};
  test::expect_refused(run(device), "restart_at_contact = false: an impact on a rigid contact has no contact force");
}

TEST(Closing, RefusesBadArguments) {
  const auto run = [](const std::vector<Signal>& drives, double duration, double tolerance) {
    return [=] { (void)simulate_closing(gold(), drives, {.duration = duration, .tolerance = tolerance}); };
  };
  using test::expect_refused;
  expect_refused(run({}, 1e-4, 1e-6), "0 signals are given; a switch with 1 drives needs one per drive");
  expect_refused(run({Signal(), Signal()}, 1e-4, 1e-6), "2 signals are given; a switch with 1 drives needs one per drive");
  expect_refused(run(step(), 0, 1e-6), "duration = 0 s: must be greater than 0 s and below 1e6 s");
  expect_refused(run(step(), -1, 1e-6), "duration = -1 s: must be greater than 0 s and below 1e6 s");
  expect_refused(run(step(), 1e6, 1e-6), "duration = 1000000 s: must be greater than 0 s and below 1e6 s");
  expect_refused(run(step(), std::nan(""), 1e-6), "duration = nan s: must be greater than 0 s and below 1e6 s");
  expect_refused(run(step(), 1e-4, 0), "tolerance = 0: must be in (0, 0.1]");
  expect_refused(run(step(), 1e-4, 0.2), "tolerance = 0.2: must be in (0, 0.1]");
  expect_refused(run(step(), 1e-4, std::nan("")), "tolerance = nan: must be in (0, 0.1]");
}

}  // namespace
}  // namespace softland
