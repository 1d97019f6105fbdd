// Tests the bias of the other drives while a pull-in voltage is computed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "biased.h"
#include "model/pull_in.h"
#include "scenes.h"
#include "studies/closing/certify.h"
#include "studies/closing/prepared.h"
#include "studies/closing/simulate.h"
#include "studies/devices/ensemble.h"
#include "studies/exploration/pull_in_memory.h"

namespace softland::bias_test {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;

double static_of(const SceneFile& file) { return prepare(file).pull_in.at("main").statically.voltage; }
double dynamic_of(const SceneFile& file) { return prepare(file).pull_in.at("main").dynamically.voltage; }

TEST(Standing, IsTheHoldLevelWhereThatIsGivenInVolts) {
  const auto standing = [](std::initializer_list<std::string_view> changes) { return read_scene(small_beam(changes)).standing; };
  EXPECT_THAT(standing({}), ElementsAre(0, 0)) << "in Vdp, and no waveform";
  EXPECT_THAT(standing({"waveform.main.level=20 V"}), ElementsAre(20, 0));
  const std::string_view pulse = R"(waveform.piezo={family="pulse", levels=["1 V", "-2 V"], times=["3 us"], edge="1 us"})";
  EXPECT_THAT(standing({pulse}), ElementsAre(0, -2)) << "the final value";
  EXPECT_THAT(standing({R"(waveform.main={family="pulse", levels=["1.4 Vdp", "12 V"], times=["3 us"], edge="1 us"})"}),
              ElementsAre(12, 0));
  EXPECT_THAT(standing({R"(waveform.main={family="pulse", levels=["12 V", "1.1 Vsp"], times=["3 us"], edge="1 us"})"}),
              ElementsAre(0, 0));
}

TEST(Standing, IsEmptyForEveryShippedScene) {
  for (const std::string& name : shipped_scenes()) {
    const Scene read = read_scene(scene(name.c_str()));
    for (std::size_t k = 0; k < read.device.electrodes.size(); ++k)
      EXPECT_THAT(bias_of(read, k), Each(0.0)) << name << ", electrode " << read.device.electrodes[k].name;
  }
}

TEST(Bias, OfNothingGivesTheBitsOfNoBias) {
  for (const std::string& name : shipped_scenes()) {
    const Switch model(read_scene(scene(name.c_str())).device);
    const std::vector<double> none(model.drives(), 0.0);
    for (std::size_t k = 0; k < model.device().electrodes.size(); ++k) {
      const StaticPullIn with = static_pull_in(model, k, none), without = static_pull_in(model, k);
      EXPECT_EQ(with.status, without.status) << name;
      EXPECT_TRUE(with.voltage == without.voltage || std::isnan(without.voltage)) << name;
    }
  }
}

TEST(Bias, OfAnElectrodeAddsItsForceToAPlates) {
  // Both electrodes pull on the plate in the same way: A_1 V_1^2 + A_2 V_2^2 decides pull-in.
  const double alone = static_of(two_area_plate());
  const double closed_form = std::sqrt(8 * 40.0 * std::pow(3e-6, 3) / (27 * 8.8541878128e-12 * 0.6e-8));
  EXPECT_NEAR(alone, closed_form, 1e-8 * closed_form);
  for (const double bias : {10.0, 30.0, 50.0}) {
    const SceneFile file = two_area_plate({fmt::format(R"(waveform.bias={{family="step", level="{} V"}})", bias)});
    const double expected = std::sqrt(alone * alone - 0.4 / 0.6 * bias * bias);
    EXPECT_NEAR(static_of(file), expected, 1e-7 * expected) << bias;
  }
}

TEST(Bias, OfAnElectrodeInPullInVoltagesDoesNotCount) {
  const SceneFile file = two_area_plate({R"(waveform.bias={family="step", level="0.5 Vdp"})"});
  EXPECT_EQ(static_of(file), static_of(two_area_plate()));
}

TEST(Bias, OfAPiezoMovesTheVoltagesOneWay) {
  double last_static = 0, last_dynamic = 0, last_release = 0;
  for (const double volts : {-2.0, -1.0, 0.0, 1.0, 2.0}) {  // d31 < 0: a positive voltage lifts the tip
    const PreparedScene p = prepare(small_beam({fmt::format(R"(waveform.piezo={{family="step", level="{} V"}})", volts)}));
    const ElectrodePullIn& found = p.pull_in.at("main");
    const double release = release_voltage(p.model, 0, bias_of(p.scene, 0));
    EXPECT_GT(found.statically.voltage, last_static) << volts;
    EXPECT_GT(found.dynamically.voltage, last_dynamic) << volts;
    EXPECT_GT(release, last_release) << volts;
    last_static = found.statically.voltage, last_dynamic = found.dynamically.voltage, last_release = release;
  }
}

// Dynamic pull-in voltage by bisection of whole runs, with the piezo at its bias at all times.
TEST(Bias, OfAPiezoGivesTheDynamicPullInOfSimulatedSteps_long) {
  for (const char* volts : {"-1.5 V", "1.5 V"}) {
    const SceneFile biased = small_beam({fmt::format(R"(waveform.piezo={{family="step", level="{}"}})", volts)});
    const double found = dynamic_of(biased);
    SceneFile file = biased;
    file.set(fmt::format("waveform.piezo.before={}", volts));
    const Switch& model = prepare(biased).model;
    file.assign("simulate.duration", 100 * 2 * std::numbers::pi / model.basis().angular_frequencies()[0]);
    const auto closes = [&](double main) {
      file.assign("waveform.main.level", Quantity{.value = main, .dimension = dimension::voltage});
      return !simulate(prepare(file), false).trajectory.touches.empty();
    };
    double low = 0.9 * found, high = 1.1 * found;
    ASSERT_FALSE(closes(low));
    ASSERT_TRUE(closes(high));
    constexpr double precision = 1e-5;
    while (high - low > precision * found) {
      const double middle = (low + high) / 2;
      (closes(middle) ? high : low) = middle;
    }
    EXPECT_NEAR(found, high, 2 * precision * found) << volts;
  }
}

TEST(Bias, ThatClosesTheSwitchLeavesNoPullInVoltage) {
  const Switch model(read_scene(two_area_plate()).device);
  const std::vector<double> bias{0, 500};
  EXPECT_EQ(static_pull_in(model, 0, bias).status, Status::collapsed_at_rest);
  EXPECT_THROW((void)static_pull_in(model, 0, std::vector<double>{0, 0, 0}), InvalidInput);
}

TEST(Bias, CountsForDevicesMeasuredByIt) {
  const SceneFile file = small_beam(
      {R"(waveform.piezo={family="step", level="-1.5 V"})", R"(spread."piezo.d31"={distribution="normal", cov="10 %"})"});
  const PreparedScene p = prepare(file);
  const PullInMeter meter(p, {.pull_in = true});
  EXPECT_NEAR(meter.pull_in(), p.pull_in.at("main").dynamically.voltage, 1e-6 * meter.pull_in());
  // A stronger piezo layer lowers the pull-in voltage only if it is biased.
  Device stronger = p.scene.device;
  stronger.piezo->d31 *= 1.2;
  EXPECT_LT(meter.exact(Switch(stronger, p.quadrature)).volts, 0.999);
}

TEST(Bias, IsPartOfTheKeyOfRememberedVoltages) {
  PullInMemory memory;
  const auto voltage = [&](const SceneFile& file) {
    return prepare(file, false, {}, memory.finder(file)).pull_in.at("main").statically.voltage;
  };
  const SceneFile lifted = small_beam({R"(waveform.piezo={family="step", level="1 V"})"});
  EXPECT_EQ(voltage(small_beam()), static_of(small_beam()));
  EXPECT_EQ(voltage(lifted), static_of(lifted));
  EXPECT_GT(voltage(lifted), voltage(small_beam()));
}

TEST(Bias, IsThatOfTheErrorsOfACertifiedRun_long) {
  const Closing c =
      certify(prepare(small_beam({R"(waveform.piezo={family="step", level="-1.5 V"})", "simulate.accuracy=1e-5"})), {}, 1);
  ASSERT_TRUE(std::isfinite(c.errors[&Metrics::initial_contact_time]));
  EXPECT_LT(c.errors[&Metrics::initial_contact_time], 1e-3 * c.metrics.initial_contact_time);
}

}  // namespace
}  // namespace softland::bias_test
