// Drives, energies and the resting plate of a closing, separately.
#include "model/closing/energy_audit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/closing/resting_plate.h"
#include "model/constants.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

TEST(DriveCourse, GoesFromStretchToStretch) {
  const std::vector<Signal> signals{Signal::piecewise_linear({{0, 0}, {2e-6, 10}, {5e-6, 10}, {5e-6, 4}, {7e-6, 4}, {8e-6, 0}}),
                                    Signal::piecewise_linear({{0, 1}, {5e-6, 3}})};
  DriveCourse drives(signals);
  EXPECT_EQ(drives.stretches(7.5e-6), (std::vector{0.0, 2e-6, 5e-6, 7e-6, 7.5e-6}));
  EXPECT_EQ(drives.stretches(1e-6), (std::vector{0.0, 1e-6}));
  drives.enter(0, 2e-6), drives.enter(1, 2e-6);
  EXPECT_DOUBLE_EQ(drives.values(5e-6)[0], 10) << "the piece before the jump";
  EXPECT_FALSE(drives.at_hold());
  drives.enter(0, 5e-6), drives.enter(1, 5e-6);
  EXPECT_DOUBLE_EQ(drives.values(5e-6)[0], 4);
  EXPECT_DOUBLE_EQ(drives.values(6e-6)[1], 3);
  EXPECT_FALSE(drives.at_hold());
  drives.enter(0, 8e-6);
  EXPECT_TRUE(drives.at_hold());
  EXPECT_EQ(drives.resolving_step(0), std::numeric_limits<double>::infinity());
}

// A plate with one electrode, which is a parallel-plate capacitor.
struct Parts {
  explicit Parts(Device d, std::vector<Signal> s)
      : device(std::move(d)),
        signals(std::move(s)),
        model(device),
        drives(signals),
        phases(model),
        equations(model, drives, phases, true) {
    start.state.assign(2, 0);
    start.rates.assign(1, 0);
  }
  Device device;
  std::vector<Signal> signals;
  Switch model;
  DriveCourse drives;
  ContactPhases phases;
  ClosingEquations equations;
  Knot start;
};

TEST(EnergyAudit, ChargesACapacitorAtRest) {
  Parts p(test::nickel_plate(), {Signal::constant(20)});
  EnergyAudit audit(p.model, p.drives, p.phases, p.equations, p.start);
  audit.enter_stretch(p.start, true);
  audit.settle(p.start);
  const double capacitance = vacuum_permittivity * 510_um * 123_um / 3.49_um;
  EXPECT_NEAR(audit.balance().source_work, capacitance * 400 / 2, 1e-9 * capacitance * 400);
  EXPECT_NEAR(audit.balance().stored, audit.balance().source_work, 1e-12 * audit.balance().source_work);
  EXPECT_LT(audit.error(), 1e-12 * audit.balance().source_work);
}

TEST(EnergyAudit, BalancesAFreeSwingAndMissesWhatAStepLoses) {
  // Half a period of the plate on its springs, from an initial velocity, without a drive.
  Parts p(test::nickel_plate(), {Signal::constant(0)});
  EnergyAudit audit(p.model, p.drives, p.phases, p.equations, p.start);
  audit.enter_stretch(p.start, true);
  const double w = p.model.basis().angular_frequencies()[0];
  Knot moving = p.start;
  moving.state[1] = 1e-9 * w;
  audit.settle(moving);
  const double pushed = audit.error();
  EXPECT_NEAR(pushed, 1e-18 * w * w / 2, 1e-9 * pushed) << "nobody put this energy in";
  Knot later = moving;
  later.state = {1e-9 * std::sin(1.0), 1e-9 * w * std::cos(1.0)};
  audit.settle(later);
  EXPECT_NEAR(audit.balance().residual(), -pushed, 1e-9 * pushed) << "but none came since";
}

TEST(EnergyAudit, IntegratesTheDissipationOfADampedMode) {
  Device device = test::nickel_plate();
  device.structure.damping_ratio = 0.1;
  Parts p(device, {Signal::constant(0)});
  EnergyAudit audit(p.model, p.drives, p.phases, p.equations, p.start);
  audit.enter_stretch(p.start, true);
  const double w = p.model.basis().angular_frequencies()[0], zeta = 0.1, wd = w * std::sqrt(1 - zeta * zeta), v0 = 1e-9 * w;
  const auto at = [&](double t) {
    const double decay = v0 * std::exp(-zeta * w * t), q = decay / wd * std::sin(wd * t);
    const double v = decay * (std::cos(wd * t) - zeta * w / wd * std::sin(wd * t));
    return Knot{.time = t, .state = {q, v}, .rates = {-w * w * q - 2 * zeta * w * v}};
  };
  StepMotion motion(p.model, 1e-8);
  Knot here = at(0);
  const auto power = [&](const Knot& k) { return p.equations.dissipation(k.state.data()); };
  EXPECT_NEAR(power(here), 2 * zeta * w * v0 * v0, 1e-12 * power(here));
  audit.impact(0, power(here));
  constexpr int steps = 40;
  for (int i = 1; i <= steps; ++i) {
    const Knot next = at(i / w / steps);
    motion.set(here, next, {}, true);
    audit.step(here, next, power(next), motion, false);
    here = next;
  }
  audit.settle(here);
  const double lost = (v0 * v0 - here.state[1] * here.state[1] - w * w * here.state[0] * here.state[0]) / 2;
  EXPECT_NEAR(audit.balance().dissipated, lost, 1e-6 * lost);
}

// ---- on a rigid contact

Device on_stop(double restitution) {
  Device device = test::nickel_plate();
  device.contacts = {Contact{.model = RigidStop{.restitution = restitution}}};
  return device;
}

Knot arriving(const Switch& model, double speed) {
  const double shape = model.basis().contact_shape()[0];
  return {.time = 0, .state = {model.device().gap.contact * (1 + 1e-14) / shape, speed / shape}, .rates = {0}};
}

TEST(RestingPlate, ReboundsByTheRestitution) {
  Parts p(on_stop(0.5), {Signal::constant(60)});
  p.drives.enter(0, 0);
  RestingPlate plate(p.model, p.drives, p.equations);
  Knot here = arriving(p.model, 0.2);
  const RestingPlate::Impact impact = plate.strike(here);
  EXPECT_FALSE(impact.rests);
  EXPECT_NEAR(p.model.contact_deflection(here.state.data() + 1), -0.1, 1e-12);
  EXPECT_DOUBLE_EQ(p.model.contact_deflection(here.state.data()), p.device.gap.contact);
  EXPECT_NEAR(impact.energy, part_of<Plate>(p.device.structure).mass * 0.04 / 2, 1e-9 * impact.energy);
  EXPECT_NEAR(impact.lost, 0.75 * impact.energy, 1e-12 * impact.energy);
}

TEST(RestingPlate, RestsUntilItsSpringsOutweighTheDrive) {
  // A ramp down from 60 V: the plate leaves the plane when the forces of electrode and spring balance there.
  Parts p(on_stop(0.5), {Signal::piecewise_linear({{0, 60}, {1e-3, 0}})});
  p.drives.enter(0, 0);
  RestingPlate plate(p.model, p.drives, p.equations);
  Knot here = arriving(p.model, 1e-6);
  const RestingPlate::Impact impact = plate.strike(here);
  EXPECT_TRUE(impact.rests);
  EXPECT_EQ(here.state[1], 0);
  EXPECT_DOUBLE_EQ(impact.lost, impact.energy);
  p.equations.rates(here);
  plate.begin(here, 1e-3);
  const double h = 3.49_um - 3.14_um, area = 510_um * 123_um;
  const auto pull = [&](double volts) { return vacuum_permittivity * area * volts * volts / (2 * h * h); };
  const double spring = 91.303 * 3.14_um;
  EXPECT_NEAR(plate.force(), pull(60) - spring, 1e-6 * plate.force());
  RestingPlate::Stay stay;
  for (int i = 0; i < 1000 && !stay.leaves; ++i) {
    stay = plate.stay(here, 1e-3);
    EXPECT_GE(stay.until, here.time);
    here.time = stay.until;
  }
  const double leaves_at = std::sqrt(2 * h * h * spring / (vacuum_permittivity * area));
  ASSERT_TRUE(stay.leaves);
  EXPECT_NEAR(stay.until, 1e-3 * (1 - leaves_at / 60), 1e-9);
  EXPECT_EQ(plate.force(), 0) << "a stop does not pull";
}

}  // namespace
}  // namespace softland
