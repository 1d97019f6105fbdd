// Scenes that are prepared to run.
#include "studies/closing/prepared.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>

#include "model/closing.h"
#include "model/constants.h"
#include "scenes.h"

namespace softland {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Accuracy, TakesATenthForTheToleranceAndFourPointsADigit) {
  EXPECT_DOUBLE_EQ(tolerance_for(1e-6), 1e-7);
  EXPECT_DOUBLE_EQ(tolerance_for(0.5), 1e-3);
  EXPECT_DOUBLE_EQ(tolerance_for(1e-15), 1e-12);
  EXPECT_EQ(prepare(gold({"simulate.accuracy=1e-2"})).tolerance, 1e-3);
  EXPECT_EQ(prepare(gold({"simulate.accuracy=1e-2", "gas.model=reynolds"})).tolerance, 1e-4) << "a stiff film";
  EXPECT_DOUBLE_EQ(quadrature_for(1e-6, 4).points_per_length, 24);
  EXPECT_DOUBLE_EQ(quadrature_for(0.1, 1).points_per_length, 8);
  EXPECT_DOUBLE_EQ(quadrature_for(1e-3, 10).points_per_length, 24) << "two to a mode";
  EXPECT_LT(prepare(gold({"simulate.accuracy=1e-3"})).model.quadrature().points(),
            prepare(gold({"simulate.accuracy=1e-6"})).model.quadrature().points());
}

TEST(Prepare, ComputesPullInOnlyWhereAUnitNeedsIt) {
  EXPECT_THAT(prepare(gold({"waveform.main.level=30 V", "driver.main.max_voltage=90 V"})).pull_in, IsEmpty());
  const PreparedScene needed = prepare(gold());
  ASSERT_EQ(needed.pull_in.count("main"), 1U);
  const ElectrodePullIn& p = needed.pull_in.at("main");
  EXPECT_GT(p.dynamically.voltage, 0);
  EXPECT_LT(p.dynamically.voltage, p.statically.voltage);
  EXPECT_DOUBLE_EQ(needed.drives.at("main").hold_level(), 1.25 * p.dynamically.voltage);
  EXPECT_DOUBLE_EQ(needed.drives.at("main").limits.value().max_voltage, 1.5 * p.dynamically.voltage);
  EXPECT_DOUBLE_EQ(needed.voltage_units().at("main").dynamic_pull_in, p.dynamically.voltage);
}

TEST(Prepare, ComputesPullInForDefaultLimitsWhenAsked) {
  const SceneFile file = without(gold({"waveform.main.level=15 V"}), "driver.main");
  EXPECT_FALSE(prepare(file).drives.at("main").limits);
  const PreparedScene limited = prepare(file, true);
  EXPECT_DOUBLE_EQ(limited.drives.at("main").limits.value().min_voltage, 0);
  EXPECT_DOUBLE_EQ(limited.drives.at("main").limits.value().max_voltage, 1.5 * limited.pull_in.at("main").statically.voltage);
}

// The contact plane comes before the fold, and Vsp is 1.34 Vdp.
TEST(Prepare, TakesAStepAboveTheStaticPullInVoltageByDefault) {
  const SceneFile file = SceneFile::parse(R"(
structure = { kind = "cantilever", length = "75 um", width = "30 um", thickness = "5 um", youngs_modulus = "78 GPa", density = "19200 kg/m^3" }
gap = { electrode = "0.6 um", contact = "0.2 um" }
electrode.main = { span = ["30 um", "40 um"], fringing = "none" }
contact = { model = "linear", pad_length = "10 um", stiffness = "10 kN/m" }
waveform.main = { family = "step", level = "1.2 Vsp" }
)",
                                          "x.toml");
  const PreparedScene p = prepare(file);
  const ElectrodePullIn& own = p.pull_in.at("main");
  EXPECT_GT(1.2 * own.statically.voltage, 1.5 * own.dynamically.voltage);
  EXPECT_DOUBLE_EQ(p.drives.at("main").limits.value().max_voltage, 1.5 * own.statically.voltage);
}

// The switch has no open state under the piezo's bias, but the limits of the electrode belong to its source.
TEST(Prepare, LimitsInPullInVoltagesDoNotDependOnOtherDrives) {
  constexpr std::string_view closed =
      "waveform.piezo={family = \"table\", times = [\"0 s\", \"1 us\"], voltages = [\"0 V\", \"-1 V\"]}";
  const PreparedScene p = prepare(gold_pzt({closed, "waveform.main.level=17 V"}));
  const PreparedScene at_rest = prepare(gold_pzt({"waveform.main.level=17 V"}));
  EXPECT_DOUBLE_EQ(p.drives.at("main").limits.value().max_voltage, at_rest.drives.at("main").limits.value().max_voltage);
  EXPECT_THAT(p.pull_in, IsEmpty());
  EXPECT_THAT(p.scene.warnings,
              testing::Contains(testing::HasSubstr("with the other drives at 0 V: there are none, under piezo at -1 V")));
  EXPECT_NO_THROW(static_cast<void>(resolved(p.scene, p.voltage_units())));
  // A level in these units has no voltage.
  EXPECT_THAT(refusal([&] { (void)prepare(gold_pzt({closed})); }), testing::EndsWith("could be found, under piezo at -1 V"));
}

TEST(Prepare, OrdersSignalsAsTheSwitchDoesAndLeavesUndrivenDrivesAtZero) {
  const PreparedScene p = prepare(gold_pzt({"waveform.main.level=30 V", "driver.main.max_voltage=90 V"}));
  EXPECT_THAT(p.drive_names(), ElementsAre("main", "piezo"));
  const std::vector<Signal> signals = p.signals();
  ASSERT_EQ(signals.size(), p.model.drives());
  EXPECT_DOUBLE_EQ(signals[0].hold_level(), 30);
  EXPECT_TRUE(signals[1].is_zero());
}

TEST(Prepare, GivesEveryElectrodeItsOwnSignal) {
  const PreparedScene p = prepare(gold_pzt(
      {R"(electrode.main.span=["60 um", "150 um"])", R"(electrode.tip.span=["160 um", "240 um"])", "waveform.main.level=30 V",
       "driver.main.max_voltage=90 V", "waveform.piezo.family=step", "waveform.piezo.level=0.5 V"}));
  EXPECT_THAT(p.drive_names(), ElementsAre("main", "tip", "piezo"));
  const std::vector<Signal> signals = p.signals();
  ASSERT_EQ(signals.size(), 3U);
  EXPECT_DOUBLE_EQ(signals[0].hold_level(), 30);
  EXPECT_TRUE(signals[1].is_zero());
  EXPECT_DOUBLE_EQ(signals[2].hold_level(), 0.5);
}

TEST(Prepare, DrivesTheSwitchWithWhatItsSourceGives) {
  const SceneFile file = gold({"waveform.main.level=30 V", "driver.main.max_voltage=90 V", "driver.main.bandwidth=1 MHz"});
  const double tau = 1 / (2 * 3.14159265358979 * 1e6);
  EXPECT_NEAR(prepare(file).signals()[0].voltage(tau), 30 * (1 - std::exp(-1.0)), 1e-6);
  EXPECT_EQ(prepare(gold({"waveform.main.level=30 V", "driver.main.max_voltage=90 V"})).signals()[0].pieces(),
            Signal::constant(30).pieces());
}

// Just above pull-in a switch in a thick gas creeps for many periods: the default window contains its closing.
TEST(Prepare, WaitsForASlowClosingWhereNoOtherEndIsPossible) {
  SceneFile plate = without(spring_plate(), "contact");
  plate.set("gas={model=\"linear\", quality_factor=0.05}");
  plate.erase("simulate.duration");
  plate.set("waveform.main.level=1.005 Vsp");
  const PreparedScene p = prepare(plate);
  const Trajectory run = simulate_closing(p.model, p.signals(), {.duration = p.duration, .tolerance = p.tolerance});
  ASSERT_FALSE(run.touches.empty());
  const double period = 2 * pi / p.model.basis().angular_frequencies()[0];
  EXPECT_GT(run.touches.front().begin, 60 * period) << "longer than any step is waited for that need not close";
  EXPECT_GT(p.duration, 3.9 * run.touches.front().begin);
  plate.set("waveform.main.level=0.995 Vsp");
  EXPECT_LT(prepare(plate).duration, 7 * period) << "there it stays open";
}

TEST(Prepare, LoadsASourceWithTheCapacitanceOfTheOpenSwitch) {
  // The capacitance of two plates without fringing is eps A / d.
  const SceneFile file = gold({"waveform.main.level=30 V", "driver.main.max_voltage=90 V",
                               "driver.main.source_resistance=10 Mohm", "electrode.main.fringing=none"});
  const PreparedScene p = prepare(file);
  const Device& device = p.scene.device;
  const double area = (device.electrodes[0].end.value - device.electrodes[0].begin.value) * device.structure.width;
  const double capacitance = 8.8541878128e-12 * area / device.gap.electrode;
  EXPECT_NEAR(p.drives.at("main").source.load, capacitance, 1e-9 * capacitance);
  EXPECT_NEAR(p.signals()[0].voltage(10e6 * capacitance), 30 * (1 - std::exp(-1.0)), 1e-6);

  SceneFile with_cable = file;
  with_cable.set("driver.main.parallel_capacitance=0.2 pF");
  const PreparedScene cabled = prepare(with_cable);
  EXPECT_EQ(cabled.drives.at("main").source.load, p.drives.at("main").source.load);
  EXPECT_NEAR(cabled.signals()[0].voltage(10e6 * (capacitance + 0.2e-12)), 30 * (1 - std::exp(-1.0)), 1e-6);
}

TEST(Prepare, RefusesMoreSamplesThanARunCanFollow) {
  const std::string words = refusal([] {
    (void)prepare(gold({"waveform.main.level=30 V", "driver.main.max_voltage=90 V", "driver.main.sample_rate=1 GHz"}));
  });
  EXPECT_THAT(words, testing::StartsWith("--set driver.main.sample_rate=1 GHz: takes 600000 samples in the window of 600 us"));
  for (const char* way : {"at most 100000", "at most 166 MHz", "simulate.duration of at most 100 us", "or no sample_rate"})
    EXPECT_THAT(words, testing::HasSubstr(way));
}

// A bridge with a hold voltage of 30 V, and with 40 V, the limit of its driver.
TEST(Prepare, RefusesAFaceThroughWhichTheFieldPullsTheBeam) {
  const auto with = [](std::string_view landing, std::string_view limit) {
    SceneFile file = scene("new/capacitive-bridge.toml", {"waveform.main.level=30 V"});
    file.set(fmt::format("electrode.main.dielectric.landing={}", landing));
    if (!limit.empty()) file.set(fmt::format("driver.main.max_voltage={}", limit));
    return file;
  };
  const auto asperities = [](std::string_view density) {
    return fmt::format(
        "{{ model = \"asperity-uniform\", asperity_radius = \"100 nm\", asperity_density = \"{} 1/m^2\", "
        "asperity_height = \"40 nm\", effective_modulus = \"48 GPa\" }}",
        density);
  };
  // The beam collapses at 5/9 of the gap of the field if H is below 4/5 of the height of the summits.
  const double way = 0.2e-6 / 7 + 40e-9, sunk = way * 5 / 9;
  const double most = vacuum_permittivity * 30 * 30 / 2 / std::pow(way - sunk, 2);
  const double least = most / (8.0 / 15 * 48e9 * std::sqrt(100e-9) / 40e-9 * std::pow(sunk, 2.5));
  EXPECT_EQ(fmt::format("{:.3g}", least), "7.48e+10");
  EXPECT_THAT(refusal([&] { (void)prepare(with(asperities("1e10"), "")); }),
              testing::EndsWith("landing.asperity_density = \"1e10 1/m^2\": must be greater than 7.48e10 1/m^2, below which 30 V "
                                "pulls the beam through the face, its hold level"));
  EXPECT_EQ(refusal([&] { (void)prepare(with(asperities(fmt::format("{:.6e}", 1.0001 * least)), "")); }), "");
  EXPECT_THAT(refusal([&] { (void)prepare(with(asperities(fmt::format("{:.6e}", 1.7 * least)), "40 V")); }),
              HasSubstr("below which 40 V pulls the beam through the face, the limit of driver.main"));
  EXPECT_EQ(refusal([&] { (void)prepare(with(asperities(fmt::format("{:.6e}", 1.8 * least)), "40 V")); }), "");
  EXPECT_THAT(refusal([&] { (void)prepare(with("{ model = \"linear\", stiffness = \"1e12 Pa/m\" }", "")); }),
              HasSubstr("landing.stiffness = \"1e12 Pa/m\": must be greater than 1.15e15 Pa/m, below which 30 V pulls"));
}

TEST(Prepare, TakesWindowAndToleranceFromTheScene) {
  const PreparedScene p = prepare(gold({"simulate.accuracy=1e-4", "simulate.duration=123 us"}));
  EXPECT_DOUBLE_EQ(p.tolerance, 1e-5);
  EXPECT_DOUBLE_EQ(p.duration, 123e-6);
  EXPECT_DOUBLE_EQ(prepare(gold({"simulate.tolerance=3e-7"})).tolerance, 3e-7);
}

TEST(Prepare, ChoosesAWindowOfSixPeriodsWhereTheSceneHasNone) {
  const PreparedScene p = prepare(without(gold(), "simulate"));
  EXPECT_NEAR(p.duration * p.model.basis().angular_frequencies()[0], 6 * 2 * 3.14159265358979, 1e-9);
}

TEST(Prepare, ChoosesAWindowThatShowsASlowClosing) {
  SceneFile slow = without(gold({"gas.viscosity=1e-3 Pa s", "waveform.main.level=1.1 Vdp"}), "simulate");
  const PreparedScene p = prepare(slow);
  const Trajectory closing = simulate_closing(p.model, p.signals(), {.duration = p.duration, .tolerance = 1e-8});
  ASSERT_FALSE(closing.touches.empty());
  const double first = closing.touches.front().begin,
               six_periods = 6 * 2 * 3.14159265358979 / p.model.basis().angular_frequencies()[0];
  ASSERT_GT(first, six_periods) << "a closing that six periods would not show";
  EXPECT_NEAR(p.duration, 4 * first, 1e-3 * first);  // found at a tolerance of 1e-4
}

TEST(Prepare, RefusesWindowsAndWaveformsThatCannotBeComputed) {
  const auto with = [](const std::vector<std::string>& more) {
    SceneFile file = gold({R"(waveform.main={family="harmonic", base="15 V", amplitude="1 V", frequency="1 kHz"})"});
    for (const std::string& option : more) file.set(option);
    return file;
  };
  EXPECT_THAT(
      refusal([&] { (void)prepare(with({"waveform.main.frequency=1e15 Hz"})); }),
      testing::AllOf(testing::StartsWith("--set waveform.main.frequency=1e15 Hz: makes 6e11 periods in the window of 600 us"),
                     testing::HasSubstr("at most 100000")));
  EXPECT_THAT(refusal([&] { (void)prepare(with({"waveform.main.angular_frequency=1e15 rad/s"})); }),
              testing::StartsWith("--set waveform.main.angular_frequency=1e15 rad/s: makes "));
  for (const char* quick : {"waveform.main.frequency=100 MHz", "waveform.main.end=1 ns"})
    EXPECT_NO_THROW((void)prepare(with({quick})));
  EXPECT_NO_THROW((void)prepare(with({"waveform.main.frequency=1e15 Hz", "waveform.main.amplitude=0 V"})));
  SceneFile soft = gold({"waveform.main.level=1 V", "driver.main.max_voltage=9 V", "structure.youngs_modulus=1e-12 Pa"});
  soft.erase("simulate.duration");
  const std::string slow = refusal([&] { (void)prepare(soft); });
  EXPECT_THAT(slow,
              testing::HasSubstr("the window, where simulate.duration is absent six periods of the first mode or more, is "));
  EXPECT_THAT(slow, testing::HasSubstr(" and must be at most 1 ks"));
}

TEST(Prepare, NamesTheElectrodeWhosePullInCannotBeFound) {
  EXPECT_EQ(refusal([] { (void)prepare(gold({"electrode.main.span=[\"249.99999999 um\", \"250 um\"]"})); }),
            "--set electrode.main.span=[\"249.99999999 um\", \"250 um\"]: its pull-in voltage is needed for the unit Vsp or Vdp, "
            "but none could be found");
  // The bias of the piezo pulls the beam down to its contact, so that there is no open state.
  EXPECT_THAT(refusal([] {
                (void)prepare(gold_pzt({"waveform.piezo={family=\"step\",level=\"-5 V\"}", "driver.piezo.min_voltage=-9 V",
                                        "simulate.accuracy=1e-4"}));
              }),
              testing::EndsWith("but none could be found, under piezo at -5 V"));
}

}  // namespace
}  // namespace softland
