// Tests the report of the limit of a plate, which takes a second to compute.
#include "reports/limit_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/studies/scenes.h"
#include "tests/support/xml.h"

namespace softland {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const Limit& of_a_plate() {
  static const Limit found = limit(spring_plate(), {.curves = false});
  return found;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(LimitPicture, WithoutCurvesShowsTheLanding) {
  ASSERT_TRUE(of_a_plate().landing.has_value());
  const std::string svg = svg_of(record_of(of_a_plate(), ""));
  EXPECT_EQ(test::xml_fault(svg), "");
  for (const char* words : {"Gap (µm)", "Voltage (V)", ">contact plane<"}) EXPECT_THAT(svg, HasSubstr(words));
  EXPECT_GE(count(svg, "<polyline") + count(svg, "<path"), 2U);
}

// The time at 60 V was not found, so that the curve has a single point.
TEST(LimitPicture, OfACurveOfOnePlaceHasAxesAround) {
  Limit found = of_a_plate();
  found.landing.reset();
  found.over_peak = {{.status = Status::no_contact, .peak = 60}, {.status = Status::done, .time = 40e-6, .peak = 120}};
  const std::string svg = svg_of(record_of(found, ""));
  EXPECT_EQ(test::xml_fault(svg), "");
  EXPECT_THAT(svg, HasSubstr("Least time against the peak voltage"));
  for (const char* tick : {">110<", ">120<", ">130<"}) EXPECT_THAT(svg, HasSubstr(tick));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(LimitPicture, WhereNothingWasFoundSaysWhy) {
  Limit nothing = of_a_plate();
  nothing.landing.reset();
  nothing.touch = {.status = Status::no_contact, .message = "full pull does not bring the switch to its contact"};
  EXPECT_THAT(svg_of(record_of(nothing, "")), HasSubstr("full pull does not bring the switch to its contact"));
}

TEST(LimitReport, SaysHowSoftlyASlowWaveformCanLandAllDevices) {
  Limit found = of_a_plate();
  EXPECT_TRUE(json_of(record_of(found, "")).at("quasi_static").is_null());
  found.approach = {.drive = "piezo", .deviation = 0.03, .slope = -2e-6};
  found.quasi_static = 813e-6;
  found.step.steady_force_time = 391e-6;
  const nlohmann::json told = json_of(record_of(found, "")).at("quasi_static");
  EXPECT_NEAR(told.at("touch_places_m"), 2 * 1.645 * 0.03 * 2e-6, 1e-10);
  EXPECT_EQ(told.at("speed_m_s"), 813e-6);
  std::string text = text_of(record_of(found, ""));
  std::ranges::replace(text, '\n', ' ');
  EXPECT_THAT(text, HasSubstr("extend over 197\u00a0nm"));
  EXPECT_THAT(text, HasSubstr("(at 391\u00a0µs), has an impact velocity of at least 813\u00a0µm/s"));
}

// A log with an optimum that Ipopt did not find.
Limit with_a_failure() {
  Limit found = of_a_plate();
  found.attempts = {{.goal = LimitGoal::touch,
                     .found = {.status = Status::done,
                               .stage = SearchStage::finer_mesh,
                               .iterations = 30,
                               .time = 25e-6,
                               .permitted = 2e-3,
                               .peak = 120},
                     .accepted = true},
                    {.goal = LimitGoal::over_peak,
                     .found = {.status = Status::numerical_failure,
                               .message = "Ipopt: Restoration_Failed",
                               .stage = SearchStage::slower_touch,
                               .iterations = 47,
                               .permitted = 2e-3,
                               .peak = 90}},
                    {.goal = LimitGoal::over_peak,
                     .found = {.status = Status::no_contact,
                               .message = "full pull does not bring the switch to its contact",
                               .permitted = 2e-3,
                               .peak = 80}}};
  return found;
}

TEST(LimitReport, NamesOptimaThatIpoptDidNotFind) {
  const std::string all = text_of(record_of(of_a_plate(), ""));
  EXPECT_THAT(all, HasSubstr("4 of 4 optima found, "));
  EXPECT_THAT(all, Not(HasSubstr("Not found")));
  const std::string text = text_of(record_of(with_a_failure(), ""));
  EXPECT_THAT(text, HasSubstr("1 of 3 optima found, 77 iterations of Ipopt"));
  EXPECT_THAT(text,
              HasSubstr("Not found: touch at up to 2.00\u00a0mm/s with up to 90.00\u00a0V: Ipopt: Restoration_Failed (stage: "
                        "slower touch, 47 iterations)"));
  EXPECT_EQ(count(text, "Not found"), 1U) << "the table says what the drives cannot reach";
}

TEST(LimitReport, KeepsTheLogInJsonAndInATable) {
  const LimitRecord record = record_of(with_a_failure(), "");
  const nlohmann::json written = json_of(record);
  EXPECT_EQ(written.at("attempts").at(1).at("goal"), "over peak voltage");
  EXPECT_EQ(written.at("attempts").at(1).at("message"), "Ipopt: Restoration_Failed");
  const LimitRecord again = read_limit(written);
  EXPECT_EQ(json_of(again).dump(), written.dump());
  EXPECT_EQ(text_of(again), text_of(record));
  const std::string table = attempts_csv(again);
  EXPECT_EQ(table, attempts_csv(record));
  EXPECT_EQ(count(table, "\n"), 4U);
  EXPECT_THAT(table, HasSubstr("\ntouch,false,0.002,120,true,done,finer mesh,,30,2.5e-05,,,,\n"));
  EXPECT_THAT(table,
              HasSubstr("\nover peak voltage,false,0.002,90,false,numerical_failure,slower touch,Ipopt: Restoration_Failed,47,,"
                        ",,,\n"));
}

TEST(LimitReport, SaysForWhichModelALeastTimeIsABound) {
  const nlohmann::json of_plate = json_of(record_of(of_a_plate(), ""));
  EXPECT_EQ(of_plate.at("modes"), 1);
  EXPECT_THAT(text_of(record_of(of_a_plate(), "")), Not(HasSubstr("in this model of")));
  LimitRecord of_beam = record_of(of_a_plate(), "");
  of_beam.origin.scene["structure"]["kind"] = "cantilever";
  std::string text = text_of(of_beam);
  std::ranges::replace(text, '\n', ' ');
  EXPECT_THAT(text, HasSubstr("in this model of 1 mode."));
  EXPECT_THAT(svg_of(of_beam), AllOf(HasSubstr("with 1 mode."), HasSubstr("The closing that is drawn lands after")));
}

}  // namespace
}  // namespace softland
