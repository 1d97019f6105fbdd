// Tests readings of instruments on devices, against the functions of the model, and their derivatives, against differences of
// separately built devices.
#include "studies/devices/instruments.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "model/constants.h"
#include "model/pull_in.h"
#include "model/static_slopes.h"
#include "scenes.h"
#include "studies/closing/auto_settings.h"

namespace softland::instruments_test {
namespace {

// Half width of the differences, and their error over the largest derivative by any quantity that varies by a factor.
constexpr double half_width = 1e-4, agreement = 2e-5;

PreparedScene prepared(SceneFile file, const std::vector<std::string>& keys) {
  std::string entries;
  for (const std::string& key : keys)
    entries += fmt::format(R"({}"{}"={{distribution="normal",cov="2 %"}})", entries.empty() ? "" : ",", key);
  file.set("spread={" + entries + "}");
  return prepare(file);
}

std::vector<double> nominal_values(const PreparedScene& p) {
  std::vector<double> values;
  for (const SpreadVariable& v : p.scene.spread.variables) values.push_back(v.nominal());
  return values;
}

Eigen::VectorXd read_at(DeviceReader& reader, const std::vector<double>& values, const Instrument& instrument) {
  EXPECT_TRUE(reader.move_to(values));
  return reader.read(instrument, false).values;
}

// Compares derivatives with Richardson's extrapolation from differences of two widths.
void expect_slopes(const PreparedScene& p, const Instrument& instrument, double within = agreement) {
  DeviceReader reader(p);
  std::vector<double> values = nominal_values(p);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] *= i % 2 == 0 ? 1.01 : 0.985;  // a device that is not the nominal one
  ASSERT_TRUE(reader.move_to(values));
  const DeviceReader::Reading reading = reader.read(instrument, true);
  ASSERT_TRUE(reading.values.allFinite()) << row_of(instrument.what).name;
  ASSERT_EQ(reading.slopes.cols(), static_cast<Eigen::Index>(values.size()));
  const double largest = reading.slopes.cwiseAbs().maxCoeff();
  ASSERT_GT(largest, 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto difference = [&](double width) {
      std::vector<double> above = values, below = values;
      above[i] += width, below[i] -= width;
      return Eigen::VectorXd((read_at(reader, above, instrument) - read_at(reader, below, instrument)) / (2 * width));
    };
    const Eigen::VectorXd expected = (4 * difference(half_width) - difference(2 * half_width)) / 3;
    for (Eigen::Index k = 0; k < expected.size(); ++k) {
      const double error = std::abs(reading.slopes(k, static_cast<Eigen::Index>(i)) - expected[k]);
      EXPECT_TRUE(error <= within * largest)
          << row_of(instrument.what).name << " by " << p.scene.spread.variables[i].name << ": "
          << reading.slopes(k, static_cast<Eigen::Index>(i)) << ", differences " << expected[k];
    }
  }
}

const std::vector<std::string> beam{"structure.length",  "structure.thickness", "structure.youngs_modulus",
                                    "structure.density", "gap.electrode",       "gap.contact"};
std::vector<std::string> with(std::vector<std::string> keys, std::initializer_list<const char*> more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}
constexpr auto at_rest = {Measurable::pull_in, Measurable::release};

TEST(Instruments, ReadTheFunctionsOfTheModel) {
  const PreparedScene p = prepared(gold(), {"structure.thickness"});
  DeviceReader reader(p);
  ASSERT_TRUE(reader.move_to({1}));
  const auto value = [&](const Instrument& instrument) { return reader.read(instrument, false).values[0]; };
  constexpr double rounding = 1e-9;  // a device that is built for these values may differ from the scene by rounding
  EXPECT_NEAR(value({.what = Measurable::pull_in}) / static_pull_in(p.model, 0).voltage, 1, rounding);
  EXPECT_NEAR(value({.what = Measurable::release}) / release_voltage(p.model, 0), 1, rounding);
  EXPECT_NEAR(value({.what = Measurable::frequency, .mode = 1}) / (p.model.basis().angular_frequencies()[1] / (2 * pi)), 1,
              rounding);
  const Eigen::VectorXd straight = Eigen::VectorXd::Zero(4);
  Switch::Workspace work = p.model.workspace();
  EXPECT_NEAR(value({.what = Measurable::capacitance}) / p.model.capacitance(0, straight.data(), work), 1, rounding);
  constexpr double looser = 1e-4;  // closing_time() has the looser tolerance of ensembles
  EXPECT_NEAR(value({.what = Measurable::closing_time, .level = 18}) / closing_time(p.model, 0, 18, std::vector<double>{0}, 1e-3),
              1, looser);
}
TEST(Instruments, SeeTheResonanceSoftenAndTheCapacitanceGrowWithTheVoltage) {
  const PreparedScene p = prepared(gold(), {"structure.thickness"});
  DeviceReader reader(p);
  ASSERT_TRUE(reader.move_to({1}));
  const auto value = [&](Measurable what, double level) { return reader.read({.what = what, .level = level}, false).values[0]; };
  EXPECT_LT(value(Measurable::frequency, 10), value(Measurable::frequency, 0));
  EXPECT_GT(value(Measurable::capacitance, 10), value(Measurable::capacitance, 0));
  EXPECT_TRUE(std::isnan(value(Measurable::capacitance, 40))) << "it does not rest open there";
}
TEST(Instruments, DivideVoltagesByTheGainOfTheSource) {
  const PreparedScene p = prepared(gold({"driver.main.offset=0.2 V"}), {"driver.main.gain"});
  DeviceReader reader(p);
  const double bare = static_pull_in(p.model, 0).voltage;
  EXPECT_NEAR(read_at(reader, {1.05}, {.what = Measurable::pull_in})[0], (bare - 0.2) / 1.05, 1e-9 * bare);
}
TEST(Instruments, HaveExactSlopesOfStaticVoltages) {
  for (const Measurable what : at_rest) {
    expect_slopes(prepared(gold({"structure.modes=2"}), with(beam, {"contact.effective_modulus", "driver.main.gain"})),
                  {.what = what});
    expect_slopes(prepared(spring_plate(), {"structure.stiffness", "structure.area", "gap.electrode", "gap.contact"}),
                  {.what = what});
  }
}
TEST(Instruments, HaveExactSlopesOfResonancesAndCapacitances) {
  const PreparedScene p =
      prepared(gold({"structure.modes=2", "driver.main.offset=0.1 V"}), with(beam, {"driver.main.gain", "driver.main.offset"}));
  for (const double level : {0.0, 12.0}) {
    expect_slopes(p, {.what = Measurable::frequency, .level = level});
    expect_slopes(p, {.what = Measurable::frequency, .level = level, .mode = 1});
    expect_slopes(p, {.what = Measurable::capacitance, .level = level});
  }
}
TEST(Instruments, HaveExactSlopesOfClosingTimes) {
  const PreparedScene p = prepared(gold({"structure.modes=2", "driver.main.delay=1 us"}),
                                   with(beam, {"gas.viscosity", "driver.main.gain", "driver.main.delay"}));
  expect_slopes(p, {.what = Measurable::closing_time, .level = 20});
  expect_slopes(p, {.what = Measurable::closing_time, .waveforms = p.waveforms()});
}
TEST(Instruments, HaveSlopesOfMotionsAndContactRecords) {
  const PreparedScene p = prepared(gold({"structure.modes=2"}), {"structure.thickness", "gap.electrode", "driver.main.gain"});
  constexpr double of_differences = 1e-3;  // error of differences of closings, with a hundredth of the width
  expect_slopes(p, {.what = Measurable::position, .level = 20, .times = {5e-6, 12e-6, 20e-6}}, of_differences);
  expect_slopes(p, {.what = Measurable::velocity, .level = 20, .times = {5e-6, 12e-6, 20e-6}}, of_differences);
  expect_slopes(p, {.what = Measurable::contact, .level = 20, .edges = 3}, of_differences);
}
TEST(Instruments, HaveExactSlopesOnEveryKindOfSwitch) {
  const std::vector<std::string> gaps{"gap.electrode", "gap.contact"};
  expect_slopes(prepared(scene("hung-senturia.toml"), {"structure.thickness", "structure.residual_stress", "gap.electrode"}),
                {.what = Measurable::pull_in});
  for (const Measurable what : at_rest) {
    expect_slopes(prepared(scene("mem-gold-pzt.toml", {"structure.modes=2"}), with(beam, {"piezo.thickness"})), {.what = what});
    expect_slopes(prepared(scene("gap-closing-actuator.toml"), with(gaps, {"structure.stiffness"})), {.what = what});
    expect_slopes(prepared(scene("nem-tin.toml", {"structure.modes=2"}), with(gaps, {"structure.thickness"})), {.what = what});
  }
}

// A charge on the dielectric acts at all voltages, including 0 V.
TEST(Instruments, HaveTheSlopesOfACharge) {
  const SceneFile bare = gold({"structure.modes=2", R"(electrode.main.dielectric={thickness="0.2 um",permittivity=7.6})"});
  const auto charged = [&](const char* charge, const char* contact_gap) {
    SceneFile file = bare;
    file.set(fmt::format("electrode.main.dielectric.charge={}", charge));
    file.set(fmt::format("gap.contact={}", contact_gap));
    return prepared(std::move(file), {"electrode.main.dielectric.charge", "electrode.main.dielectric.thickness",
                                      "structure.thickness", "driver.main.gain"});
  };
  const PreparedScene p = charged("-1 mC/m^2", "2 um"), stuck = charged("4 mC/m^2", "3.2 um");
  for (const Measurable what : at_rest) expect_slopes(p, {.what = what});
  // At 0 V the charge softens the beam as the shifted voltage would without a charge.
  const double at_0 = resonance(p.model, 0, std::vector<double>{0}), neutral = p.model.neutral_voltage(0);
  EXPECT_NEAR(at_0 / resonance(prepare(bare).model, 0, std::vector<double>{-neutral}), 1, 1e-9);
  EXPECT_LT(at_0, 0.999 * p.model.basis().angular_frequencies()[0]);
  ASSERT_LT(release_voltage(stuck.model, 0), 0);
  for (const Measurable what : at_rest) expect_slopes(stuck, {.what = what});
  for (const double level : {0.0, 8.0}) {
    expect_slopes(p, {.what = Measurable::frequency, .level = level});
    expect_slopes(p, {.what = Measurable::capacitance, .level = level});
  }
  expect_slopes(p, {.what = Measurable::closing_time, .level = 22});
  expect_slopes(p, {.what = Measurable::position, .level = 22, .times = {5e-6, 12e-6, 20e-6}}, 100 * agreement);
}

}  // namespace
}  // namespace softland::instruments_test
