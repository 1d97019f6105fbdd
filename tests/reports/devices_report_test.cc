// Tests the report of a search for devices on synthetic figures.
#include "reports/devices_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "document/text.h"
#include "reports/closing_captions.h"
#include "reports/closing_charts.h"
#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "reports/device_gaps.h"
#include "reports/record_file.h"
#include "sample_result.h"

namespace softland {
namespace {

using testing::HasSubstr;
using testing::Not;

ClosingRecord search_alone() { return read_closing(test::sample_optimize_result(100)); }

DevicesFindings::Row row(const std::string& name, double bounce_free, double speed, double height) {
  return {.name = name,
          .bounce_free = bounce_free,
          .open = 0.001,
          .collapsed = 0,
          .at_95 = {{"largest_impact_velocity_m_s", speed},
                    {"major_bounce_height_m", height},
                    {"initial_contact_time_s", 40e-6},
                    {"steady_force_time_s", name == "plain step" ? 500e-6 : 480e-6},
                    {"peak_contact_force_N", std::numeric_limits<double>::infinity()}},
          .at_99 = {{"largest_impact_velocity_m_s", 1.1 * speed}, {"major_bounce_height_m", 1.1 * height}},
          .yield = {{"1e-9", 0}, {"1e-8", 0.25}, {"1e-7", 1}}};
}

ClosingRecord devices_result() {
  ClosingRecord r = search_alone();
  DevicesFindings d{.spread = "gaps ± 2 %",
                    .count = 2000,
                    .seed = 7,
                    .closings = 150'000,
                    .measure = "cvar:0.9",
                    .waveform = "quasi-static",
                    .better_than_plain_step = true};
  d.rows = {row("plain step", 0, 0.107, 732e-9), row("for the drawing", 0.02, 0.08, 150e-9),
            row("for the devices", 0.01, 0.033, 90e-9)};
  DevicesFindings::Row measured = row("Vdp to 1 %", 0.1, 0.0166, 50e-9);
  measured.pull_in_error = 0.01;
  d.rows.push_back(measured);
  measured.name = "Vdp and piezo to 1 %", measured.piezo_error = 0.01;
  d.rows.push_back(measured);
  d.by_error = {{.error = 0.002, .bounce_free = 0.162, .impact_speed = 0.0146},
                {.error = 0.01, .bounce_free = 0.104, .impact_speed = 0.0178}};
  d.windows = {.of_electrodes = {{"main", {.lower = 16.36, .upper = 36.31}}}, .devices = 200};
  d.front = {{.first_touch = 50e-6, .impact_speed = 0.05, .bounce_free = 0, .candidate = "knots:6 by yield"},
             {.first_touch = 90e-6, .impact_speed = 0.033, .bounce_free = 0.01, .candidate = "catch by cvar:0.9"}};
  d.tournament = {{.measure = "cvar:0.9", .waveform = "catch", .closings = 18'000, .bounce_free = 0.01, .cost = 0.3}};
  d.conditions = {{.text = "t_i < 3 step", .share = {.devices = 2000, .value = 0.97, .interval = {0.96, 0.98}}, .holds = true}};
  d.nominal[&Metrics::permanent_contact_time] = 33.4e-6;
  d.nominal[&Metrics::major_bounce_height] = 0;
  d.nominal_status = "done";
  d.nominal_goal_met = true;
  d.measured = "Vdp to 1 %";
  d.choices = {{.name = "fast", .file = "fast.toml", .waveform = "catch", .tau = 0.4},
               {.name = "default", .file = "best.toml", .waveform = "quasi-static", .tau = 0.97}};
  d.rows.push_back(row("fast", 0, 0.05, 120e-9));
  d.stable_path = {.drives = {"piezo", "main"}, .share = 0.965, .reaches = -0.948, .limit = -1};
  d.step_delay = 463e-6;
  d.courses = {.end = 500e-6, .unit = 1e-9, .step = {{2000, 0, 800, 0}, {2010, 0, 700, 0}}, .own = {{2000, 400, 9, 0}}};
  d.goal_met = false;
  d.missed_by = 89e-9;
  d.next_command = "softland export out/calibrated.toml --device-vdp \"14.2 V\"";
  r.search->devices = d;
  return r;
}

TEST(DevicesReport, SaysFirstWhatDevicesDo) {
  const std::string words = internal::headline(devices_result()).whole();
  EXPECT_EQ(words,
            "Of 2000 simulated devices, 95 % touch at no more than 33.0\u00a0mm/s instead of 107\u00a0mm/s, and carry a steady "
            "force from 480\u00a0µs on instead of 500\u00a0µs: best.toml.");
  const ClosingRecord result = devices_result();
  const std::string text = terminal_text(closing_document(result)), page = page_html(closing_document(result));
  EXPECT_EQ(text.find("Of 2000 simulated devices"), 0U);
  for (const char* part : {"plain step", "fast: fast.toml", "default: best.toml", "Vdp to 1 %", "107 (118)\u00a0mm/s", "732 (",
                           "∞", "0.0 / 25.0 / 100 %", "500\u00a0µs"})
    EXPECT_THAT(text, HasSubstr(part));
  EXPECT_THAT(text, Not(HasSubstr("drawing.toml  "))) << "on the page";
  for (const char* part :
       {"nominal design: drawing.toml", "default: best.toml", "Vdp and piezo to 1 %",
        "Largest impact velocity against the error of Vdp", "89.0\u00a0nm above the height from which rebounds count",
        "99 % of 200 devices closed, between release and collapse:", "holds: 97.0 % of the devices",
        "The piezo carries 96.5 % of the devices to their contact"})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST(DevicesReport, SaysThatTheChartOfTheSearchShowsTheNominalDesign) {
  ClosingRecord r = devices_result();
  r.search->course.value_name = "cost, on the nominal design";
  const auto caption = [&] { return internal::search_caption(r, *r.search); };
  EXPECT_THAT(caption(), testing::EndsWith("; its result is drawing.toml. best.toml comes from the search over devices, which "
                                           "this chart does not show."));
  r.search->devices->measure = "drawing";
  EXPECT_THAT(caption(), testing::EndsWith("best.toml was chosen among its waveforms, by their figures on the devices."));
  r.search->devices->better_than_plain_step = false;
  EXPECT_THAT(caption(), testing::EndsWith("; its result is drawing.toml. best.toml is the plain step."));
}

TEST(DevicesReport, SaysThatTheStepIsDelayedAndWhatMeasuringWins) {
  ClosingRecord r = devices_result();
  const auto text = [&] {
    std::string words = terminal_text(closing_document(r));
    std::ranges::replace(words, '\n', ' ');
    return words;
  };
  EXPECT_THAT(text(), HasSubstr("The plain step of the electrode is delayed to 463\u00a0µs"));
  EXPECT_THAT(text(), HasSubstr("--hold-step fixed"));
  EXPECT_THAT(
      text(),
      HasSubstr("(Vdp measured to 1 %), the 95th percentile of the largest impact velocity is 16.6\u00a0mm/s: calibrated.toml."));
  r.search->devices->measured.clear();
  r.search->devices->next_command.clear();
  EXPECT_THAT(text(), HasSubstr("neither Vdp measured to 1 % nor a closing time measured to 50 ns on each device gives"));
}

TEST(DevicesReport, DrawsDevicesUnderTheStepAndTheWaveformSideBySide) {
  ClosingRecord r = devices_result();
  const internal::Picture drawn = internal::gaps_picture(*r.search->devices);
  ASSERT_EQ(drawn.charts.size(), 2U);
  EXPECT_EQ(drawn.charts[0].series.size(), 3U) << "a curve for each device, and their median";
  EXPECT_EQ(drawn.charts[0].y_home, drawn.charts[1].y_home) << "they are compared";
  const internal::CurveTable& step = drawn.tables.at("devices-step");
  EXPECT_DOUBLE_EQ(step.at("time").back(), 500e-6);
  EXPECT_DOUBLE_EQ(step.at("0")[2], 800e-9);
  EXPECT_GE(step.at("low")[2], 700e-9);
  EXPECT_LE(step.at("high")[2], 800e-9);
  for (const std::string& text : {page_html(closing_document(r)), svg_devices(r)}) {
    EXPECT_THAT(text, testing::ContainsRegex("band from the 5th to( |</text>\n<text [^>]*>)the 95th percentile"));
    EXPECT_THAT(text, HasSubstr("clip-devices-best"));
  }
  DevicesFindings changed = *r.search->devices;  // a file that a user has edited
  changed.courses->own.front().pop_back();
  EXPECT_TRUE(internal::gaps_picture(changed).charts.empty());
  changed.courses->step = changed.courses->own = {{1}};
  EXPECT_TRUE(internal::gaps_picture(changed).charts.empty());
  r.search->devices->courses.reset();
  EXPECT_TRUE(internal::gaps_picture(*r.search->devices).charts.empty());
  EXPECT_THAT(page_html(closing_document(r)), Not(HasSubstr("clip-devices-best")));
}

TEST(DevicesReport, LeavesOutMeasuredDevicesWithoutAGain) {
  ClosingRecord r = devices_result();
  DevicesFindings& d = *r.search->devices;
  d.measured.clear();
  EXPECT_THAT(page_html(closing_document(r)), HasSubstr("per-device calibration: Vdp to 1 %"));
  for (DevicesFindings::Row& one : d.rows) {
    if (std::isfinite(one.pull_in_error)) one.bounce_free = d.rows[2].bounce_free, one.at_95 = d.rows[2].at_95;
  }
  d.by_error[1] = {.error = 0.01, .bounce_free = d.by_error[0].bounce_free, .impact_speed = d.by_error[0].impact_speed};
  const std::string page = page_html(closing_document(r));
  EXPECT_THAT(page, Not(HasSubstr("per-device calibration: Vdp to 1 %")));
  EXPECT_THAT(page, Not(HasSubstr("against the error of Vdp")));
  EXPECT_THAT(page, HasSubstr("Per-device calibration does not help"));
}

TEST(DevicesReport, SaysThatTheCurvesAreThoseOfTheNominalDesign) {
  const std::string note = "The curves are those of the nominal design.", heading = "Closing transient of the nominal design";
  EXPECT_THAT(svg_gap_chart(devices_result()), HasSubstr(note));
  EXPECT_THAT(page_html(closing_document(devices_result())), HasSubstr(heading));
  EXPECT_THAT(svg_gap_chart(search_alone()), Not(HasSubstr(note)));
  EXPECT_THAT(page_html(closing_document(search_alone())), Not(HasSubstr(heading)));
}

TEST(DevicesReport, SaysHowManyLandWhereHalfOfThemDo) {
  ClosingRecord r = devices_result();
  r.search->devices->rows[2].bounce_free = 0.77;
  EXPECT_THAT(internal::headline(r).whole(), HasSubstr("77.0 % close bounce-free (plain step 0.0 %), and 95 % touch"));
}

TEST(DevicesReport, SaysInWhichFigureNothingIsAsGoodAsThePlainStep) {
  ClosingRecord r = devices_result();
  r.search->devices->better_than_plain_step = false;
  r.search->devices->worse_in = {"largest_impact_velocity_m_s"};
  r.search->devices->spread_assumed = true;
  const std::string words = internal::headline(r).whole();
  EXPECT_THAT(
      words,
      HasSubstr(
          "(assumed, because the scene has no [spread]: gaps ± 2 %), no waveform that was found is as good as the plain step"));
  EXPECT_THAT(words, HasSubstr("the best one is worse in its largest impact velocity. best.toml is the plain step."));
  const std::string text = terminal_text(closing_document(r));
  EXPECT_THAT(text, HasSubstr("The piezo alone can carry 96.5")) << "best.toml does not do so";
  EXPECT_THAT(text, Not(HasSubstr("is delayed to")));
}

TEST(DevicesReport, ComesBackFromJsonAsItWas) {
  const nlohmann::json written = json_of(devices_result());
  const ClosingRecord read = read_closing(written);
  ASSERT_NE(read.devices(), nullptr);
  EXPECT_EQ(json_of(read), written);
  EXPECT_EQ(read.devices()->nominal_goal_met, true);
  EXPECT_EQ(internal::headline(read).whole(), internal::headline(devices_result()).whole());
  EXPECT_EQ(written["devices"]["rows"][4]["knowledge"]["piezo"], 0.01);
  EXPECT_TRUE(written["devices"]["rows"][3]["knowledge"]["piezo"].is_null()) << "not measured";
  EXPECT_EQ(read.devices()->rows[4].piezo_error, 0.01);
  EXPECT_TRUE(written.at("drawing").at("goal_met"));
  EXPECT_TRUE(written["devices"]["rows"][0]["quantile_95"]["peak_contact_force_N"].is_null()) << "infinite";
  EXPECT_EQ(read_closing(json_of(search_alone())).devices(), nullptr);
}

TEST(DevicesReport, StandsFirstOnThePage) {
  const std::string page = page_html(closing_document(devices_result()));
  const std::size_t table = page.find("id=\"devices\""), figures = page.find("id=\"figures\"");
  ASSERT_NE(table, std::string::npos);
  EXPECT_LT(table, figures);
  EXPECT_THAT(page, HasSubstr("<dt>Largest impact velocity, 95th percentile</dt>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"own\">33.0 (36.3)\u00a0mm/s</td>"));
  EXPECT_THAT(page, HasSubstr("aria-label=\"Bounce-free devices against the error of Vdp"));
  EXPECT_THAT(page_html(closing_document(search_alone())), Not(HasSubstr("id=\"devices\"")));
}

}  // namespace
}  // namespace softland
