// Tests `softland fit` as a user does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "program.h"

namespace softland::fit_verb_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* plate = R"(title = "Plate on springs"
[structure]
kind = "plate"
area = "1e-8 m^2"
mass = "2.4 ug"        # weighed
stiffness = "42 N/m"   # of four springs, wafer 3
[gap]
electrode = "3.8 um"
contact = "2.6 um"
[electrode.main]
fringing = "none"
[contact]
model = "linear"
stiffness = "1e5 N/m"
[waveform.main]
family = "step"
level = "100 V"
[driver.main]
max_voltage = "120 V"
[simulate]
duration = "300 us"
accuracy = 1e-4
[spread]
"structure.stiffness" = { distribution = "normal", cov = "6 %" }
"structure.mass" = { distribution = "normal", cov = "3 %" }
)";
// The nominal frequency is 21.054 kHz; 3 % more frequency means 6 % more stiffness.
constexpr const char* bench = R"([[measurement]]
quantity = "frequency"
value = "21.686 kHz"
error = "0.01 %"
[[measurement]]
quantity = "pull_in"
value = "90.3 V"
error = "0.5 %"
)";

class FitVerb : public testing::Test {
 protected:
  void SetUp() override {
    write(here.path() / "plate.toml", plate);
    write(here.path() / "bench.toml", bench);
    const Outcome o = here.run({"fit", "plate.toml", "--data", "bench.toml", "--starts", "1", "--quiet"});
    if (o.err.find("without Ceres") != std::string::npos) GTEST_SKIP() << "skipped: no Ceres; needs: libceres-dev";
  }
  [[nodiscard]] Outcome fit(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"fit", "plate.toml", "--data", "bench.toml", "--starts", "3", "--jobs", "2", "--out", "out"};
    words.insert(words.end(), more.begin(), more.end());
    return here.run(words);
  }
  Workplace here;
};

TEST_F(FitVerb, LeavesTheSceneWithItsCommentsAndOtherNumbers) {
  const Outcome o = fit({});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("structure.stiffness"));
  const std::string fitted = read(here.path() / "out/fitted.toml");
  EXPECT_THAT(fitted, HasSubstr("# of four springs, wafer 3  # fitted, was \"42 N/m\""));
  EXPECT_THAT(fitted, HasSubstr(" ug\"        # weighed"));
  EXPECT_EQ(here.run({"check", "out/fitted.toml", "--quiet"}).status, 0);
  // The fitted scene reproduces the measurement.
  const json modes = json::parse(here.run({"modes", "out/fitted.toml", "--json", "-"}).out);
  EXPECT_NEAR(modes["natural_frequencies_rad_s"][0].get<double>() / (2 * 3.14159265358979 * 21686), 1, 3e-4);
}
TEST_F(FitVerb, LeavesDataThatSayHowWellEachNumberIsKnown) {
  EXPECT_EQ(fit({"--quiet"}).status, 0);
  const json data = json::parse(read(here.path() / "out/fit.json"));
  for (const char* key : {"unknowns", "correlation", "indistinguishable", "next_measurement", "minima", "residuals"})
    EXPECT_TRUE(data.contains(key)) << key;
  ASSERT_EQ(data["unknowns"].size(), 2U);
  for (const json& u : data["unknowns"]) {
    EXPECT_GT(u["standard_error"], 0);
    EXPECT_LT(u["interval95"][0], u["value"]);
    EXPECT_GT(u["interval95"][1], u["value"]);
  }
  EXPECT_EQ(data["minima"], 1);
  EXPECT_EQ(data["residuals"].size(), 2U);
  const std::string page = read(here.path() / "out/fit.html");
  EXPECT_THAT(page, HasSubstr("What to measure next"));
  EXPECT_THAT(page, testing::Not(HasSubstr(">nan<")));
}
TEST_F(FitVerb, OfSeveralDevicesLeavesASpreadThatOtherVerbsRead) {
  std::string wafer;
  for (const auto& [device, frequency] : {std::pair{"A", "21.2 kHz"}, std::pair{"B", "21.0 kHz"}, std::pair{"C", "21.4 kHz"}})
    wafer += std::string("[[measurement]]\nquantity = \"frequency\"\nerror = \"0.1 %\"\nvalue = \"") + frequency +
             "\"\ndevice = \"" + device + "\"\n";
  write(here.path() / "bench.toml", wafer);
  const Outcome o = fit({});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("structure.stiffness of B"));
  // One sentence about all of them, broken into lines.
  EXPECT_THAT(std::regex_replace(o.out, std::regex("\n"), " "),
              HasSubstr("cannot separate structure.mass and structure.stiffness: "));
  const std::string fitted = read(here.path() / "out/fitted.toml");
  EXPECT_THAT(fitted, HasSubstr("correlation = [[\"structure.mass\", \"structure.stiffness\", "));
  EXPECT_THAT(fitted, HasSubstr("# of four springs, wafer 3"));
  EXPECT_EQ(here.run({"robustness", "out/fitted.toml", "--samples", "10", "--quiet"}).status, 0);
  EXPECT_EQ(json::parse(read(here.path() / "out/fit.json"))["population"]["variables"].size(), 2U);
}
// Data that no device of the spread has, and data that contradict each other.
TEST_F(FitVerb, DoubtsImpossibleData) {
  const auto doubted = [&](const std::string& data) {
    write(here.path() / "bench.toml", data);
    const Outcome o = fit({"--quiet"});
    EXPECT_EQ(o.status, 4) << data << o.err;
    EXPECT_EQ(o.out.find("Do not trust this fit: "), 0U) << o.out;
    const json told = json::parse(read(here.path() / "out/fit.json"));
    EXPECT_EQ(told["status"], "not_believed");
    EXPECT_FALSE(told["doubts"].empty());
    for (const json& unknown : told["unknowns"]) {
      EXPECT_TRUE(unknown["standard_error"].is_null());
      EXPECT_TRUE(unknown["interval95"][0].is_null());
    }
    return told["doubts"].dump();
  };
  // A voltage in the wrong unit, and 9 kHz instead of 21 kHz.
  EXPECT_THAT(doubted(edited(bench, "90.3 V", "90.3 mV")), HasSubstr("standard deviations away from its prior"));
  EXPECT_THAT(doubted("[[measurement]]\nquantity = \"frequency\"\nvalue = \"9 kHz\"\nerror = \"0.01 %\"\n"),
              HasSubstr("structure.stiffness is "));
  // Two different values of the same quantity.
  EXPECT_THAT(
      doubted(bench + std::string("[[measurement]]\nquantity = \"frequency\"\nvalue = \"20.9 kHz\"\nerror = \"0.01 %\"\n")),
      HasSubstr("RMS residual "));
}

TEST_F(FitVerb, RefusesDataThatNothingHas) {
  for (const auto& [quantity, value] : std::vector<std::pair<std::string, std::string>>{{"pull_in", "-14 V"},
                                                                                        {"pull_in", "0 V"},
                                                                                        {"release", "-1 V"},
                                                                                        {"frequency", "0 Hz"},
                                                                                        {"frequency", "-2 kHz"},
                                                                                        {"capacitance", "-1 fF"},
                                                                                        {"closing_time", "-40 us"}}) {
    write(here.path() / "bench.toml", "[[measurement]]\nquantity = \"" + quantity + "\"\nvalue = \"" + value +
                                          "\"\nerror = \"1 %\"\n" +
                                          (quantity == "closing_time" || quantity == "capacitance" ? "level = \"100 V\"\n" : ""));
    const Outcome o = fit({});
    EXPECT_EQ(o.status, 2) << quantity << value;
    EXPECT_THAT(o.err, HasSubstr("bench.toml:3: measurement.value"));
    EXPECT_THAT(o.err, HasSubstr("a " + quantity + " must be above 0"));
  }
  write(here.path() / "times.csv", "voltage_V,closing_time_us\n100,12\n110,-3\n");
  write(here.path() / "bench.toml", "[[measurement]]\nquantity = \"closing_time\"\nfile = \"times.csv\"\nerror = \"50 ns\"\n");
  const Outcome o = fit({});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("times.csv:3: a closing_time must be above 0"));
}

TEST_F(FitVerb, RefusesWhatItCannotFit) {
  const auto expect_refused = [&](const std::vector<std::string>& more, const std::string& words) {
    std::vector<std::string> all{"fit", "plate.toml", "--out", "out"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome o = here.run(all);
    EXPECT_EQ(o.status, 2) << words;
    EXPECT_THAT(o.err, HasSubstr(words));
  };
  expect_refused({"--data", "bench.toml", "--unknown", "structure.stifness"}, "did you mean 'stiffness'?");
  expect_refused({"--data", "bench.toml", "--loss", "l1"}, "must be huber, cauchy or none");
  expect_refused({"--data", "bench.toml", "--starts", "0"}, "--starts 0");
  expect_refused({}, "--data: must name the file of measurements");
  expect_refused({"--data", "none.toml"}, "none.toml");
  write(here.path() / "bench.toml", "[[measurement]]\nquantity = \"pull_in\"\nvalue = \"96 V\"\n");
  expect_refused({"--data", "bench.toml"}, "bench.toml:1: [[measurement]]: missing key 'error'");
}

}  // namespace
}  // namespace softland::fit_verb_test
