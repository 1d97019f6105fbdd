// Tests the criterion of a robust search: how it is read, and the reasons for which it is refused.
#include "config/condition.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "base/require.h"
#include "config/scene.h"

namespace softland::criterion_test {
namespace {

constexpr std::array figures{figure_of(&Metrics::initial_contact_time), figure_of(&Metrics::impact_velocity),
                             figure_of(&Metrics::bounce_count)};

template <class Read>
std::string refusal(Read&& read) {
  try {
    static_cast<void>(read());
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return {};
}

std::string refused(std::string_view text) {
  return refusal([&] { return parse_condition(text, figures); });
}
std::string refused_measure(std::string_view text) {
  return refusal([&] { return parse_robust_measure(text, figures); });
}

TEST(Condition, IsAFigureASignAndAValue) {
  const Condition time = parse_condition("initial_contact_time < 60 us", figures);
  EXPECT_EQ(time.figure.key, "initial_contact_time_s");
  EXPECT_EQ(time.comparison, Comparison::below);
  EXPECT_EQ(time.limit, 60e-6);
  EXPECT_EQ(time.text, "initial_contact_time < 60 us");
  EXPECT_EQ(parse_condition("v_i>=4 mm/s", figures).limit, 4e-3) << "by its symbol, without blanks";
  EXPECT_EQ(parse_condition("impact_velocity_m_s <= 1 m/s", figures).figure.key, "impact_velocity_m_s") << "by its key";
  EXPECT_EQ(parse_condition(" \"bounce_count == 0\" ", figures).comparison, Comparison::equal) << "quoted twice by a script";
  EXPECT_EQ(parse_condition("N_B = 0", figures).comparison, Comparison::equal);
}

TEST(Condition, HoldsWhereItsViolationSaysSo) {
  const auto of = [](std::string_view text) { return parse_condition(text, figures); };
  EXPECT_DOUBLE_EQ(of("t_i < 50 us").violation(60e-6), 0.2);
  EXPECT_TRUE(of("t_i < 50 us").holds(49e-6));
  EXPECT_FALSE(of("t_i < 50 us").holds(50e-6));
  EXPECT_TRUE(of("t_i <= 50 us").holds(50e-6));
  EXPECT_TRUE(of("v_i > 1 m/s").holds(2));
  EXPECT_FALSE(of("v_i > 1 m/s").holds(1));
  EXPECT_TRUE(of("v_i >= 1 m/s").holds(1));
  EXPECT_TRUE(of("N_B == 0").holds(0));
  EXPECT_FALSE(of("N_B == 0").holds(2));
  EXPECT_EQ(of("N_B == 0").violation(2), 2);
  for (const char* any : {"t_i < 1 s", "v_i > 0.1 m/s", "N_B >= 0", "N_B == 0"})
    EXPECT_FALSE(of(any).holds(std::numeric_limits<double>::infinity())) << any << ": a switch that failed fulfils nothing";
}

TEST(Condition, IsRefusedWithTheReason) {
  EXPECT_EQ(refused("fast"), "'fast' must be a condition: a figure, then <, <=, ==, >= or >, then a value");
  EXPECT_EQ(refused("bounce_cuont == 0"), "unknown figure of merit 'bounce_cuont' (did you mean 'bounce_count'?)");
  EXPECT_EQ(refused("t_i < 60 V"), "initial_contact_time in 't_i < 60 V' must be a time [s]");
  EXPECT_EQ(refused("t_i < 60"), "no unit (expected a time such as \"20 us\") in 't_i < 60'");
  EXPECT_EQ(refused("N_B == 0 us"), "bounce_count in 'N_B == 0 us' must be a plain number");
  EXPECT_EQ(refused("t_i <= 0 us"),
            "the limit of initial_contact_time in 't_i <= 0 us' must not be 0: give a small value with its unit");
  EXPECT_NE(refused("t_i < "), "");
  EXPECT_NE(refused("< 3 us"), "");
  EXPECT_NE(refused(""), "");
}

TEST(RobustMeasure, HasANameAndALevel) {
  EXPECT_EQ(parse_robust_measure("cvar:0.95", figures).risk.parameter, 0.95);
  EXPECT_EQ(parse_robust_measure("cvar", figures).risk.parameter, 0.9);
  EXPECT_EQ(parse_robust_measure("quantile:0.99", figures).risk.kind, RiskKind::quantile);
  EXPECT_EQ(parse_robust_measure("mean+2sigma", figures).risk.parameter, 2);
  EXPECT_EQ(parse_robust_measure("mean+0.5sigma", figures).risk.kind, RiskKind::mean_sigma);
  EXPECT_EQ(parse_robust_measure("worst", figures).risk.kind, RiskKind::worst);
  ASSERT_TRUE(parse_robust_measure("yield:bounce_count == 0", figures).yield);
  EXPECT_EQ(parse_robust_measure("yield:bounce_count == 0", figures).yield->figure.key, "bounce_count");
}

TEST(RobustMeasure, IsRefusedWithTheReason) {
  EXPECT_EQ(refused_measure("best").find("unknown statistic 'best': choose one of cvar:0.9"), 0U);
  EXPECT_EQ(refused_measure("cvar:1"), "the level of cvar must be at least 0 and less than 1");
  EXPECT_EQ(refused_measure("cvar:nan").find("the level of cvar must be"), 0U);
  EXPECT_EQ(refused_measure("cvar:").find("the level of cvar must be"), 0U);
  EXPECT_EQ(refused_measure("quantile:1.5"), "the level of quantile must be from 0 to 1");
  EXPECT_EQ(refused_measure("mean+-1sigma"), "the factor of sigma must be a number from 0 on");
  EXPECT_EQ(refused_measure("mean+sigma"), "the factor of sigma must be a number from 0 on");
  EXPECT_NE(refused_measure("yield:"), "");
}

Scene calibrated(std::initializer_list<const char*> sets) {
  SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml");
  for (const char* set : sets) file.set(set);
  return read_scene(file);
}

TEST(Calibration, SaysWhatIsMeasured) {
  EXPECT_TRUE(calibrated({}).calibration.is_empty());
  const Calibration both = calibrated({"calibration.Vdp.error=\"1 %\"", "calibration.frequency.error=\"0.5 %\""}).calibration;
  EXPECT_EQ(both.pull_in_error, 0.01);
  EXPECT_EQ(both.frequency_error, 0.005);
  const Calibration exact = calibrated({"calibration={Vdp={}}"}).calibration;
  EXPECT_EQ(exact.pull_in_error, 0);
  EXPECT_FALSE(exact.frequency_error);
  EXPECT_EQ(refusal([] { return calibrated({"calibration.Vsp.error=\"1 %\""}); }).find("--set calibration.Vsp"), 0U);
  EXPECT_NE(refusal([] { return calibrated({"calibration.Vdp.error=\"60 %\""}); }).find("must be in [0, "), std::string::npos);
}

TEST(Calibration, OfAPiezoNeedsOne) {
  SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold-pzt.toml");
  file.set("calibration.piezo.error=\"1 %\"");
  EXPECT_EQ(read_scene(file).calibration.piezo_error, 0.01);
  EXPECT_FALSE(read_scene(file).calibration.is_empty());
  EXPECT_EQ(refusal([] { return calibrated({"calibration.piezo.error=\"1 %\""}); }),
            "--set calibration.piezo.error=\"1 %\": [calibration.piezo]: needs a [piezo] layer, whose deflection is measured");
  file.set("calibration.piezo.error=\"1 us\"");
  EXPECT_NE(refusal([&] { return read_scene(file); }).find("must be a percentage or a plain number"), std::string::npos);
}

TEST(Calibration, MaySortDevicesIntoClasses) {
  const auto refused = [](std::initializer_list<const char*> sets) { return refusal([&] { return calibrated(sets); }); };
  EXPECT_FALSE(calibrated({"calibration={Vdp={}}"}).calibration.classes);
  EXPECT_EQ(calibrated({"calibration={Vdp={}, classes=8}"}).calibration.classes, 8);
  EXPECT_EQ(refused({"calibration.Vdp.error=0", "calibration.classes=1"}),
            "--set calibration.classes=1: must be a whole number from 2 to 256");
  EXPECT_EQ(refused({"calibration.Vdp.error=0", "calibration.classes=2.5"}),
            "--set calibration.classes=2.5: must be a whole number from 2 to 256");
  EXPECT_EQ(refused({"calibration.classes=4"}),
            "--set calibration.classes=4: needs a measurement by which devices are sorted: "
            "add [calibration.Vdp] or [calibration.frequency]");
  EXPECT_EQ(refused({"calibration.Vdp.error=0", "calibration.clases=4"}),
            "--set calibration.clases=4: expected a section [calibration.NAME] or the key 'classes'");
}

TEST(Calibration, StandsInTheResolvedScene) {
  const Scene scene =
      calibrated({"calibration={frequency={}, classes=8}", "waveform.main.level=\"17 V\"", "driver.main.max_voltage=\"25 V\""});
  const Calibration again = read_scene(resolved(scene, {})).calibration;
  EXPECT_EQ(again.frequency_error, 0);
  EXPECT_FALSE(again.pull_in_error);
  EXPECT_EQ(again.classes, 8);
}

}  // namespace
}  // namespace softland::criterion_test
