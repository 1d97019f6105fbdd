#include "reports/closing_charts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "document/chart_json.h"
#include "reports/closing_record.h"
#include "sample_result.h"

namespace softland::internal {
namespace {

using nlohmann::json;

std::vector<std::string> ids(const Picture& drawn) {
  std::vector<std::string> out;
  for (const Chart& chart : drawn.charts) out.push_back(chart.id);
  return out;
}

std::vector<double> unpacked(const json& column) {
  std::vector<double> out;
  long long sum = 0;
  for (const json& step : column.at("steps")) {
    if (step.is_null()) {
      out.push_back(std::nan(""));
      continue;
    }
    sum += step.get<long long>();
    out.push_back(static_cast<double>(sum) * column.at("unit").get<double>());
  }
  return out;
}

TEST(Charts, FollowTheParts) {
  json result = softland::test::sample_optimize_result(600);
  EXPECT_EQ(ids(picture(read_closing(result))),
            (std::vector<std::string>{"gap", "landing", "drive-0", "drive-1", "velocity", "force", "search"}));
  result.erase("search");
  result["curves"]["best"].erase("contact_force_N");
  result["curves"]["baseline"]["contact_force_N"] = {1, 2, 3};  // not as many values as times
  EXPECT_EQ(ids(picture(read_closing(result))), (std::vector<std::string>{"gap", "landing", "drive-0", "drive-1", "velocity"}));
  EXPECT_TRUE(picture(read_closing(json::object())).charts.empty());
}

TEST(Charts, EnlargeTheLandingAndTheHighestRebound) {
  const Picture drawn = picture(read_closing(softland::test::sample_optimize_result(6000)));
  EXPECT_EQ(drawn.charts[0].x_home[1], 600e-6);
  EXPECT_GT(drawn.charts[1].x_home[1], 60e-6);
  EXPECT_LT(drawn.charts[1].x_home[1], 150e-6);
  json high = softland::test::sample_optimize_result(6000);
  high["best"]["metrics"]["major_bounce_height_m"] = 1e-6;
  const auto range = picture(read_closing(high)).charts.at(1).y_home.value();
  EXPECT_GT(range[1], 1e-6);
  EXPECT_LE(range[0], -0.1 * range[1]) << "the label of the contact plane needs room";
}

TEST(Charts, EnlargeNoLandingWhereThereIsNone) {
  json result = softland::test::sample_simulate_result(600);
  for (json& gap : result["curves"]["best"]["tip_gap_m"]) gap = 1e-6 + std::abs(gap.get<double>());
  for (json& force : result["curves"]["best"]["contact_force_N"]) force = 0;
  EXPECT_EQ(ids(picture(read_closing(result))), (std::vector<std::string>{"gap", "drive-0", "drive-1", "velocity"}));
}

TEST(Charts, ShowNanometresAroundThePlane) {
  json result = softland::test::sample_optimize_result(6000);
  const auto band = [&] { return picture(read_closing(result)).charts.at(1).y_home.value(); };
  const std::vector<double> gaps = result["curves"]["baseline"]["tip_gap_m"];
  const double deepest = *std::min_element(gaps.begin(), gaps.end());
  EXPECT_LT(band()[0], deepest);
  EXPECT_GT(band()[0], 2 * deepest);
  EXPECT_GT(band()[1], -band()[0]);
  EXPECT_LT(band()[1], 200e-9);  // the height of the result, not 803 nm of the plain step
  result["best"]["metrics"]["major_bounce_height_m"] = 300e-9;
  EXPECT_GT(band()[1], 300e-9);
  EXPECT_LT(band()[1], 400e-9);
}

TEST(Charts, WriteNoWordsOnReboundsTooSmallToSee) {
  json result = softland::test::sample_optimize_result(6000);
  result["curves"]["best"]["rebounds"] = {{50e-6, 52e-6, 20e-9, 51e-6}};
  const auto words = [&](std::size_t chart) {
    const Picture drawn = picture(read_closing(result));
    std::string all;
    for (const Mark& mark : drawn.charts.at(chart).marks) all += mark.text;
    return all;
  };
  EXPECT_EQ(words(0), "803\u00a0nm");
  EXPECT_EQ(words(1), "803\u00a0nm20.0\u00a0nm");
}

TEST(Charts, DropRowsWithoutATimeAndTimesThatRunBackwards) {
  const json result{
      {"kind", "simulate"},
      {"curves", {{"best", {{"time_s", {0, 1e-6, nullptr, 0.5e-6, 2e-6}}, {"tip_gap_m", {2e-6, 1e-6, 7, 8, nullptr}}}}}}};
  const CurveTable table = picture(read_closing(result)).tables.at("best");
  EXPECT_EQ(table.at("time_s"), (std::vector<double>{0, 1e-6, 2e-6}));
  EXPECT_EQ(table.at("tip_gap_m")[1], 1e-6);
  EXPECT_TRUE(std::isnan(table.at("tip_gap_m")[2]));
}

TEST(Charts, DrawADriveFromRestToTheEndOfTheWindow) {
  const Picture drawn = picture(read_closing(softland::test::sample_optimize_result(600)));
  const CurveTable& main = drawn.tables.at("best/main");
  EXPECT_EQ(main.at("time_s"), (std::vector<double>{0, 0, 600e-6}));
  EXPECT_EQ(main.at("level"), (std::vector<double>{0, 28.087, 28.087}));
}

TEST(Charts, DrawAForceFactorFromOneWithoutAUnit) {
  json result = softland::test::sample_optimize_result(600);
  for (const char* run : {"best", "baseline"}) result[run]["waveforms"] = {{"dispersion", {{0, 1.25}}}};
  const Picture drawn = picture(read_closing(result));
  EXPECT_EQ(drawn.tables.at("best/dispersion").at("level"), (std::vector<double>{1, 1.25, 1.25}));
  const auto chart =
      std::find_if(drawn.charts.begin(), drawn.charts.end(), [](const Chart& c) { return c.title == "Drive: dispersion"; });
  ASSERT_NE(chart, drawn.charts.end());
  EXPECT_EQ(chart->y_label, "Force factor");
  EXPECT_EQ(chart->y_unit, "");
  EXPECT_EQ(chart->caption, "Force factor of the drive “dispersion”. Both waveforms stay at 1.25.");
}

TEST(Charts, ShowWhenTheContactIsClosedBelowTheGap) {
  json result = softland::test::sample_optimize_result(600);
  result["curves"]["best"]["closed"] = {{44.5e-6, nullptr, 1}};
  result["curves"]["baseline"]["closed"] = {{20e-6, 21e-6, 1}, {30e-6, 40e-6, 7}};
  const Picture drawn = picture(read_closing(result));
  EXPECT_EQ(ids(drawn)[1], "contact");
  const Chart& chart = drawn.charts[1];
  ASSERT_EQ(chart.series.size(), 2U);
  EXPECT_EQ(chart.height, 2 * bar_height);
  EXPECT_NE(chart.caption.find("A pale bar stands for several touches"), std::string::npos);
  const CurveTable& best = drawn.tables.at("closed/best");
  EXPECT_EQ(best.at("time_s"), (std::vector<double>{0, 44.5e-6, 44.5e-6, 600e-6}));
  EXPECT_EQ(best.at("closed"), (std::vector<double>{0, 0, 1, 1}));
  EXPECT_EQ(drawn.tables.at("closed/baseline").at("closed"), (std::vector<double>{0, 0, 1, 1, 0, 0, 0.5, 0.5, 0, 0}));
  const std::string svg = chart_svg(drawn.tables, chart, 960, 0);
  EXPECT_NE(svg.find("stroke-opacity=\"0.45\""), std::string::npos);
  EXPECT_NE(svg.find(">plain step</text>"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Charts, NameEachOfSeveralContacts) {
  json result = softland::test::sample_simulate_result(600);
  result["curves"]["best"]["closed"] = {{30e-6, 40e-6, 1}};
  result["curves"]["best"]["closed_contacts"] = {{"left", {{25e-6, 40e-6, 1}}}, {"right", {{30e-6, 45e-6, 1}}}};
  const Picture drawn = picture(read_closing(result));
  std::vector<std::string> labels;
  for (const Series& one : drawn.charts[1].series) labels.push_back(one.label);
  EXPECT_EQ(labels, (std::vector<std::string>{"connection", "left", "right"}));
}

TEST(Charts, SayWhereTheElectricalStateHasARuleOfItsOwn) {
  json result = softland::test::sample_simulate_result(600);
  result["curves"]["best"]["closed"] = json::array();
  const auto caption = [&] { return picture(read_closing(result)).charts.at(1).caption; };
  EXPECT_EQ(caption().find("electrically"), std::string::npos);
  result["scene"]["metrics"]["closed_force"] = "0.1 uN";
  EXPECT_NE(caption().find("electrically closed, which metrics.closed_force decides"), std::string::npos);
}

TEST(Charts, SurvivePackingToOnePartInTenMillion) {
  const Picture drawn = picture(read_closing(softland::test::sample_optimize_result(5000)));
  const json packed = chart_json(drawn, 6000);
  const std::vector<double>& gap = drawn.tables.at("best").at("tip_gap_m");
  const std::vector<double> back = unpacked(packed.at("tables").at("best").at("tip_gap_m"));
  ASSERT_EQ(back.size(), gap.size());
  constexpr double resolution = 1e-7 * 2e-6;  // over the largest gap; integer steps do not accumulate errors
  for (std::size_t row = 0; row < gap.size(); ++row) ASSERT_LE(std::abs(back[row] - gap[row]), resolution) << row;
}

TEST(Charts, KeepExtremesWhenThinned) {
  const Picture drawn = picture(read_closing(softland::test::sample_optimize_result(20000)));
  const json packed = chart_json(drawn, 6000);
  for (const char* column : {"tip_gap_m", "contact_force_N", "tip_velocity_m_s"}) {
    const std::vector<double>& before = drawn.tables.at("baseline").at(column);
    const std::vector<double> after = unpacked(packed.at("tables").at("baseline").at(column));
    EXPECT_LE(after.size(), 6000u);
    const double top = *std::max_element(before.begin(), before.end());
    const double bottom = *std::min_element(before.begin(), before.end());
    const double resolution = 1e-7 * std::max(std::abs(top), std::abs(bottom));
    EXPECT_NEAR(*std::max_element(after.begin(), after.end()), top, resolution);
    EXPECT_NEAR(*std::min_element(after.begin(), after.end()), bottom, resolution);
  }
}

TEST(Charts, CountEvaluationsWhoseIndicesHaveGaps) {
  const json result{
      {"kind", "optimize"},
      {"search", {{"evaluations", {{0, 4.0}, {3, 2.0}, {90, nullptr}, {100, 3.0}}}, {"best_so_far", {{0, 4.0}, {3, 2.0}}}}}};
  const Picture drawn = picture(read_closing(result));
  EXPECT_EQ(drawn.tables.at("tried").at("evaluation"), (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(drawn.tables.at("search").at("evaluation"), (std::vector<double>{1, 2, 2, 4}));
}

TEST(Charts, OfCostsThatReachZeroAreLinear) {
  json result{{"kind", "optimize"}, {"search", {{"best_so_far", {{1, 3.0}, {9, 0.0}}}}}};
  EXPECT_EQ(picture(read_closing(result)).charts.at(0).scale, AxisScale::linear);
  result["search"]["best_so_far"][1][1] = 0.1;
  EXPECT_EQ(picture(read_closing(result)).charts.at(0).scale, AxisScale::logarithmic);
}

TEST(ChartSvg, SpacesDecadesEvenlyOnALogarithmicAxis) {
  Chart chart{.id = "log"};
  chart.x_scale = chart.scale = AxisScale::logarithmic;
  chart.x_home = {1, 100};
  chart.y_home = {1, 100};
  for (const double x : {2.0, 20.0}) chart.marks.push_back({x, x, Role::fifth, ""});
  const std::string svg = chart_svg({}, chart, 500, 0);
  std::vector<double> at;
  for (auto found = svg.find("cx=\""); found != std::string::npos; found = svg.find("cx=\"", found + 1))
    at.push_back(std::stod(svg.substr(found + 4)));
  ASSERT_EQ(at.size(), 2U);
  // A decade is half of the 404 px between the margins of 78 and 18 px; positions have one decimal.
  EXPECT_NEAR(at[1] - at[0], 202, 0.11);
  for (const char* tick : {">1<", ">10<", ">100<"}) EXPECT_NE(svg.find(tick), std::string::npos) << tick;
  chart.x_home = {0.9, 6};
  EXPECT_NE(chart_svg({}, chart, 500, 0).find(">5<"), std::string::npos) << "less than a decade has its parts as ticks";
  const double plain = chart_svg_height(chart, 440);
  chart.title = "Largest impact velocity by structure.youngs_modulus";  // 8.8 px a letter: wider than a small picture
  EXPECT_NE(chart_svg({}, chart, 440, 0).find(">Largest impact velocity by</text>"), std::string::npos);
  EXPECT_NE(chart_svg({}, chart, 440, 0).find(">structure.youngs_modulus</text>"), std::string::npos);
  EXPECT_GT(chart_svg_height(chart, 440), plain);
  EXPECT_EQ(chart_svg_height(chart, 960), plain);
}

}  // namespace
}  // namespace softland::internal
