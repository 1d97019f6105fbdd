// The rigid contact of a plate, against exact results: rebounds under a constant force are a geometric series.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "objectives/metrics.h"
#include "tests/support/devices.h"
#include "waveforms/signal.h"

namespace softland {
namespace {

using namespace literals;

constexpr double gap = 1_um, mass = 1e-9, stiffness = 4e-5, volts = 1e8_V;
constexpr double electrode = 100, area = 1e-8;
constexpr double digits = 1e-7;  // the force of the electrode varies by 2e-8 along 1 um of 100 m

/// A plate under a constant force from a distant electrode, on springs that carry a thousandth of the force.
Device falling(double restitution) {
  return {.structure = {.length = 100_um, .width = 100_um, .kind = Plate{.mass = mass, .stiffness = stiffness}},
          .gap = {.electrode = electrode, .contact = gap},
          .electrodes = {{.name = "main", .begin = 0, .end = 100_um, .fringing = Fringing::none}},
          .contacts = {Contact{.model = RigidStop{.restitution = restitution}}}};
}

// Accelerations at rest and at the plane. If they are equal (no springs), the times of the rebounds are a geometric series as
// well.
constexpr double at_rest = vacuum_permittivity * area * volts * volts / (2 * electrode * electrode) / mass;
constexpr double at_plane = at_rest - stiffness / mass * gap;
const double omega = std::sqrt(stiffness / mass);
const double first = std::acos(1 - gap * omega * omega / at_rest) / omega;
const double speed = std::sqrt(2 * at_rest * gap - std::pow(omega * gap, 2));

Trajectory fall(double restitution, double duration, double tolerance = 1e-10) {
  const std::vector<Signal> drives{Signal::constant(volts)};
  return simulate_closing(Switch(falling(restitution)), drives, {.duration = duration, .tolerance = tolerance});
}

/// Returns the duration of a rebound that begins with velocity u.
double lasts(double u) { return 2 / omega * std::atan(u * omega / at_plane); }
double height(double u) { return (std::hypot(at_plane, omega * u) - at_plane) / (omega * omega); }

TEST(RigidContact, ReboundsUnderAConstantForceAreAGeometricSeries) {
  for (const double e : {0.0, 0.3, 0.9, 0.97}) {
    const Trajectory t = fall(e, first * (3 + 4 * e / (1 - e)));
    ASSERT_EQ(t.status, Status::done) << t.message;
    // Count the rebounds that rise at least 1e-6 of the gap.
    std::size_t count = 0;
    for (double u = e * speed; u * u / (2 * at_plane) >= RigidContact::rest_height * gap; u *= e) ++count;
    ASSERT_EQ(t.touches.size(), count + 1) << e;
    double time = first, v = speed, total = 0;
    for (const Touch& touch : t.touches) {
      EXPECT_NEAR(touch.begin, time, digits * time) << e;
      EXPECT_NEAR(touch.impact_velocity, v, digits * speed) << e;
      EXPECT_NEAR(touch.peak_energy, mass * v * v / 2, digits * mass * speed * speed) << e;
      EXPECT_TRUE(std::isnan(touch.peak_force));
      total += touch.peak_energy;
      v *= e;
      time += lasts(v);
    }
    const double for_ever = first * (1 + 2 * e / (1 - e));
    constexpr double springs = 2e-3, left_out = 2e-3;
    EXPECT_NEAR(t.touches.back().begin, for_ever, (springs + left_out) * for_ever) << "the sum of the whole series";

    const auto found = rebounds(t);
    ASSERT_EQ(found.size(), count);
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k].height, height(speed * std::pow(e, static_cast<double>(k + 1))), digits * gap) << e;
    }
    const Metrics m = metrics(t, {.significant_rebound = 1_nm});
    EXPECT_EQ(m.bounce_count, std::count_if(found.begin(), found.end(), [](const Rebound& r) { return r.height > 1_nm; }));
    EXPECT_EQ(m.major_bounce_height, found.empty() ? 0 : found[0].height);
    EXPECT_EQ(m.impact_energy, total);
    EXPECT_TRUE(std::isnan(m.peak_contact_force)) << "an impact has an impulse, not a force";

    EXPECT_TRUE(std::isnan(t.touches.back().end)) << "it rests";
    EXPECT_EQ(t.points.back().velocity, 0);
    EXPECT_NEAR(t.points.back().contact_force, mass * at_plane, digits * mass * at_plane);
    // The energy of the charge at so high a voltage is 1e8 times that of the fall.
    EXPECT_LT(t.energy_error, digits * mass * speed * speed) << e;
  }
}

TEST(RigidContact, HundredsOfReboundsAreHundredsOfEventsAndNoMore) {
  const Trajectory t = fall(0.99, 400 * first, 1e-8);
  ASSERT_EQ(t.status, Status::done);
  EXPECT_EQ(t.touches.size(), 688u);  // ln 1e-6 / (2 ln 0.99) = 687.3
  EXPECT_LT(t.work.steps, 10000);
  const Trajectory all_but_elastic = fall(0.999999, 1000 * first, 1e-8);
  EXPECT_EQ(all_but_elastic.status, Status::done);
  EXPECT_EQ(all_but_elastic.touches.size(), 500u);
  EXPECT_NEAR(all_but_elastic.touches.back().impact_velocity, std::pow(0.999999, 499) * speed, 1e-6 * speed);
}

/// A plate with a film and two electrodes on a rigid contact.
Device stopped_plate(double restitution) {
  Device d = test::full_plate();
  d.contacts = {Contact{.model = RigidStop{.restitution = restitution}}};
  return d;
}

TEST(RigidContact, HoldsThePlateUntilTheForceOfTheSpringsWins) {
  Device d = stopped_plate(0.4);
  d.electrodes.pop_back();
  const Switch model(d);
  const double release = release_voltage(model, 0);
  // The voltage falls linearly from 110 V at 100 us to 0 V at 200 us.
  const std::vector<Signal> drives{Signal::piecewise_linear({{0, 110}, {100_us, 110}, {200_us, 0}})};
  const Trajectory t = simulate_closing(model, drives, {.duration = 220_us, .tolerance = 1e-10});
  ASSERT_EQ(t.status, Status::done);
  const double leaves = 100_us + 100_us * (1 - release / 110);
  const auto resting =
      std::find_if(t.touches.begin(), t.touches.end(), [](const Touch& one) { return !(one.end - one.begin < 1_us); });
  ASSERT_NE(resting, t.touches.end());
  EXPECT_NEAR(resting->end, leaves, 1e-9 * leaves);
  EXPECT_LT(t.points.back().position, 0.7 * d.gap.contact) << "it goes back";
  // While the plate rests, the contact carries the difference between the electrode's force and the spring's.
  for (const TrajectoryPoint& p : t.points) {
    if (p.time < resting->begin || p.time > resting->end || p.velocity != 0) continue;
    EXPECT_GE(p.contact_force, 0);
    EXPECT_NEAR(p.position, d.gap.contact, 1e-15);
    const auto closed = closed_equilibrium(model, std::vector<double>{drives[0].voltage(p.time)});
    if (!closed || p.time == resting->begin) continue;
    EXPECT_NEAR(p.contact_force, closed->contact_force, 1e-9 * closed->contact_force);
  }
  EXPECT_LT(std::abs(t.energy.residual()), 1e-7 * t.energy.source_work);
}

TEST(RigidContact, LetsGoAtOnceWhenTheVoltageJumpsBelowRelease) {
  Device d = stopped_plate(0);
  d.electrodes.pop_back();
  const Switch model(d);
  const double release = release_voltage(model, 0);
  for (const double left : {0.999, 1.001}) {
    const std::vector<Signal> drives{Signal::piecewise_linear({{0, 110}, {60_us, 110}, {60_us, left * release}})};
    const Trajectory t = simulate_closing(model, drives, {.duration = 200_us, .tolerance = 1e-9});
    ASSERT_EQ(t.touches.size(), 1u) << "e = 0: it sticks where it lands";
    if (left < 1) {
      EXPECT_EQ(t.touches[0].end, 60_us);
      EXPECT_LT(t.points.back().position, d.gap.contact);
    } else {
      EXPECT_TRUE(std::isnan(t.touches[0].end));
    }
    EXPECT_LT(std::abs(t.energy.residual()), 1e-7 * t.energy.source_work);
  }
}

TEST(RigidContact, LeavesAndReturnsWithEveryDipOfADither) {
  Device d = stopped_plate(0.5);
  d.electrodes.pop_back();
  const Switch model(d);
  const double release = release_voltage(model, 0);
  // The voltage oscillates 16 times between -0.5 and 2.5 times the release voltage, and each time releases the plate.
  constexpr double begin = 60_us, angular_frequency = 1e6_rad_s;
  const std::vector<Signal> drives{Signal(std::vector<SignalPiece>{{.value = 110},
                                                                   {.begin = begin,
                                                                    .value = release,
                                                                    .amplitude = 1.5 * release,
                                                                    .angular_frequency = angular_frequency,
                                                                    .phase = -angular_frequency * begin}})};
  const Trajectory t = simulate_closing(model, drives, {.duration = 160_us, .tolerance = 1e-10});
  ASSERT_EQ(t.status, Status::done);
  // The number of rests between the dips is chaotic after the first one.
  EXPECT_GE(t.touches.size(), 5u);
  EXPECT_TRUE(std::any_of(t.touches.begin(), t.touches.end(), [](const Touch& one) { return one.end > one.begin; }));
  EXPECT_LT(t.work.steps, 10000);
  EXPECT_LT(std::abs(t.energy.residual()), 1e-7 * t.energy.source_work);
}

TEST(RigidContact, ClosedEquilibriumIsThePlateOnThePlane) {
  const Switch model(stopped_plate(0.5));
  const Device& d = model.device();
  const std::vector<double> volts_there{110, 0};
  const auto closed = closed_equilibrium(model, volts_there);
  ASSERT_TRUE(closed.has_value());
  EXPECT_DOUBLE_EQ(model.contact_deflection(closed->q.data()), d.gap.contact);
  Switch::Workspace work = model.workspace();
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(1), force(1);
  model.accelerations(closed->q.data(), rest.data(), volts_there, false, work, force.data());
  EXPECT_NEAR(closed->contact_force, force[0] / model.basis().contact_shape()[0], 1e-12 * closed->contact_force);
  EXPECT_EQ(closed->potential, model.potential(closed->q.data(), volts_there, false, work));
  // Just above the release voltage there is a closed equilibrium, just below there is none.
  const double release = release_voltage(model, 0);
  EXPECT_TRUE(closed_equilibrium(model, std::vector<double>{1.0001 * release, 0}).has_value());
  EXPECT_FALSE(closed_equilibrium(model, std::vector<double>{0.9999 * release, 0}).has_value());
}

TEST(RigidContact, LandingExcessIsTheSameWhateverTheImpactTakes) {
  const auto excess = [](double e) {
    Device d = stopped_plate(e);
    d.gas.reset();
    const Switch model(d);
    const std::vector<double> hold{110, 0};
    const std::vector<Signal> drives{Signal::constant(110), Signal()};
    const auto closed = closed_equilibrium(model, hold);
    const Trajectory t = simulate_closing(
        model, drives, {.duration = 100_us, .tolerance = 1e-10, .after_contact = 1_us, .closed_potential = closed->potential});
    // The contact has to dissipate the whole kinetic energy of the first impact.
    EXPECT_NEAR(t.landing_excess, t.touches[0].peak_energy, 1e-7 * t.landing_excess) << e;
    return t.landing_excess;
  };
  const double reference = excess(0);
  EXPECT_GT(reference, 0);
  for (const double e : {0.5, 0.95}) EXPECT_NEAR(excess(e), reference, 1e-9 * reference);
}

TEST(RigidContact, IsTheLimitOfStiffDampedSprings) {
  // Hysteretic contact: e^2 = loading over unloading stiffness.
  const auto spring = [](double stiffness) {
    return HystereticSpring{.stiffness = stiffness, .unloading_stiffness = 4 * stiffness};
  };
  const auto run = [](const ContactModel& law) {
    Device d = stopped_plate(0.5);
    d.contacts.front().model = law;
    const std::vector<Signal> drives{Signal::constant(110), Signal()};
    return metrics(simulate_closing(Switch(d), drives, {.duration = 60_us, .tolerance = 1e-8}));
  };
  const Metrics rigid = run(RigidStop{.restitution = 0.5}), soft = run(spring(1e5)), stiff = run(spring(1e7));
  EXPECT_EQ(rigid.initial_contact_time, stiff.initial_contact_time);
  const double near = std::abs(stiff.major_bounce_height / rigid.major_bounce_height - 1);
  EXPECT_LT(near, 0.05);
  EXPECT_LT(near, 0.3 * std::abs(soft.major_bounce_height / rigid.major_bounce_height - 1)) << "and nearer with stiffness";
}

}  // namespace
}  // namespace softland
