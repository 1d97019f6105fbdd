// A table of hard cases: each keeps the invariants of tests/support/invariants.h, and its landing is the same with two
// integrators and in a run with a hundredth of the tolerance. Cases with a closed form are in exact_cases_test.cc.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/literals.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "tests/support/devices.h"
#include "tests/support/invariants.h"
#include "waveforms/harmonic.h"
#include "waveforms/pulse.h"
#include "waveforms/step.h"

namespace softland {
namespace {

using namespace literals;
using test::checked_run;
using test::CheckedRun;
using test::Landing;

struct Case {
  std::string name;
  Device device;
  std::vector<Signal> drives;
  double duration = 0;    // [s]
  std::string ends = {};  // part of the message of a run that must fail
};

constexpr char electrode[] = "of the electrode";

constexpr double step_level = 17.771;  // [V], about 1.25 Vdp of the gold cantilever

Device gold_on(const Contact& contact, bool gas = false) {
  Device d = test::gold_cantilever();
  if (!gas) d.gas.reset();
  d.contacts = {contact};
  return d;
}
Device gold_on_spring(double stiffness) { return gold_on({.model = LinearSpring{.stiffness = stiffness}, .pad_length = 5_um}); }

double bending_stiffness(const Device& d) { return 2 * Switch(d).bending_energy() / (d.gap.contact * d.gap.contact); }

std::vector<Case> cases() {
  std::vector<Case> all;
  const double soft = bending_stiffness(test::gold_cantilever());
  for (const double times : {1e3, 1e5, 1e7, 1e9}) {
    all.push_back({fmt::format("a spring {:g} times stiffer than the beam, no damping", times),
                   gold_on_spring(times * soft),
                   {Signal::constant(step_level)},
                   70_us});
  }
  for (const double times : {1e-2, 1e2, 1e4}) {
    Device d = test::gold_cantilever();
    test::rough(d).summits.effective_modulus *= times;
    all.push_back({fmt::format("asperities {:g} times as stiff", times), d, {Signal::constant(step_level)}, 70_us});
  }
  for (const Contact& contact : test::contacts()) {
    all.push_back({fmt::format("no gas, no damping, contact {}", test::described(contact)),
                   gold_on(contact),
                   {Signal::constant(step_level)},
                   120_us});
  }
  {
    Device d = test::gold_cantilever();
    d.structure.modes = 12;
    all.push_back({"twelve modes", d, {Signal::constant(step_level)}, 60_us});
  }
  for (const double dither :
       {6.0, 600.0}) {  // multiples of the first mode's frequency; the fourth mode has 34 times that frequency
    const Device d = test::gold_cantilever();
    const double omega = Switch(d).basis().angular_frequencies()[0];
    all.push_back({fmt::format("dither at {:g} times the first mode's frequency", dither),
                   d,
                   {signal(Harmonic{.base = step_level, .amplitude = 0.3 * step_level, .angular_frequency = dither * omega})},
                   60_us});
  }
  for (const int mode : {0, 1, 3}) {
    Device d = test::gold_cantilever();
    d.gas.reset();
    const double omega = Switch(d).basis().angular_frequencies()[mode];
    all.push_back({fmt::format("dither on the resonance of mode {} without damping", mode + 1),
                   d,
                   {signal(Harmonic{.base = 0.8 * step_level, .amplitude = 0.4 * step_level, .angular_frequency = omega})},
                   90_us});
  }
  for (const double edge : {0.0, 1e-12, 1e-15}) {
    all.push_back({fmt::format("edges of {:g} s", edge),
                   test::gold_cantilever(),
                   {signal(Pulse{.levels = {1.2 * step_level, 0, step_level}, .times = {15_us, 17_us}, .edge = edge})},
                   70_us});
  }
  {
    // 2 ps of 20 kV every 2 us.
    Pulse shots{.levels = {2e4}};
    for (int i = 0; i < 12; ++i) {
      shots.times.insert(shots.times.end(), {i * 2_us + 2e-12, (i + 1) * 2_us});
      shots.levels.insert(shots.levels.end(), {step_level, 2e4});
    }
    shots.levels.back() = step_level;
    all.push_back({"pulses shorter than any step", test::gold_cantilever(), {signal(shots)}, 50_us});
  }
  {
    Device d = test::nano_cantilever();
    d.dispersion.reset();
    d.gap = {.electrode = 6_nm, .contact = 5_nm};
    test::rough(d).height = 0.1_nm;
    test::rough(d).summits.effective_modulus *= 10;
    all.push_back({"a gap of 5 nm", d, {Signal::constant(static_pull_in(Switch(d), 0).voltage)}, 30_ns});
    d = test::gold_cantilever();
    d.gap = {.electrode = 80_um, .contact = 50_um};
    all.push_back({"a gap of 50 um", d, {Signal::constant(1.1 * static_pull_in(Switch(d), 0).voltage)}, 100_us});
  }
  for (const double repulsion : {0.0, 0.15e-9}) {
    Device d = test::nano_cantilever();
    d.gap = {.electrode = 5_nm, .contact = 4.8_nm};
    d.dispersion->model = DispersionModel::van_der_waals;
    d.dispersion->equilibrium_distance = repulsion;
    d.contacts.front().pad_length = 2_nm;
    test::rough(d).summits.density = 1e17;
    test::rough(d).height = 0.02_nm;
    test::rough(d).summits.effective_modulus = 1e12;
    const Signal drives = Signal::constant(static_pull_in(Switch(d), 0).voltage);
    all.push_back({fmt::format("van der Waals force to a gap of 0.2 nm, repulsion at {:g} m", repulsion),
                   d,
                   {drives, Signal()},
                   3_ns,
                   repulsion > 0 ? "" : electrode});
  }
  for (const double times : {10.0, 1000.0}) {
    const Device d = test::gold_cantilever();
    all.push_back({fmt::format("{:g} times the pull-in voltage", times),
                   d,
                   {Signal::constant(times * static_pull_in(Switch(d), 0).voltage)},
                   60_us / times,
                   electrode});
  }
  {
    Device plate = test::full_plate();
    plate.gap.contact = 1_um;
    plate.contacts.front().model = LinearSpring{.stiffness = 1e9};
    const double pull_in = static_pull_in(Switch(plate), 0).voltage;
    all.push_back({"a plate under 1000 times its pull-in voltage", plate, {Signal::constant(1000 * pull_in), Signal()}, 100_ns});
  }
  {
    const Pulse to_and_fro{.levels = {step_level, 0, step_level, 0}, .times = {45_us, 80_us, 125_us}, .edge = 1_us};
    all.push_back({"released and closed again", test::gold_cantilever(), {signal(to_and_fro)}, 160_us});
    Device plate = test::full_plate();
    plate.contacts = {Contact{.model = RigidStop{.restitution = 0.3}}};
    const Pulse plates{.levels = {110, 0, 110, 0}, .times = {90_us, 120_us, 200_us}, .edge = 1_us};
    all.push_back({"a plate released from a rigid contact and closed again", plate, {signal(plates), Signal()}, 250_us});
  }
  for (const double restitution : {0.0, 0.99}) {  // with more than 600 impacts, after which the plate rests
    Device plate = test::full_plate();
    plate.contacts = {Contact{.model = RigidStop{.restitution = restitution}}};
    all.push_back({fmt::format("a plate on a rigid contact with restitution {:g}", restitution),
                   plate,
                   {Signal::constant(150), Signal()},
                   2e-3});
  }
  for (const double viscosity : {1e-4, 1e-3, 1e-2}) {
    Device d = test::gold_cantilever();
    test::film(d).viscosity = viscosity;
    all.push_back(
        {fmt::format("a film of {:g} Pa s", viscosity), d, {Signal::constant(30)}, 200_us * std::max(1.0, viscosity / 1e-4)});
  }
  return all;
}

// Bounds of the difference between two runs of one case.
constexpr double close = 1e-4;    // t_i and v_i, relative
constexpr double apart = 2e-3;    // height of the first rebound: the motion before magnifies the difference
constexpr double twelfth = 4e-4;  // v_i with twelve modes, the highest of which oscillate at impact

TEST(HardCases, KeepTheInvariantsAndTheirLandingFromEveryIntegrator) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    const Switch device(one.device);
    const auto run = [&](Integrator integrator, double tolerance) {
      const CheckedRun c = checked_run(
          device, one.drives, {.duration = one.duration, .tolerance = tolerance, .integrator = integrator, .max_steps = 400'000});
      EXPECT_EQ(c.violations, std::vector<std::string>{});
      EXPECT_EQ(c.trajectory.status, one.ends.empty() ? Status::done : Status::collapsed_onto_electrode) << c.trajectory.message;
      EXPECT_NE(c.trajectory.message.find(one.ends), std::string::npos) << c.trajectory.message;
      return c;
    };
    const CheckedRun best = run(Integrator::lawson, 1e-10);
    const Landing expected = test::landing(best.trajectory);
    for (const Integrator integrator : {Integrator::lawson, Integrator::esdirk, Integrator::bdf}) {
      SCOPED_TRACE(static_cast<int>(integrator));
      const CheckedRun c = run(integrator, 1e-8);
      const Landing l = test::landing(c.trajectory);
      EXPECT_NEAR(l.time, expected.time, close * expected.time);
      EXPECT_NEAR(l.velocity, expected.velocity, (device.modes() > 8 ? twelfth : close) * expected.velocity);
      EXPECT_NEAR(l.rebound, expected.rebound, apart * expected.rebound);
      if (integrator == Integrator::lawson) {
        EXPECT_EQ(test::missed_touch(c.trajectory, best.trajectory), "");
      }
    }
  }
}

TEST(HardCases, AHairAboveOrBelowDynamicPullInABeamTouchesOrDoesNot) {
  const Switch device(test::gold_cantilever());  // with its gas: without it a beam may also touch after many periods
  const double pull_in = dynamic_pull_in(device, 0, static_pull_in(device, 0)).voltage;  // pull-in to 1e-7
  const auto run = [&](double volts, Integrator integrator) {
    const CheckedRun c = checked_run(device, std::vector<Signal>{Signal::constant(volts)},
                                     {.duration = 200_us, .tolerance = 1e-11, .integrator = integrator, .after_contact = 1_us});
    EXPECT_EQ(c.violations, std::vector<std::string>{});
    return test::landing(c.trajectory);
  };
  double before = 0;
  for (const double hair : {1e-3, 1e-4, 1e-5, 1e-6}) {
    SCOPED_TRACE(hair);
    EXPECT_EQ(run(pull_in * (1 - hair), Integrator::lawson).time, 0) << "touches nothing";
    const Landing one = run(pull_in * (1 + hair), Integrator::lawson);
    EXPECT_GT(one.time, before) << "the nearer, the slower";
    before = one.time;
    const Landing other = run(pull_in * (1 + hair), Integrator::esdirk);
    EXPECT_NEAR(other.time, one.time, close * one.time);
    EXPECT_NEAR(other.velocity, one.velocity, close * one.velocity);
  }
}

// Bounds at a tolerance, three times the largest errors of the runs below: of t_i, v_i and the first rebound, and of the
// energy.
struct Delivered {
  double tolerance = 0, error = 0, energy = 0;
};
constexpr Delivered delivered[] = {{1e-12, 3e-8, 3e-8}, {1e-10, 1e-6, 1.5e-6}, {1e-8, 5e-5, 5e-5},
                                   {1e-6, 5e-3, 2e-3},  {1e-4, 0.1, 0.07},     {1e-2, 0.2, 0.2}};

TEST(HardCases, AreEitherRightOrRefusedAtEveryTolerance) {
  const double soft = bending_stiffness(test::gold_cantilever());
  for (const Device& d :
       {gold_on_spring(1e10 * soft), gold_on_spring(1e9 * soft), test::gold_cantilever(), gold_on_spring(1e3 * soft)}) {
    const Switch device(d);
    const auto run = [&](Integrator integrator, double tolerance) {
      return checked_run(device, std::vector<Signal>{Signal::constant(step_level)},
                         {.duration = 70_us, .tolerance = tolerance, .integrator = integrator, .max_steps = 100'000},
                         0.2);  // largest energy error that a run accepts
    };
    const Landing best = test::landing(run(Integrator::lawson, 1e-12).trajectory);
    for (const Integrator integrator : {Integrator::lawson, Integrator::esdirk, Integrator::bdf}) {
      for (const auto& [tolerance, error, energy] : delivered) {
        SCOPED_TRACE(fmt::format("penetration {:g} m, integrator {}, tolerance {:g}", device.penetration_scale(),
                                 static_cast<int>(integrator), tolerance));
        const CheckedRun c = run(integrator, tolerance);
        EXPECT_EQ(c.violations, std::vector<std::string>{});
        const Landing l = test::landing(c.trajectory);
        if (c.trajectory.status != Status::done) {
          EXPECT_GE(tolerance, 1e-2) << c.trajectory.message;
          continue;
        }
        EXPECT_NEAR(l.time, best.time, error * best.time);
        EXPECT_NEAR(l.velocity, best.velocity, error * best.velocity);
        EXPECT_NEAR(l.rebound, best.rebound, error * best.rebound);
        EXPECT_LE(c.trajectory.energy_error, energy * device.bending_energy());
      }
    }
  }
}

// The rates of the stiff film have its error times its stiffness: their effect on the energy audit must not make a good run
// fail.
TEST(HardCases, ACompressibleFilmHasAnEnergyBalanceAtEveryTolerance) {
  Device d = test::gold_cantilever();
  d.gas = ReynoldsGas{.film = {.viscosity = 1.86e-5_Pa_s}};
  const Switch device(d);
  const auto run = [&](double tolerance) {
    const CheckedRun c =
        checked_run(device, std::vector<Signal>{Signal::constant(step_level)}, {.duration = 50_us, .tolerance = tolerance}, 0.2);
    EXPECT_EQ(c.violations, std::vector<std::string>{});
    return c;
  };
  const Landing best = test::landing(run(1e-7).trajectory);
  for (const auto& [tolerance, error, energy] : {Delivered{1e-6, 1e-4, 2e-3}, {1e-5, 1e-3, 1e-2}, {1e-4, 1e-2, 5e-2}}) {
    SCOPED_TRACE(tolerance);
    const CheckedRun c = run(tolerance);
    EXPECT_EQ(c.trajectory.status, Status::done) << c.trajectory.message;
    EXPECT_LE(c.trajectory.energy_error, energy * device.bending_energy());
    const Landing l = test::landing(c.trajectory);
    EXPECT_NEAR(l.time, best.time, error * best.time);
    EXPECT_NEAR(l.velocity, best.velocity, error * best.velocity);
  }
}

}  // namespace
}  // namespace softland
