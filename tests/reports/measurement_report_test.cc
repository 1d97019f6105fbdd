// Tests the report of measurements on synthetic numbers.
#include "reports/measurement_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace softland::measurement_report_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Prediction judged(const std::string& name, std::vector<std::size_t> figures, double score) {
  return {.name = name,
          .figures = std::move(figures),
          .volts_miss = 0.012,
          .time_miss = 0.034,
          .volts_unexplained = 0.1,
          .time_unexplained = 0.2,
          .is_judged = true,
          .score = score,
          .bounce_free = yield_of(8, 16),
          .impact_speed = {.value = score, .interval = {score / 2, 2 * score}},
          .rebound_height = {.value = 1e-9, .interval = {0.5e-9, 2e-9}}};
}

IdentificationStudy study() {
  IdentificationStudy s{.devices = 4};
  s.figures = {{.name = "Vdp", .unit = "V", .nominal = 14, .error = 0.01, .values = {13, 14, 15, Metrics::unset}},
               {.name = "frequency", .unit = "Hz", .nominal = 1e4, .error = 0, .values = {9e3, 1e4, 1.1e4, 1e4}}};
  s.references = {judged("nothing", {}, 0.5)};
  s.predictions = {judged("Vdp", {0}, 0.1), judged("Vdp and frequency", {0, 1}, 0.2)};
  s.predictions.push_back({.name = "frequency", .figures = {1}, .volts_miss = 0.05, .time_miss = 0.01});
  return s;
}

TEST(MeasurementReport, OfATerminalRanksWhatIsMeasured) {
  const std::string text = text_of(record_of(study(), {.seed = 7}, ""));
  for (const char* words :
       {"4 devices under process variation", "\nVdp ", "1.2 %", "3.4 %", "50.0 % (28.0 to 72.0)", "mm/s (50 to 200)",
        "For comparison", "\nnothing ", "Seed 7.", "Pairs that do no", "better than one of their figures are left out: 1."})
    EXPECT_THAT(text, HasSubstr(words));
  EXPECT_THAT(text, Not(HasSubstr("Vdp and frequency"))) << "it does worse than Vdp alone";
  EXPECT_LT(text.find("\nVdp ", text.find("best first")), text.find("\nfrequency ", text.find("best first")));
  EXPECT_THAT(text, Not(HasSubstr("Interrupted")));
}

TEST(MeasurementReport, AsJsonHoldsEveryPredictionAndSaysWhatIsNotJudged) {
  IdentificationStudy stopped = study();
  stopped.interrupted = true;
  const nlohmann::json j = json_of(record_of(stopped, {.seed = 7}, "softland calibrate out"));
  EXPECT_EQ(j["kind"], "calibrate");
  EXPECT_EQ(j["status"], "interrupted");
  EXPECT_EQ(j["command"], "softland calibrate out");
  EXPECT_EQ(j["figures"][0]["devices"], 3) << "one does not have it";
  EXPECT_EQ(j["figures"][0]["error"], 0.01);
  ASSERT_EQ(j["predictions"].size(), 3U);
  EXPECT_EQ(j["predictions"][1]["measured"], (nlohmann::json{"Vdp", "frequency"}));
  EXPECT_EQ(j["predictions"][1]["score_95"], 0.2);
  EXPECT_FALSE(j["predictions"][2].contains("score_95"));
  EXPECT_EQ(j["predictions"][2]["time_miss"], 0.01);
  EXPECT_EQ(json_of(record_of(study(), {}, ""))["status"], "done");
}

}  // namespace
}  // namespace softland::measurement_report_test
