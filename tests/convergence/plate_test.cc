// The rigid plate on springs, against exact results: pull-in in closed form, switching times as quadratures.
//
// The units are the gap g and sqrt(m / k), and lambda = eps0 A V^2 / (2 k g^3):  x'' + x' / Q + x = lambda / (1 - x)^2.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/forces/casimir.h"
#include "model/forces/van_der_waals.h"
#include "model/pull_in.h"

namespace softland {
namespace {

using namespace literals;

constexpr double plate_gap = 3_um, plate_side = 100_um;

Device plate(double contact_over_gap, double damping_ratio = 0) {
  return {.structure = {.length = plate_side,
                        .width = plate_side,
                        .damping_ratio = damping_ratio,
                        .kind = Plate{.mass = 2e-9, .stiffness = 50}},
          .gap = {.electrode = plate_gap, .contact = contact_over_gap * plate_gap},
          .electrodes = {{.name = "whole", .begin = 0, .end = plate_side, .fringing = Fringing::none}}};
}

/// Returns sqrt(8 k g^3 / (27 eps0 A)).
double static_voltage(const Device& d) {
  return std::sqrt(8 * part_of<Plate>(d.structure).stiffness * std::pow(plate_gap, 3) /
                   (27 * vacuum_permittivity * plate_side * plate_side));
}

TEST(Plate, PullsInAtAThirdOfTheGap) {
  constexpr double voltage_digits = 1e-9, deflection_digits = 1e-6;  // relative; the fold is flat
  const Device d = plate(0.9);
  const StaticPullIn found = static_pull_in(Switch(d), 0);
  ASSERT_EQ(found.status, Status::done);
  EXPECT_EQ(found.kind, StaticKind::fold);
  EXPECT_NEAR(found.voltage, static_voltage(d), voltage_digits * found.voltage);
  EXPECT_NEAR(found.deflection, plate_gap / 3, deflection_digits * plate_gap);
}

TEST(Plate, TheContactComesFirstBeforeAThirdOfTheGap) {
  const Device d = plate(0.25);
  const StaticPullIn found = static_pull_in(Switch(d), 0);
  EXPECT_EQ(found.kind, StaticKind::contact);
  // lambda = x (1 - x)^2 at this deflection, 4/27 at the fold.
  EXPECT_NEAR(found.voltage, static_voltage(d) * std::sqrt(0.25 * 0.5625 * 27 / 4), 1e-9 * found.voltage);
}

TEST(Plate, DispersionForcesCollapseItAtAFifthAndAQuarterOfTheGap) {
  constexpr double factor_digits = 1e-9, deflection_digits = 1e-6;  // relative; the fold is flat
  Device d = plate(0.9);
  d.electrodes.clear();
  const double spring = part_of<Plate>(d.structure).stiffness * plate_gap, area = plate_side * plate_side;
  d.dispersion = Dispersion{.model = DispersionModel::casimir};
  const StaticPullIn retarded = static_pull_in(Switch(d), 0);
  const double casimir = IdealCasimir{}.pressure(plate_gap) * area / spring;  // force at factor 1
  EXPECT_NEAR((1 + retarded.voltage) * casimir, 256.0 / 3125, factor_digits);
  EXPECT_NEAR(retarded.deflection, plate_gap / 5, deflection_digits * plate_gap);
  d.dispersion = Dispersion{.model = DispersionModel::van_der_waals, .hamaker_constant = 4e-19};
  const StaticPullIn near = static_pull_in(Switch(d), 0);
  const double van_der_waals = VanDerWaals{.hamaker_constant = 4e-19}.pressure(plate_gap) * area / spring;
  EXPECT_NEAR((1 + near.voltage) * van_der_waals, 27.0 / 256, factor_digits);
  EXPECT_NEAR(near.deflection, plate_gap / 4, deflection_digits * plate_gap);
}

TEST(Plate, AnUndampedStepPullsInAtTheRootOf27Over32) {
  constexpr double bisected = 2e-7;  // relative, as dynamic_pull_in states
  const Device d = plate(0.9);
  const Switch model(d);
  const DynamicPullIn found = dynamic_pull_in(model, 0, static_pull_in(model, 0));
  ASSERT_EQ(found.status, Status::done);
  EXPECT_NEAR(found.voltage / static_voltage(d), std::sqrt(27.0 / 32), bisected);
}

TEST(Plate, DampingRaisesTheVoltageOfAStepToTheStaticOne) {
  constexpr double printed = 1.1e-5;  // five decimals
  struct Row {
    double quality, over_static;
  };
  for (const auto& [quality, over_static] : {Row{0.5, 1}, Row{1, 1}, Row{2, 0.98814}, Row{3, 0.97151}, Row{5, 0.95341},
                                             Row{10, 0.93713}, Row{50, 0.92246}, Row{1000, 0.91876}}) {
    const Device d = plate(0.9, 1 / (2 * quality));
    const Switch model(d);
    const DynamicPullIn found = dynamic_pull_in(model, 0, static_pull_in(model, 0));
    ASSERT_EQ(found.status, Status::done) << quality;
    EXPECT_NEAR(found.voltage / static_voltage(d), over_static, printed) << "Q = " << quality;
  }
}

TEST(Plate, ClosesInTheTimeOfItsQuadratureWithTheSpeedOfItsEnergy) {
  // Time: integral of dx / sqrt(2 lambda x / (1 - x) - x^2). Speed: the square root.
  constexpr double digits = 1e-6;  // relative
  struct Row {
    double over_static, time_two_thirds, speed_two_thirds, speed_nine_tenths;
  };
  constexpr std::array<Row, 7> reference{{{0.92, 8.002533, 0.239010, 1.202941},
                                          {1.00, 3.950070, 0.384900, 1.362596},
                                          {1.05, 3.462331, 0.457044, 1.459452},
                                          {1.20, 2.681355, 0.639444, 1.740690},
                                          {1.30, 2.371953, 0.746349, 1.922672},
                                          {1.50, 1.953956, 0.942809, 2.278157},
                                          {3.00, 0.894799, 2.211083, 4.815600}}};
  constexpr double printed = 2e-6;  // absolute: six decimals, of which times carry 1e-6 relative
  for (const Row& row : reference) {
    const auto touch = [&](double contact_over_gap) {
      const Switch model(plate(contact_over_gap));
      const std::vector<Signal> drives{Signal::constant(row.over_static * static_voltage(model.device()))};
      const double frequency = model.basis().angular_frequencies()[0];
      const Trajectory t = simulate_closing(model, drives, {.duration = 10 / frequency, .tolerance = 1e-11});
      EXPECT_EQ(t.touches.size(), 1u);
      return Touch{.begin = t.touches.at(0).begin * frequency,
                   .impact_velocity = t.touches.at(0).impact_velocity / (plate_gap * frequency)};
    };
    const Touch at_two_thirds = touch(2.0 / 3), at_nine_tenths = touch(0.9);
    EXPECT_NEAR(at_two_thirds.begin, row.time_two_thirds, printed + digits * row.time_two_thirds) << row.over_static;
    EXPECT_NEAR(at_two_thirds.impact_velocity, row.speed_two_thirds, printed) << row.over_static;
    EXPECT_NEAR(at_nine_tenths.impact_velocity, row.speed_nine_tenths, printed) << row.over_static;
  }
}

TEST(Plate, HeavilyDampedLingersAtTheGhostOfTheFold) {
  // Without inertia, x' k/c = -x + lambda / (1 - x)^2 with lambda = 4/27 (1 + eps); T k/c approaches 2 pi / sqrt(3 eps).
  constexpr double inertia = 2e-4;  // relative; effect of inertia at a damping ratio of 100, and of the last 2 % of the gap
  constexpr double damping_ratio = 100;
  struct Row {
    double excess, time;
  };
  for (const auto& [excess, time] :
       {Row{1e-4, 360.300}, Row{1e-3, 112.2597}, Row{0.01, 33.8409}, Row{0.1, 9.13712}, Row{1, 1.77676}}) {
    const Switch model(plate(0.98, damping_ratio));
    const double unit = 2 * damping_ratio / model.basis().angular_frequencies()[0];  // c / k
    const std::vector<Signal> drives{Signal::constant(std::sqrt(1 + excess) * static_voltage(model.device()))};
    const Trajectory t =
        simulate_closing(model, drives, {.duration = 2 * time * unit, .tolerance = 1e-8, .integrator = Integrator::bdf});
    ASSERT_EQ(t.touches.size(), 1u) << excess << " " << t.message;
    EXPECT_NEAR(t.touches[0].begin / unit, time, inertia * time) << "eps = " << excess;
  }
}

TEST(Plate, AnElectrodeCountsByItsArea) {
  Device d = plate(0.9);
  d.electrodes[0].end = plate_side / 4;
  EXPECT_NEAR(static_pull_in(Switch(d), 0).voltage, 2 * static_voltage(d), 1e-9 * static_voltage(d));
}

}  // namespace
}  // namespace softland
