// Tests the wear of a contact as figures of a run. Oracles: quadrature of the recorded course in small steps, and Hertz's law
// for one summit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "integrators/quintic.h"
#include "model/constants.h"
#include "studies/closing/certify.h"
#include "studies/closing/resistance_course.h"
#include "studies/closing/simulate.h"
#include "studies/devices/cycling.h"

namespace softland::wear_test {
namespace {

// A plate on gold asperities, which opens again at 60 us.
SceneFile plate(const std::string& rest = "") {
  return SceneFile::parse(R"(
structure = { kind = "plate", mass = "1e-10 kg", stiffness = "10 N/m", area = "1e-8 m^2", damping_ratio = 0.05 }
gap = { electrode = "4 um", contact = "3 um" }
electrode.main.fringing = "none"
waveform.main = { family = "table", times = ["0 s", "0.1 us", "60 us", "60.5 us"], voltages = ["0 V", "45 V", "45 V", "0 V"] }
simulate.duration = "150 us"
load = { voltage = "5 V", resistance = "50 ohm" }
)" + rest + R"(
[contact]
model = "asperity-uniform"
pad_length = "10 um"
pad_width = "10 um"
asperity_radius = "1 um"
asperity_density = "0.25 1/um^2"
asperity_height = "50 nm"
effective_modulus = "48 GPa"
damping = "0.5 s/m"
resistivity = "22 nohm m"
hardness = "1 GPa"
film_resistance = "5 ohm"
)",
                          "plate.toml");
}

// Returns the charge that flows under a force below the steady one between two times, by the midpoint rule on the recorded
// course.
double charge(const PreparedScene& p, const Closing& c, double from, double until) {
  const double light = p.scene.metrics.steady_force * c.metrics.hold_force;
  const Trajectory& run = c.trajectory;
  double sum = 0;
  for (std::size_t k = 0; k + 1 < run.points.size(); ++k) {
    const TrajectoryPoint &a = run.points[k], &b = run.points[k + 1];
    if (!(b.time > a.time) || a.time < from || b.time > until) continue;
    const Quintic motion(a.time, a.position, a.velocity, a.acceleration, b.time, b.position, b.velocity, b.acceleration);
    if (motion.position(0.5 * (a.time + b.time)) < run.contact_gap) continue;
    constexpr int parts = 200;
    std::vector<double> times;
    for (int i = 0; i < parts; ++i) times.push_back(std::lerp(a.time, b.time, (i + 0.5) / parts));
    const std::vector<double> resistance = resistance_course(p.scene.device, run, times);
    for (int i = 0; i < parts; ++i) {
      if (std::lerp(a.contact_force, b.contact_force, (i + 0.5) / parts) >= light) continue;
      const double whole = 50 + (std::isnan(resistance[i]) ? std::numeric_limits<double>::infinity() : resistance[i]);
      sum += 5 / whole * (b.time - a.time) / parts;
    }
  }
  return sum;
}

TEST(Wear, TransfersTheChargeOfTheKeptCourse) {
  const PreparedScene p = prepare(plate());
  const Closing c = simulate(p, true);
  ASSERT_TRUE(c.command) << to_string(c.metrics.status);
  ASSERT_GT(c.metrics.bounce_count, 0);
  const double made = charge(p, c, 0, c.command->time), broken = charge(p, c, c.command->time, p.duration);
  ASSERT_GT(made, 0);
  ASSERT_GT(broken, 0);
  EXPECT_NEAR(c.metrics.make_charge, made, 0.01 * made);
  EXPECT_NEAR(c.metrics.break_charge, broken, 0.01 * broken);
  EXPECT_TRUE(c.metrics.asked.charge && c.metrics.asked.break_charge);
}

// With a larger threshold of the force the contact is longer below it.
TEST(Wear, GrowsWithTheForceThatCountsAsLight) {
  const Closing few = simulate(prepare(plate("metrics.steady_force = \"5 %\"\n")), false);
  const Closing many = simulate(prepare(plate("metrics.steady_force = \"50 %\"\n")), false);
  EXPECT_GT(many.metrics.make_charge, 1.2 * few.metrics.make_charge);
}

// p = F / (pi a^2) at the highest summit, with F = 4/3 E* sqrt(R) d^1.5 and a^2 = R d.
TEST(Wear, HasThePressureOfTheHighestSummitByHertz) {
  const Closing c = simulate(prepare(plate()), true);
  const double d = c.trajectory.deepest_penetration, modulus = 48e9, radius = 1e-6;
  const double force = 4.0 / 3 * modulus * std::sqrt(radius) * std::pow(d, 1.5);
  ASSERT_GT(d, 0);
  EXPECT_NEAR(c.metrics.pressure, force / (pi * radius * d) / 1e9, 1e-12 * c.metrics.pressure);
  EXPECT_LE(c.errors[figure_of(&Metrics::pressure)], 1e-4 * c.metrics.pressure);
}

TEST(Wear, IsReportedOnlyForScenesThatRequestIt) {
  const Closing with = simulate(prepare(plate()), false);
  const PreparedScene p = prepare(SceneFile::parse(R"(
structure = { kind = "plate", mass = "1e-10 kg", stiffness = "10 N/m", area = "1e-8 m^2", damping_ratio = 0.05 }
gap = { electrode = "4 um", contact = "3 um" }
electrode.main.fringing = "none"
contact = { model = "linear", stiffness = "5 kN/m" }
waveform.main = { family = "step", level = "45 V" }
)",
                                                   "bare.toml"));
  const Closing without = simulate(p, false);
  EXPECT_TRUE(with.metrics.asked.pressure);
  EXPECT_FALSE(without.metrics.asked.pressure || without.metrics.asked.charge || without.metrics.asked.break_charge);
  EXPECT_TRUE(std::isnan(without.metrics.pressure) && std::isnan(without.metrics.make_charge));
}

// Every cycle has its own charges and pressure; the first cycle has those of a run of one cycle.
TEST(Wear, IsReportedForEveryCycle) {
  const PreparedScene p = prepare(plate());
  const CycleWaveforms ramps{.name = "ramps",
                             .closing = {Signal::piecewise_linear({{0, 0}, {1e-7, 45}})},
                             .opening = {Signal::piecewise_linear({{0, 45}, {5e-7, 0}}, 45)}};
  const Cycles found = CycledSwitch(p, p.model, ramps).run({.period = 150e-6, .on_time = 60e-6, .cycles = 2}, true);
  ASSERT_EQ(found.cycles.size(), 2u);
  const Closing alone = simulate(p, false);
  const Metrics& first = found.cycles.front().metrics;
  EXPECT_NEAR(first.make_charge, alone.metrics.make_charge, 0.01 * alone.metrics.make_charge);
  EXPECT_NEAR(first.break_charge, alone.metrics.break_charge, 0.01 * alone.metrics.break_charge);
  EXPECT_NEAR(first.pressure, alone.metrics.pressure, 1e-3 * alone.metrics.pressure);
  EXPECT_GT(found.cycles.back().metrics.make_charge, 0);
}

TEST(Wear, HasCertifiedErrors) {
  const Closing c = certify(prepare(plate()), {}, 2);
  for (const auto figure : {&Metrics::pressure, &Metrics::make_charge, &Metrics::break_charge})
    EXPECT_TRUE(std::isfinite(c.errors[figure_of(figure)])) << figure_of(figure).key;
}

}  // namespace
}  // namespace softland::wear_test
