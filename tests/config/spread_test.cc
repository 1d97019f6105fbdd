// [spread]: which numbers vary, how they vary, and what is refused.
#include "config/spread.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/scene.h"
#include "message.h"
#include "small_scene.h"

namespace softland::spread_test {
namespace {

std::string with_spread(const std::string& lines) { return std::string(small_scene) + "[spread]\n" + lines + "\n"; }

DeviceSpread spread_of(const std::string& lines) { return read_scene(SceneFile::parse(with_spread(lines), "x.toml")).spread; }

constexpr double rounding = 1e-12;  // relative

TEST(Spread, OfOneKeyIsAFactorOfItsValue) {
  const DeviceSpread spread = spread_of(R"("structure.thickness" = { distribution = "normal", cov = "2 %" })");
  ASSERT_EQ(spread.variables.size(), 1U);
  const SpreadVariable& v = spread.variables[0];
  EXPECT_EQ(v.keys.at(0).path, "structure.thickness");
  EXPECT_EQ(v.keys.at(0).nominal, 4e-6);
  EXPECT_TRUE(v.is_factor);
  EXPECT_EQ(v.distribution.mean(), 1);
  EXPECT_NEAR(v.distribution.standard_deviation(), 0.02, rounding);
  EXPECT_FALSE(spread.copula);
  EXPECT_NEAR(DeviceSpread::value(v, v.keys[0], 1.1), 4.4e-6, rounding * 4e-6);
}

TEST(Spread, InTheUnitOfTheKeyIsItsValue) {
  const DeviceSpread spread = spread_of(R"(
"structure.thickness" = { distribution = "normal", standard_deviation = "80 nm" }
"structure.youngs_modulus" = { distribution = "uniform", half_width = "5 GPa" }
"gap.contact" = { distribution = "triangular", low = "1.8 um", high = "2.1 um" }
"piezo.d31" = { distribution = "normal", standard_deviation = "9 pm/V", truncate_low = "-190 pm/V" }
)");
  ASSERT_EQ(spread.variables.size(), 4U);  // ordered by name
  const auto& [gap, d31, thickness, modulus] =
      std::tie(spread.variables[0], spread.variables[1], spread.variables[2], spread.variables[3]);
  for (const SpreadVariable& v : spread.variables) EXPECT_FALSE(v.is_factor) << v.name;
  EXPECT_EQ(thickness.distribution.mean(), 4e-6);
  EXPECT_NEAR(thickness.distribution.standard_deviation(), 80e-9, rounding * 80e-9);
  EXPECT_NEAR(modulus.distribution.support().high, 83e9, rounding * 83e9);
  EXPECT_NEAR(gap.distribution.mean(), (1.8e-6 + 2e-6 + 2.1e-6) / 3, 1e-9 * 2e-6);
  EXPECT_NEAR(d31.distribution.quantile(1e-9), -190e-12, 1e-15);
}

TEST(Spread, OfSeveralKeysIsOneFactorOfAll) {
  const DeviceSpread spread =
      spread_of(R"(gaps = { keys = ["gap.electrode", "gap.contact"], distribution = "lognormal", cov = "10 %" })");
  const SpreadVariable& v = spread.variables.at(0);
  ASSERT_EQ(v.keys.size(), 2U);
  EXPECT_EQ(v.name, "gaps");
  EXPECT_EQ(v.keys[0].nominal, 3.5e-6);
  EXPECT_EQ(v.keys[1].nominal, 2e-6);
  EXPECT_NEAR(v.distribution.standard_deviation(), 0.1, 1e-9);
}

TEST(Spread, WithWeightsIsOneAmountThatIsAddedToAll) {
  const DeviceSpread spread = spread_of(
      R"(undercut = { keys = ["gap.contact", "structure.thickness"], weights = [1, -2], distribution = "normal", standard_deviation = "50 nm" })");
  const SpreadVariable& v = spread.variables.at(0);
  EXPECT_FALSE(v.is_factor);
  EXPECT_EQ(v.nominal(), 0);
  EXPECT_EQ(v.distribution.mean(), 0);
  EXPECT_EQ(v.distribution.standard_deviation(), 50e-9);
  constexpr double amount = 30e-9;
  EXPECT_DOUBLE_EQ(DeviceSpread::value(v, v.keys[0], amount), v.keys[0].nominal + amount);
  EXPECT_DOUBLE_EQ(DeviceSpread::value(v, v.keys[1], amount), v.keys[1].nominal - 2 * amount);
  const auto refused = [](const std::string& more, const std::string& keys = R"("gap.contact", "structure.thickness")") {
    return message(with_spread("undercut = { keys = [" + keys + "], distribution = \"normal\", " + more + " }"));
  };
  using testing::HasSubstr;
  EXPECT_THAT(refused(R"(weights = [1], standard_deviation = "50 nm")"),
              HasSubstr("must be one weight for each key, but there are 1 for 2 keys"));
  EXPECT_THAT(refused(R"(weights = [1, 0], standard_deviation = "50 nm")"), HasSubstr("must not be 0"));
  EXPECT_THAT(refused(R"(weights = [1, 1], cov = "2 %")"), HasSubstr("add an amount to the keys"));
  EXPECT_THAT(refused(R"(weights = [1, 1], standard_deviation = "50 V")"), HasSubstr("expected a length"));
  EXPECT_THAT(refused(R"(weights = [1, 1], standard_deviation = "50 nm")", R"("gap.contact", "structure.youngs_modulus")"),
              HasSubstr("one amount cannot be added to gap.contact and structure.youngs_modulus"));
  EXPECT_THAT(refused(R"(standard_deviation = "50 nm")"), HasSubstr("or weights with which one amount is added to each key"));
}

TEST(Spread, SetsTheMembersOfADevice) {
  Scene scene = read_scene(SceneFile::parse(with_spread(R"("electrode.main.span" = 1)").substr(0, small_scene.size()), "x.toml"));
  const DeviceSpread spread = spread_of(R"(
gaps = { keys = ["gap.electrode", "gap.contact"], distribution = "normal", cov = "2 %" }
"contact.stiffness" = { distribution = "normal", cov = "2 %" }
"gas.viscosity" = { distribution = "normal", cov = "2 %" }
)");
  for (const SpreadVariable& v : spread.variables) {
    for (const VariedKey& key : v.keys) {
      EXPECT_EQ(key.member(scene), key.nominal) << key.path;
      key.member(scene) = 1.5 * key.nominal;
    }
  }
  EXPECT_DOUBLE_EQ(scene.device.gap.electrode, 1.5 * 3.5e-6);
  EXPECT_DOUBLE_EQ(scene.device.gap.contact, 1.5 * 2e-6);
  EXPECT_DOUBLE_EQ(std::get<LinearSpring>(scene.device.contacts.front().model).stiffness, 150);
  EXPECT_DOUBLE_EQ(film_of(*scene.device.gas)->viscosity, 1.5 * 1.86e-5);
}

// The keys are written as for --vary.
TEST(Spread, TakesTheEndsOfASpan) {
  const DeviceSpread spread = spread_of(R"(
"electrode.main.span[2]" = { distribution = "normal", standard_deviation = "1 um" }
"piezo.span[1]" = { distribution = "normal", cov = "2 %" }
)");
  Scene scene = read_scene(SceneFile::parse(with_spread(R"("electrode.main.span" = 1)").substr(0, small_scene.size()), "x.toml"));
  ASSERT_EQ(spread.variables.size(), 2U);
  const VariedKey& end = spread.variables[0].keys[0];
  EXPECT_EQ(end.name(), "electrode.main.span[2]");
  EXPECT_DOUBLE_EQ(end.nominal, 240e-6);
  end.member(scene) = 230e-6;
  EXPECT_EQ(scene.device.electrodes[0].end, Place(230e-6));
  spread.variables[1].keys[0].member(scene) = 6e-6;
  EXPECT_EQ(scene.device.piezo->begin, Place(6e-6));
  for (const char* wrong : {"electrode.main.span", "electrode.main.span[0]", "electrode.main.span[3]", "gap.contact[1]"})
    EXPECT_THROW((void)spread_of(fmt::format(R"("{}" = {{ distribution = "normal", cov = "2 %" }})", wrong)), InvalidInput)
        << wrong;
}

TEST(Spread, SaysWhyAnEndThatFollowsTheLengthCannotDiffer) {
  const auto refused = [](const std::string& end, const std::string& entry) {
    try {
      (void)read_scene(SceneFile::parse(edited(with_spread(entry), R"("240 um"])", end + "]"), "x.toml"));
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(
      refused("\"tip\"", R"("electrode.main.span[2]" = { distribution = "normal", cov = "2 %" })"),
      testing::HasSubstr(R"([spread."electrode.main.span[2]"]: electrode.main.span[2] is the tip of the beam in every device)"));
  EXPECT_THAT(refused("\"90 %\"", R"("electrode.main.span[2]" = { distribution = "normal", standard_deviation = "1 um" })"),
              testing::HasSubstr(
                  R"(standard_deviation = "1 um": electrode.main.span[2] is a percentage of structure.length in this scene)"));
  EXPECT_EQ(refused("\"90 %\"", R"("electrode.main.span[2]" = { distribution = "normal", cov = "2 %" })"), "");
}

TEST(Spread, RefusesValuesThatTheKeyCannotHave) {
  const DeviceSpread spread = spread_of(R"("structure.thickness" = { distribution = "normal", cov = "2 %" })");
  EXPECT_EQ(spread.variables[0].keys[0].refusal(4e-6), "");
  EXPECT_NE(spread.variables[0].keys[0].refusal(-1e-6), "");
}

TEST(Spread, CorrelatesTheNamedVariables) {
  const DeviceSpread spread = spread_of(R"(
"structure.thickness" = { distribution = "normal", cov = "2 %" }
gaps = { keys = ["gap.electrode", "gap.contact"], distribution = "normal", cov = "2 %" }
"structure.density" = { distribution = "normal", cov = "2 %" }
correlation = [["structure.thickness", "gaps", 0.8]]
)");
  ASSERT_TRUE(spread.copula);
  const auto at = [&](const std::string& name) {
    Eigen::Index i = 0;
    while (spread.variables[static_cast<std::size_t>(i)].name != name) ++i;
    return i;
  };
  EXPECT_EQ(spread.correlation(at("gaps"), at("structure.thickness")), 0.8);
  EXPECT_EQ(spread.correlation(at("gaps"), at("structure.density")), 0);
  // Both medians, and an extreme value of one variable with the resulting one of the other: z_2 = 0.8 z_1.
  std::vector<double> u{0.5, 0.5, 0.5};
  u[static_cast<std::size_t>(std::min(at("gaps"), at("structure.thickness")))] = 0.5 * std::erfc(-2 / std::sqrt(2.0));  // 2 sigma
  spread.to_values(u);
  EXPECT_NEAR(u[static_cast<std::size_t>(std::max(at("gaps"), at("structure.thickness")))], 1 + 0.02 * 0.8 * 2, 1e-9);
}

class SpreadFile : public testing::Test {
 protected:
  SpreadFile() : folder(std::filesystem::temp_directory_path() / fmt::format("softland-spread-{}", ::getpid())) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "wafer.csv") << "# measured\nsite, thickness_um, other\n1, 3.9, 0\n2, 4.2, 0\n3, 4.0, 0\n";
  }
  ~SpreadFile() override { std::filesystem::remove_all(folder); }
  [[nodiscard]] SceneFile file(const std::string& lines) const { return SceneFile::parse(with_spread(lines), "x.toml", folder); }
  std::filesystem::path folder;
};

TEST_F(SpreadFile, GivesTheValuesOfAColumn) {
  const SceneFile given =
      file(R"("structure.thickness" = { distribution = "empirical", file = "wafer.csv", column = "thickness_um", unit = "um" })");
  const Scene scene = read_scene(given);
  const SpreadVariable& v = scene.spread.variables.at(0);
  EXPECT_FALSE(v.is_factor);
  EXPECT_NEAR(v.distribution.quantile(0.5), 4e-6, rounding * 4e-6);
  EXPECT_NEAR(v.distribution.support().high, 4.2e-6, rounding * 4e-6);

  // The resolved scene does not need the file.
  const Scene again = read_scene(resolved(scene, {{"main", {.static_pull_in = 50, .dynamic_pull_in = 40}}}));
  for (const double p : {0.1, 0.3, 0.77})
    EXPECT_DOUBLE_EQ(again.spread.variables.at(0).distribution.quantile(p), v.distribution.quantile(p)) << p;
}

TEST_F(SpreadFile, OfFactorsIsResolvedWithTheirOwnDigits) {
  std::ofstream(folder / "factors.csv") << "ratio\n0.035\n0.98\n1.07\n";
  const Scene scene =
      read_scene(file(R"("structure.thickness" = { distribution = "empirical", file = "factors.csv", column = "ratio" })"));
  const SceneFile whole = resolved(scene, {{"main", {.static_pull_in = 50, .dynamic_pull_in = 40}}});
  EXPECT_EQ(whole.json()["spread"]["structure.thickness"]["values"], (nlohmann::json{"3.5 %", "98 %", "107 %"}));
  EXPECT_EQ(read_scene(whole).spread.variables.at(0).distribution.support().low, 0.035);
}

TEST_F(SpreadFile, RefusesColumnsThatAreNotThere) {
  const auto refused = [&](const std::string& entry) {
    try {
      static_cast<void>(read_scene(file("\"structure.thickness\" = { distribution = \"empirical\", " + entry + " }")));
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused(R"(file = "wafer.csv", column = "width", unit = "um")").find("there are 0 columns named \"width\""),
            std::string::npos);
  EXPECT_NE(refused(R"(file = "wafer.csv", unit = "um")").find("missing key 'column'"), std::string::npos);
  EXPECT_NE(refused(R"(file = "none.csv", column = "a")").find("none.csv: cannot be read"), std::string::npos);
  EXPECT_NE(refused(R"(file = "wafer.csv", column = "thickness_um", unit = "GPa")").find("expected a length [m], got a pressure"),
            std::string::npos);
}

TEST(Spread, IsTheSameWhenTheResolvedSceneIsReadAgain) {
  const std::string lines = R"(
"structure.thickness" = { distribution = "normal", cov = "2 %", truncate_low = "95 %", truncate_high = "105 %" }
"piezo.d31" = { distribution = "empirical", values = ["-170 pm/V", "-160 pm/V", "-181 pm/V"] }
gaps = { keys = ["gap.electrode", "gap.contact"], distribution = "triangular", low = "97 %", high = "104 %" }
correlation = [["structure.thickness", "gaps", 0.3], ["gaps", "piezo.d31", -0.2]]
)";
  const Scene scene = read_scene(SceneFile::parse(with_spread(lines), "x.toml"));
  const Scene again = read_scene(resolved(scene, {{"main", {.static_pull_in = 50, .dynamic_pull_in = 40}}}));
  ASSERT_EQ(again.spread.variables.size(), 3U);
  EXPECT_EQ(again.spread.correlation, scene.spread.correlation);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.spread.variables[i].name, scene.spread.variables[i].name);
    for (const double p : {0.03, 0.5, 0.9})
      EXPECT_EQ(again.spread.variables[i].distribution.quantile(p), scene.spread.variables[i].distribution.quantile(p));
  }
}

TEST(Spread, OfADrivesErrors) {
  const DeviceSpread spread = spread_of(R"(
"driver.main.offset" = { distribution = "uniform", half_width = "20 mV" }
amplifier = { keys = ["driver.main.gain", "driver.piezo.gain"], distribution = "normal", cov = "0.5 %" }
trigger = { keys = ["driver.main.delay", "driver.piezo.delay"], distribution = "normal", standard_deviation = "20 ns" }
"driver.piezo.jitter" = { distribution = "normal", standard_deviation = "50 ns", truncate_low = "-100 ns" }
"structure.thickness" = { distribution = "normal", cov = "2 %" }
correlation = [["amplifier", "trigger", 0.5]]
)");
  EXPECT_TRUE(spread.varies_drives());
  ASSERT_EQ(spread.variables.size(), 5U);  // ordered by name
  const SpreadVariable &gain = spread.variables[0], &offset = spread.variables[1], &jitter = spread.variables[2],
                       &delay = spread.variables[4];
  EXPECT_TRUE(gain.is_factor);
  EXPECT_EQ(gain.distribution.mean(), 1);
  EXPECT_NEAR(gain.distribution.standard_deviation(), 0.005, rounding);
  ASSERT_EQ(gain.keys.size(), 2U);
  EXPECT_EQ(gain.keys[1].path, "driver.piezo.gain");
  EXPECT_EQ(gain.keys[1].drive->name, "piezo");
  EXPECT_EQ(gain.keys[1].drive->error, DriveError::gain);
  EXPECT_EQ(DeviceSpread::value(gain, gain.keys[1], 1.01), 1.01);
  EXPECT_NE(gain.keys[0].refusal(-0.1), "");
  EXPECT_FALSE(offset.is_factor);
  EXPECT_NEAR(offset.distribution.support().low, -0.02, rounding);
  EXPECT_EQ(offset.keys[0].unit, "V");
  EXPECT_EQ(offset.keys[0].refusal(-0.1), "") << "an offset may be negative";
  // Several drives share the value of one error.
  ASSERT_EQ(delay.keys.size(), 2U);
  EXPECT_EQ(DeviceSpread::value(delay, delay.keys[0], 3e-8), 3e-8);
  EXPECT_EQ(DeviceSpread::value(delay, delay.keys[1], 3e-8), 3e-8);
  EXPECT_TRUE(jitter.is_drawn_per_edge);
  EXPECT_FALSE(gain.is_drawn_per_edge);
  EXPECT_FALSE(spread_of(R"("structure.thickness" = { distribution = "normal", cov = "2 %" })").varies_drives());
}

TEST(Spread, DrawsJitterForEveryEdgeOfEveryDevice) {
  const SpreadVariable jitter =
      spread_of(R"("driver.main.jitter" = { distribution = "normal", standard_deviation = "50 ns" })").variables.at(0);
  DeviceSpread spread;
  spread.variables.push_back(jitter);
  constexpr int devices = 4000;
  double squares = 0, of_edges = 0, of_devices = 0;
  for (int k = 0; k < devices; ++k) {
    std::vector<double> u{(k + 0.5) / devices}, next{(k + 1.5) / devices};
    spread.to_values(u);
    EXPECT_EQ(u[0], (k + 0.5) / devices) << "stays what the times are drawn from";
    const double first = DeviceSpread::jitter(jitter, u[0], 0);
    squares += first * first;
    of_edges += first * DeviceSpread::jitter(jitter, u[0], 1);
    of_devices += first * DeviceSpread::jitter(jitter, next[0], 0);
    EXPECT_EQ(first, DeviceSpread::jitter(jitter, u[0], 0)) << "a function of device and edge";
  }
  constexpr double variance = 50e-9 * 50e-9, sigmas = 4;
  EXPECT_NEAR(squares / devices, variance, sigmas * variance * std::sqrt(2.0 / devices));
  EXPECT_NEAR(of_edges / devices, 0, sigmas * variance / std::sqrt(devices)) << "edges are independent";
  EXPECT_NEAR(of_devices / devices, 0, sigmas * variance / std::sqrt(devices)) << "and so are devices";
}

struct Bad {
  std::string lines, rule;
};

TEST(Spread, RefusesWhatMakesNoSense) {
  const std::string thickness = R"("structure.thickness" = { distribution = "normal", cov = "2 %" })";
  const std::vector<Bad> all{
      {R"(gaps = { distribution = "normal", cov = "2 %" })", "'gaps' is not a key of this scene"},
      {R"("waveform.main.level" = { distribution = "normal", cov = "2 %" })", "is not a key of this scene"},
      {R"(gaps = { keys = [], distribution = "normal", cov = "2 %" })", "must name at least one key"},
      {R"(gaps = { keys = ["gap.contact", "gap.contact"], distribution = "normal", cov = "2 %" })", "names a key twice"},
      {R"(gaps = { keys = "gap.contact", distribution = "normal", cov = "2 %" })", "expected a list of texts"},
      {R"(gaps = { keys = ["gap.contact", "gap.electrode"], distribution = "normal", standard_deviation = "2 nm" })",
       "several keys vary by one factor: give a percentage"},
      {thickness + "\n"
                   "both = { keys = [\"structure.thickness\", \"structure.width\"], distribution = \"normal\", cov = \"2 %\" }",
       "structure.thickness already varies by another entry"},
      {R"("structure.damping_ratio" = { distribution = "normal", cov = "2 %" })",
       "is 0 in this scene, so that no factor changes it"},
      {R"("structure.thickness" = { distribution = "triangular", low = "110 %", high = "120 %" })", "mode"},
      {R"("structure.thickness" = { distribution = "normal", cov = "2 %", truncate_low = "130 %" })", "truncate_low"},
      {R"("structure.thickness" = { distribution = "empirical", values = ["4 um"] })", "values"},
      {R"("structure.thickness" = { distribution = "lognormal", standard_deviation = "1 GPa" })", "expected a length [m]"},
      {R"("driver.mian.gain" = { distribution = "normal", cov = "1 %" })",
       "'driver.mian.gain' is not an error of a drive, such as driver.main.gain: unknown electrode (did you mean 'main'?)"},
      {R"("driver.dispersion.gain" = { distribution = "normal", cov = "1 %" })", ": the dispersion force has no source"},
      {R"("driver.main.gian" = { distribution = "normal", cov = "1 %" })",
       "'driver.main.gian' is not an error of a drive, such as driver.main.gain (did you mean 'gain'?)"},
      {R"("driver.main.max_voltage" = { distribution = "normal", cov = "1 %" })", "(known: gain, offset, delay, jitter)"},
      {R"("driver.gain" = { distribution = "normal", cov = "1 %" })", "'driver.gain' is not an error of a drive"},
      {R"(driver = { distribution = "normal", cov = "1 %" })", "'driver' is not an error of a drive"},
      {R"("driver.main.gain.now" = { distribution = "normal", cov = "1 %" })",
       "'driver.main.gain.now' is not an error of a drive"},
      {R"("driver.main.offset" = { distribution = "normal", cov = "1 %" })",
       "driver.main.offset is nominally 0, so that no factor changes it: give its distribution in V"},
      {R"("driver.main.offset" = { distribution = "normal", standard_deviation = "5 ns" })",
       R"(spread."driver.main.offset".standard_deviation = "5 ns": expected a voltage [V], got a time [s])"},
      {R"("driver.main.gain" = { distribution = "normal", standard_deviation = "5 mV" })",
       "expected a plain number, got a voltage [V]"},
      {R"("driver.main.delay" = { distribution = "normal", standard_deviation = "5 ns", truncate_high = "200 %" })",
       "is relative to the value in the scene, which is 0: give it a unit"},
      {R"(times = { keys = ["driver.main.delay", "driver.main.jitter"], distribution = "normal", standard_deviation = "5 ns" })",
       "several keys vary by one factor: give a percentage"},
      {thickness + "\n\"driver.main.jitter\" = { distribution = \"normal\", standard_deviation = \"5 ns\" }\n" +
           "correlation = [[\"structure.thickness\", \"driver.main.jitter\", 0.3]]",
       "'driver.main.jitter' has a new random value for every edge, and cannot be correlated"},
      {thickness + "\ncorrelation = 3", "expected a list such as"},
      {thickness + "\ncorrelation = [[\"structure.thickness\", \"gaps\"]]", "expected a list such as"},
      {thickness + "\ncorrelation = [[\"structure.thickness\", \"gaps\", 0.3]]", "'gaps' does not vary"},
      {thickness + "\ncorrelation = [[\"structure.thickness\", \"structure.thickness\", 0.3]]", "is correlated with itself"},
      {thickness + "\n\"gap.contact\" = { distribution = \"normal\", cov = \"2 %\" }\ncorrelation = [[\"structure.thickness\", "
                   "\"gap.contact\", 1.5]]",
       "spread.correlation"},
  };
  for (const Bad& bad : all) {
    const std::string told = message(with_spread(bad.lines));
    EXPECT_NE(told.find(bad.rule), std::string::npos) << bad.lines << "\nis answered with: " << told;
    EXPECT_EQ(told.find("x.toml:"), 0U) << told;
  }
}

}  // namespace
}  // namespace softland::spread_test
