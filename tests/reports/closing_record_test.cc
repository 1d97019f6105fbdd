// The report of a result is the same from a study and from the JSON of the study.
#include "reports/closing_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/write_whole.h"
#include "document/svg.h"
#include "document/text.h"
#include "reports/closing_charts.h"
#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "reports/record_file.h"

namespace softland {
namespace {

using nlohmann::json;

const std::string command = "softland test";

SceneFile shipped(const char* name, std::initializer_list<const char*> settings) {
  SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/" + name);
  for (const char* setting : settings) file.set(setting);
  return file;
}

void expect_the_same_reports(const ClosingRecord& made) {
  const json written = json_of(made);
  const ClosingRecord again = read_closing(parse_closing(written.dump(), "result.json"));
  EXPECT_EQ(json_of(again), json::parse(written.dump())) << "a member is written and not read";
  EXPECT_EQ(terminal_text(closing_document(again)), terminal_text(closing_document(made)));
  EXPECT_EQ(page_html(closing_document(again)), page_html(closing_document(made)));
  EXPECT_EQ(svg_gap_chart(again), svg_gap_chart(made));
  EXPECT_EQ(trajectory_csv(again.best.curve), trajectory_csv(made.best.curve));
}

TEST(ResultOf, AClosingIsReportedLikeItsJson) {
  for (const char* name : {"mem-gold.toml", "mem-gold-pzt.toml", "two-electrodes.toml", "purdue-nickel.toml"}) {
    SCOPED_TRACE(name);
    const PreparedScene prepared = prepare(shipped(name, {}));
    expect_the_same_reports(record_of(prepared, simulate(prepared, true), command));
  }
}

TEST(ResultOf, EachOfSeveralContactsHasItsFigures) {
  const PreparedScene prepared = prepare(shipped("new/two-contacts.toml", {}));
  const Closing closing = simulate(prepared, true);
  const ClosingRecord made = record_of(prepared, closing, command);
  expect_the_same_reports(made);
  const json contacts = json_of(made)["contacts"];
  ASSERT_EQ(contacts.size(), 3U);
  const json &left = contacts["left"], &right = contacts["right"], &stop = contacts["stop"];
  EXPECT_LT(left["initial_contact_time_s"], right["initial_contact_time_s"]) << "the right dimple stands lower";
  EXPECT_EQ(left["initial_contact_time_s"], closing.metrics.initial_contact_time) << "the connection touches with its first";
  EXPECT_GT(left["hold_force_N"], right["hold_force_N"]);
  EXPECT_EQ(right["hold_force_N"], closing.metrics.hold_force) << "the connection carries the least of its forces";
  EXPECT_TRUE(stop["initial_contact_time_s"].is_null());
  EXPECT_EQ(stop["gap_m"], 1e-6);
  const std::string page = page_html(closing_document(made));
  for (const char* words :
       {"left, gap 1\u00a0µm", "right, gap 1.002\u00a0µm", "stop, gap 1\u00a0µm", "<th scope=\"col\">Contact</th>"})
    EXPECT_THAT(page, testing::HasSubstr(words));
}

TEST(ResultOf, WithoutItsMotionIsTheSameForProgramsAndTerminals) {
  const PreparedScene prepared = prepare(shipped("mem-gold.toml", {}));
  const Closing closing = simulate(prepared, false);
  const ClosingRecord whole = record_of(prepared, closing, command), quick = record_of(prepared, closing, command, false);
  EXPECT_TRUE(whole.best.curve.motion);
  EXPECT_FALSE(quick.best.curve.motion) << "the closing is not simulated once more";
  EXPECT_EQ(summary_json(json_of(quick)), summary_json(json_of(whole)));
  EXPECT_EQ(terminal_text(closing_document(quick)), terminal_text(closing_document(whole)));
}

TEST(ResultOf, ItsCurvesHoldTheMotionAndWhenTheContactIsClosed) {
  const PreparedScene prepared = prepare(shipped("mem-gold.toml", {}));
  const Closing closing = simulate(prepared, false);
  const json best = json_of(record_of(prepared, closing, command))["curves"]["best"];
  EXPECT_EQ(best["closed"].size(), closing.trajectory.touches.size());
  EXPECT_EQ(best["closed"][0], json({closing.trajectory.touches[0].begin, closing.trajectory.touches[0].end, 1}));
  EXPECT_TRUE(best["closed"].back()[1].is_null()) << "it stays closed";
  EXPECT_EQ(best["motion"]["amplitudes_m"].size(), best["motion"]["shapes"].size());
  EXPECT_FALSE(summary_json(json_of(record_of(prepared, closing, command))).contains("curves"));
}

TEST(ClosedStretches, JoinTouchesBetweenTheShortestOpenings) {
  const std::vector<Touch> touches{{.begin = 1, .end = 2},
                                   {.begin = 2.5, .end = 3},
                                   {.begin = 3.1, .end = 4},
                                   {.begin = 6, .end = 7},
                                   {.begin = 7.2, .end = Metrics::unset}};
  EXPECT_EQ(closed_stretches(touches).size(), 5U);
  const std::vector<ClosedStretch> joined = closed_stretches(touches, 3);
  ASSERT_EQ(joined.size(), 3U);
  EXPECT_EQ(joined[0].touches, 1U);
  EXPECT_EQ(joined[1].begin, 2.5);
  EXPECT_EQ(joined[1].end, 4);
  EXPECT_EQ(joined[1].touches, 2U);
  EXPECT_TRUE(std::isnan(joined[2].end));
}

TEST(ResultOf, AContactThatConductsIsReportedLikeItsJson) {
  const char* const keys[] = {"resistance_ohm", "electrical_contact_time_s", "electrical_settling_time_s",
                              "electrical_bounce_count"};
  const PreparedScene prepared = prepare(
      shipped("mem-gold.toml", {"contact.resistivity=22 nOhm m", "contact.hardness=1 GPa", "metrics.closed_force=0.1 uN"}));
  const ClosingRecord made = record_of(prepared, simulate(prepared, true), command);
  expect_the_same_reports(made);
  const json with = json_of(made);
  const PreparedScene plain = prepare(shipped("mem-gold.toml", {}));
  const ClosingRecord unasked = record_of(plain, simulate(plain, true), command);
  const json without = json_of(unasked);
  for (const char* key : keys) {
    EXPECT_TRUE(with["metrics"].contains(key)) << key;
    EXPECT_TRUE(with["errors"].contains(key)) << key;
    EXPECT_FALSE(without["metrics"].contains(key)) << key;
    EXPECT_FALSE(without["errors"].contains(key)) << key;
  }
  EXPECT_TRUE(with["curves"]["best"].contains("contact_resistance_ohm"));
  EXPECT_FALSE(without["curves"]["best"].contains("contact_resistance_ohm"));
  const std::string csv = trajectory_csv(made.best.curve);
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "time_s,tip_gap_m,tip_velocity_m_s,contact_force_N,contact_resistance_ohm");
  EXPECT_NE(csv.find(",0,\n"), std::string::npos) << "an open contact has no resistance";
  EXPECT_EQ(trajectory_csv(unasked.best.curve).find("ohm"), std::string::npos);
}

TEST(ResultOf, ACertifiedClosingIsReportedLikeItsJson) {
  const PreparedScene prepared = prepare(shipped("mem-gold.toml", {}));
  const ClosingRecord made = record_of(prepared, certify(prepared), command);
  ASSERT_TRUE(made.certificate);
  EXPECT_FALSE(made.certificate->ill_conditioned.empty());
  expect_the_same_reports(made);
}

TEST(ResultOf, AClosingUnderAWaveformThatNoSceneHoldsIsRefusedByItsName) {
  class Mine final : public OwnWaveform {
   public:
    [[nodiscard]] std::string_view name() const override { return "mine"; }
    [[nodiscard]] std::vector<double> breakpoints(std::span<const double>) const override { return {}; }
    [[nodiscard]] double voltage(double, std::span<const double>) const override { return 20; }
  };
  PreparedScene prepared = prepare(shipped("mem-gold.toml", {"simulate.duration=50 us"}));
  prepared.drives.at("main").waveform = own(std::make_shared<Mine>());
  const Closing closing = simulate(prepared, false);
  EXPECT_TRUE(closing.metrics.touched());
  try {
    (void)record_of(prepared, closing, command);
    ADD_FAILURE() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "waveform.main: the own waveform 'mine' cannot be written into a result");
  }
}

TEST(ResultOf, ARunWithoutContactIsReportedLikeItsJson) {
  const auto made = [](const char* change) {
    const PreparedScene prepared = prepare(shipped("mem-gold.toml", {change}));
    return record_of(prepared, simulate(prepared, true), command);
  };
  const ClosingRecord open = made("waveform.main.level=3 V"), late = made("simulate.duration=5 us");
  EXPECT_EQ(open.status, "open");
  expect_the_same_reports(open);
  EXPECT_EQ(late.status, "no_contact");
  expect_the_same_reports(late);
}

TEST(ResultOf, ASearchIsReportedLikeItsJson) {
  const OptimizeOptions options{.target = Target::impact, .max_evaluations = 60};
  ClosingRecord made = record_of(optimize(shipped("mem-gold.toml", {}), options), options, command);
  made.search->course.evaluations = {{0, 2.0}, {1, Metrics::unset}, {2, 1.5}};
  made.search->reproduce = {"softland test", "softland again"};
  EXPECT_TRUE(made.best.figures);
  EXPECT_FALSE(made.search->checks.empty());
  expect_the_same_reports(made);
}

TEST(ResultJson, HasEveryFigureOfTheTableAndNoOther) {
  const PreparedScene prepared = prepare(shipped("mem-gold.toml", {"simulate.duration=60 us"}));
  const json written = json_of(record_of(prepared, simulate(prepared, true), command));
  std::set<std::string> keys, errors;
  for (const Figure& figure : asked_among(all_figures, {})) {
    keys.emplace(figure.key);
    if (!figure.is_yes_or_no()) errors.emplace(figure.key);
  }
  const auto keys_of = [](const json& object) {
    std::set<std::string> all;
    for (const auto& [key, value] : object.items()) all.insert(key);
    return all;
  };
  EXPECT_EQ(keys_of(written["metrics"]), keys);
  EXPECT_EQ(keys_of(written["errors"]), errors);
  keys.insert("status");
  EXPECT_EQ(keys_of(written["best"]["metrics"]), keys);
  EXPECT_TRUE(written["metrics"]["bounce_count"].is_number_integer());
  EXPECT_TRUE(written["metrics"]["settled"].is_boolean());
  EXPECT_TRUE(written["metrics"]["peak_slew_V_s"].is_null()) << "a jump";
}

TEST(TrajectoryCsv, HasOneLinePerRowAndReadsBackExactly) {
  const CurveRecord curve{
      .time = {0, 1.0 / 3.0}, .gap = {2e-6, Metrics::unset}, .velocity = {0.1, 0.2}, .force = {}, .rebounds = {}};
  EXPECT_EQ(trajectory_csv(curve), "time_s,tip_gap_m,tip_velocity_m_s\n0,2e-06,0.1\n0.3333333333333333,,0.2\n");
}

}  // namespace
}  // namespace softland
