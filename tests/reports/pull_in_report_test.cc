// Tests what `softland pull-in` says of a voltage sweep, on synthetic points.
#include "reports/pull_in_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace softland::pull_in_report_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

PullInsRecord swept(std::vector<SweepPoint> points) {
  PullInsRecord record{.swept = "main", .sweep = std::move(points)};
  record.origin.scene = nlohmann::json::object();
  record.electrodes["main"] = {.status = Status::done,
                               .volts = {.static_pull_in = 15.2, .release = 14.9, .pulled_through = 40.2, .deflection = 1e-6}};
  return record;
}

SweepPoint point(double voltage, SweepState state, bool is_up = true) {
  const bool is_known = state != SweepState::none;
  return {.voltage = voltage,
          .deflection = is_known ? 1e-6 : Metrics::unset,
          .capacitance = is_known ? 1e-14 : Metrics::unset,
          .is_up = is_up,
          .state = state};
}

TEST(PullInReport, SaysAtWhichVoltageASweepCollapses) {
  const std::string words = "In the sweep the beam collapses onto electrode main at ";
  const PullInsRecord collapsed = swept({point(10, SweepState::open), point(30, SweepState::closed), point(50, SweepState::none),
                                         point(50, SweepState::none, false), point(10, SweepState::none, false)});
  EXPECT_THAT(text_of(collapsed), HasSubstr(words + "40.200\u00a0V and stays there."));
  const std::string svg = sweep_svg(collapsed);
  EXPECT_THAT(svg, HasSubstr("Electrode main, swept up<"));
  EXPECT_THAT(svg, HasSubstr(words + "40.200\u00a0V"));
  for (const char* untrue : {"release", ">down<"}) EXPECT_THAT(svg, Not(HasSubstr(untrue)));
  EXPECT_THAT(text_of(swept({point(10, SweepState::open), point(20, SweepState::none)})), HasSubstr("at 15.200\u00a0V"));
  EXPECT_THAT(text_of(swept({point(-60, SweepState::none)})), HasSubstr("at \u221260.000\u00a0V")) << "no known voltage is near";

  const PullInsRecord whole = swept({point(10, SweepState::open), point(30, SweepState::closed),
                                     point(30, SweepState::closed, false), point(10, SweepState::open, false)});
  EXPECT_THAT(text_of(whole), Not(HasSubstr("collapses onto electrode main at")));
  for (const char* there : {"Electrode main, swept up and down<", "release at 14.90", ">down<"})
    EXPECT_THAT(sweep_svg(whole), HasSubstr(there));
  EXPECT_THAT(sweep_svg(whole), Not(HasSubstr("collapses")));
}

TEST(PullInReport, SaysWhichStepsTouchAndDoNotStayClosed) {
  const std::string words = "a step to between 14.200\u00a0V and 14.900\u00a0V, below the release voltage, touches and does not";
  PullInsRecord record = swept({});
  PullInRecord& volts = record.electrodes["main"].volts;
  record.origin.scene["contact"] = nlohmann::json::object();
  volts.dynamic_pull_in = 14.2;
  EXPECT_THAT(brief_contact_prose(volts), HasSubstr(words));
  EXPECT_THAT(text_of(record), HasSubstr(words));
  volts.dynamic_pull_in = 14.9 * (1 - 1e-7);
  EXPECT_EQ(brief_contact_prose(volts), "") << "equal digits";
  volts.dynamic_pull_in = 15.2;
  EXPECT_EQ(brief_contact_prose(volts), "");
  EXPECT_THAT(text_of(record), Not(HasSubstr("does not stay closed")));
  volts.dynamic_pull_in = Metrics::unset;
  EXPECT_EQ(brief_contact_prose(volts), "") << "without a dynamic pull-in voltage";
}

}  // namespace
}  // namespace softland::pull_in_report_test
