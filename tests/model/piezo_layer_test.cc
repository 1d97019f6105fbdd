// Oracle: a parallel-plate capacitor.
#include "model/piezo_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/literals.h"
#include "expect_refused.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/ensemble/ensemble_closings.h"
#include "objectives/metrics.h"
#include "tests/support/devices.h"
#include "waveforms/pulse.h"

namespace softland::piezo_layer_test {
namespace {

using namespace literals;

constexpr double relative_permittivity = 1500;

Device with_permittivity() {
  Device device = test::gold_pzt_cantilever();
  device.piezo->relative_permittivity = relative_permittivity;
  return device;
}

TEST(PiezoLayer, IsAParallelPlateCapacitor) {
  const Device device = with_permittivity();
  const double area =
      (device.piezo->end.on(device.structure.length) - device.piezo->begin.on(device.structure.length)) * device.structure.width;
  const double capacitance = vacuum_permittivity * relative_permittivity * area / device.piezo->thickness;
  EXPECT_DOUBLE_EQ(layer_capacitance(device), capacitance);
  const std::vector<Signal> drives{Signal::constant(5), Signal::constant(0.9)};
  EXPECT_DOUBLE_EQ(layer_charging_energy(device, drives, 1_us), capacitance * 0.9 * 0.9 / 2);
}

TEST(PiezoLayer, WithoutAPermittivityIsNotCounted) {
  const std::vector<Signal> drives{Signal::constant(5), Signal::constant(0.9)};
  EXPECT_TRUE(std::isnan(layer_capacitance(test::gold_pzt_cantilever())));
  EXPECT_EQ(layer_charging_energy(test::gold_pzt_cantilever(), drives, 1_us), 0);
  EXPECT_TRUE(std::isnan(layer_capacitance(test::gold_cantilever())));
  EXPECT_EQ(layer_charging_energy(test::gold_cantilever(), std::vector{Signal::constant(5)}, 1_us), 0);
}

TEST(PiezoLayer, AddsItsChargingToTheDriveEnergyAndNothingElse) {
  const std::vector<Signal> drives{Signal::constant(28),
                                   signal(Pulse{.levels = {0.2_V, -0.6_V, 0_V}, .times = {15_us, 40_us}, .edge = 5_us})};
  const Device plain = test::gold_pzt_cantilever(), counted = with_permittivity();
  const ClosingOptions options{.duration = 100_us, .tolerance = 1e-8};
  const Trajectory without = simulate_closing(Switch(plain), drives, options);
  const Trajectory with = simulate_closing(Switch(counted), drives, options);
  const double charging = layer_capacitance(counted) * (0.2 * 0.2 + 0.6 * 0.6) / 2;
  EXPECT_NEAR(with.layer_energy, charging, 1e-12 * charging);
  EXPECT_EQ(without.layer_energy, 0);
  EXPECT_EQ(with.energy.source_work, without.energy.source_work) << "the capacitor has no part in the motion";
  EXPECT_EQ(with.energy_error, without.energy_error);
  const Metrics of_with = metrics(with), of_without = metrics(without);
  EXPECT_NEAR(of_with.drive_energy, of_without.drive_energy + charging, 1e-12 * of_with.drive_energy);
  EXPECT_EQ(of_with.initial_contact_time, of_without.initial_contact_time);
}

TEST(PiezoLayer, IsRefusedBelowVacuum) {
  Device device = with_permittivity();
  device.piezo->relative_permittivity = 0.9;
  test::expect_refused([&] { validate(device); }, "piezo.relative_permittivity = 0.9: must be at least 1");
}

}  // namespace
}  // namespace softland::piezo_layer_test
