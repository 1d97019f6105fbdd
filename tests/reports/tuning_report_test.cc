#include "reports/tuning_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "base/require.h"
#include "reports/tuning_lines.h"
#include "tests/reports/browser.h"

namespace softland {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const PreparedScene& tuned_scene() {
  static const PreparedScene prepared = [] {
    SceneFile scene = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml");
    scene.set("waveform.main.level=17 V");
    scene.set("driver.main.max_voltage=21 V");
    scene.set("title=A <b>switch</b>");
    return prepare(scene);
  }();
  return prepared;
}

TuningReport::Shot tuned_shot(int number, double low = 36e-6, double high = 42e-6) {
  const TunerShot shot{.number = number,
                       .waveforms = {Pulse{.levels = {18, 1, 17.0 + 0.01 * number}, .times = {28e-6, 37e-6}, .edge = 0.5e-6}},
                       .hold_time = 2e-4,
                       .expected_cost = 0.1,
                       .predicted = {.touches = 1,
                                     .touch_median = (low + high) / 2,
                                     .touch_low = low,
                                     .touch_high = high,
                                     .bounces = 0.05,
                                     .rebound_median = 0,
                                     .rebound_high = 0.7e-9}};
  return shot_of(tuned_scene(), shot);
}

// A bounce, a failed shot, a shot that stayed open, one with times only, and two landings.
TuningReport tuned_sample() {
  const std::vector<ContactRecord> records{
      {.edges = {{40e-6, true}, {41e-6, false}, {44e-6, true}, {44.5e-6, false}, {46e-6, true}}},
      {.error = "no <i>trigger</i>"},
      {},
      {.closing_time = 39e-6, .bounce_count = 2},
      {.edges = {{38.5e-6, true}}},
      {.closing_time = 38.6e-6, .bounce_count = 0}};
  TuningReport report{.origin = whole_origin_of("tune", tuned_scene(), "softland tune <s>"),
                      .next = tuned_shot(7, 38e-6, 39e-6),
                      .kept = tuned_shot(5, 38e-6, 39e-6)};
  for (const ContactRecord& record : records)
    report.closings.push_back({.shot = tuned_shot(static_cast<int>(report.closings.size()) + 1), .record = record});
  const NormalBelief one_coordinate{.mean = Eigen::VectorXd::Constant(1, 0.5), .covariance = Eigen::MatrixXd::Identity(1, 1)};
  report.belief = {.quantities = {{"gaps", "", 1, 0.02, 1.013, 0.004}, {"trigger delay", "s", 0, 1e-7, -2e-8, 4e-8}},
                   .effective_devices = 21,
                   .correlated = {"The records do not tell gaps from thickness."},
                   .coordinates = {.prior = one_coordinate, .posterior = one_coordinate}};
  report.broken_assumption = "The device is not like its scene: <u>two records</u> were not what was expected.";
  report.step_closing_time = 34e-6;
  report.bounce_free_in_a_row = 2;
  return report;
}

TEST(TuningReport, HoldsEveryClosingInItsJson) {
  const json j = json_of(tuned_sample());
  EXPECT_EQ(j["kind"], "tune");
  EXPECT_EQ(j["status"], "under_way");
  ASSERT_EQ(j["closings"].size(), 6U);
  const std::vector<bool> bounce_free{false, false, false, false, true, true};
  for (std::size_t i = 0; i < bounce_free.size(); ++i) {
    const json& one = j["closings"][i];
    EXPECT_EQ(one["shot"], i + 1);
    EXPECT_EQ(one["bounce_free"], bounce_free[i]) << i;
    EXPECT_EQ(one["record"], record_json(static_cast<int>(i) + 1, tuned_sample().closings[i].record));
    EXPECT_EQ(one["waveforms"]["main"].back(), json({37.5e-6, 17.0 + 0.01 * static_cast<double>(i + 1)}));
  }
  EXPECT_EQ(j["best"]["shot"], 5);
  EXPECT_EQ(j["best"]["bounce_free"], true);
  EXPECT_EQ(j["belief"]["quantities"][0]["deviation"], 0.004);
  EXPECT_EQ(j["broken_assumption"], *tuned_sample().broken_assumption);
  EXPECT_EQ(j["scene"]["structure"]["kind"], "cantilever");
}

TEST(TuningReport, IsTheSameFromItsJson) {
  const TuningReport report = tuned_sample(), again = read_tuning(json::parse(json_of(report).dump()));
  EXPECT_EQ(terminal_text(tuning_document(again)), terminal_text(tuning_document(report)));
  EXPECT_EQ(page_html(tuning_document(again)), page_html(tuning_document(report)));
  for (const char* key : {"best", "belief", "closings", "seed"}) {
    json damaged = json_of(report);
    damaged.erase(key);
    EXPECT_THROW((void)read_tuning(damaged), InvalidInput) << key;
  }
  json other = json_of(report);
  other["next"]["waveforms"] = json::object();
  EXPECT_THROW((void)read_tuning(other), InvalidInput);
}

TEST(TuningReport, ComparesASlowApproachWithThePlainStep) {
  TuningReport report = tuned_sample();
  EXPECT_EQ(json_of(report)["approach"], "catch");
  EXPECT_THAT(terminal_text(tuning_document(report)), testing::Not(testing::HasSubstr("bounces until")));
  report.approach = Approach::quasi_static;
  report.step_permanent_contact = 442e-6;
  EXPECT_EQ(json_of(report)["step_permanent_contact_time_s"], 442e-6);
  EXPECT_THAT(terminal_text(tuning_document(report)), testing::HasSubstr("bounces until 442"));
}

TEST(TuningReport, SaysInWordsWhatWasSeenAndWhatIsExpected) {
  EXPECT_EQ(closing_prose(tuned_sample()),
            "closing 6 touched at 38.60\u00a0µs without a bounce; prediction for the next: touch at 38.00 to 39.00\u00a0µs, 95th "
            "percentile of the rebound 700\u00a0pm");
  const std::string text = terminal_text(tuning_document(tuned_sample()));
  for (const char* words : {"After 5 closings the switch closes bounce-free", "stayed open", "no record", "not like its scene"})
    EXPECT_THAT(text, HasSubstr(words));
  TuningReport bounced = tuned_sample();
  bounced.closings.resize(1);
  bounced.bounce_free_in_a_row = 0;
  EXPECT_THAT(terminal_text(tuning_document(bounced)), HasSubstr("After one closing none was bounce-free."));
  EXPECT_THAT(closing_prose(bounced), HasSubstr("touched at 40.00\u00a0µs with 2 bounces"));
  bounced.next.predicted.touch_low = bounced.next.predicted.rebound_high = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(closing_prose(bounced), HasSubstr("prediction for the next: touch at —, rebounds unknown"));
}

TEST(TuningReport, SaysHowLateRecordsBegin) {
  TuningReport report = tuned_sample();
  EXPECT_THAT(page_html(tuning_document(report)), Not(HasSubstr("The records begin")));
  report.belief.quantities.back() = {trigger_delay_name, "s", 0, 2e-6, 0.95e-6, 0.12e-6};
  const std::string words =
      "The records begin 950\u00a0ns after the drives, with a standard error of 120\u00a0ns: the trigger is late.";
  EXPECT_THAT(page_html(tuning_document(report)), HasSubstr(words));
  EXPECT_THAT(terminal_text(tuning_document(report)), HasSubstr("The records begin 950"));
  report.belief.quantities.back().mean = -0.95e-6;
  EXPECT_THAT(page_html(tuning_document(report)), HasSubstr("before the drives"));
}

TEST(TuningReport, LandsWhereTheLastClosingWasOfTheWaveformKept) {
  TuningReport report = tuned_sample();
  EXPECT_FALSE(report.ended_bounce_free()) << "shot 5 is kept, and 6 was the last";
  report.kept = tuned_shot(6);
  EXPECT_TRUE(report.ended_bounce_free());
  EXPECT_EQ(json_of(report)["best"]["landed_last"], true);
  report.closings.back().record.bounce_count = 1;
  EXPECT_FALSE(report.ended_bounce_free());
  report.closings.pop_back();
  report.closings.push_back({.shot = tuned_shot(6), .record = {.error = "no trigger"}});
  report.kept = tuned_shot(5);
  EXPECT_TRUE(report.ended_bounce_free()) << "a shot without a record is no closing";
}

TEST(TuningReport, PutsOnlyTextIntoItsPage) {
  const std::string page = page_html(tuning_document(tuned_sample()));
  for (const char* tag : {"<b>", "<i>", "<u>", "<s>"}) EXPECT_THAT(page, Not(HasSubstr(tag)));
  for (const char* part :
       {"id=\"records\"", "id=\"belief\"", "id=\"waveforms\"", "id=\"reproduce\"", "best so far", "proposed next"})
    EXPECT_THAT(page, HasSubstr(part));
  // The first record has three closed intervals, drawn below the prediction.
  const std::size_t first = page.find("aria-label=\"closing 1 touched");
  const std::string strip = page.substr(first, page.find("</svg>", first) - first);
  std::size_t seen = 0;
  for (std::size_t at = strip.find("class=\"seen\""); at != std::string::npos; at = strip.find("class=\"seen\"", at + 1)) ++seen;
  EXPECT_EQ(seen, 3U);
  EXPECT_THAT(strip, HasSubstr("class=\"expected\""));
}

TEST(TuningReport, IsAPageBeforeItsFirstClosing) {
  TuningReport fresh = tuned_sample();
  fresh.closings.clear();
  fresh.bounce_free_in_a_row = 0;
  fresh.kept = fresh.next;
  EXPECT_THAT(page_html(tuning_document(fresh)), HasSubstr("No closing yet."));
}

using TuningPage = test::PageInBrowser;

TEST_F(TuningPage, FitsNarrowAndWideScreens_browser) {
  const std::string page = page_html(tuning_document(tuned_sample()));
  for (const int width : {420, 1400}) {
    const std::string said =
        test::said(test::in_frame(program, page, width,
                                  "say(page.documentElement.scrollWidth <= " + std::to_string(width) +
                                      "); say([...page.querySelectorAll('.strip')].every((one) => one.clientWidth > 100));"));
    EXPECT_EQ(said, "true;true;end;") << width;
  }
}

}  // namespace
}  // namespace softland
