#include "reports/exploration_report.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/require.h"
#include "browser.h"
#include "reports/exploration_page.h"
#include "sample_exploration.h"
#include "sampling/statistics.h"
#include "tests/support/xml.h"

namespace softland {
namespace {

using test::in_frame;
using test::PageInBrowser;
using test::said;
using test::sample_cloud;
using test::sample_grid;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t most_bytes = 2'000'000;

/// Returns whether the page holds the words. EXPECT_THAT would print the whole page.
bool holds(const std::string& page, const std::string& words) { return page.find(words) != std::string::npos; }

std::string aims_refusal(const std::string& list) {
  try {
    static_cast<void>(explored_aims(sample_grid(3, 3).columns, list));
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "accepted";
}

TEST(ExploredAims, GoByKeyByKeyWithoutUnitAndByName) {
  const auto aims = explored_aims(sample_grid(3, 3).columns, "impact_velocity,max:initial_contact_time_s,Rebounds");
  ASSERT_EQ(aims.size(), 3u);
  EXPECT_EQ(aims[0].column, 6u);
  EXPECT_EQ(aims[1].column, 2u);
  EXPECT_EQ(aims[2].column, 4u);
  EXPECT_FALSE(aims[0].is_largest);
  EXPECT_TRUE(aims[1].is_largest);
}

TEST(ExploredAims, AreRefusedWithTheFiguresThereAre) {
  EXPECT_THAT(aims_refusal("impact_velocity,weight"),
              HasSubstr("pareto impact_velocity,weight: \"weight\" is not among the figures: "
                        "initial_contact_time_s, "));
  EXPECT_THAT(aims_refusal("impact_velocity,structure_length"), HasSubstr("not among the figures")) << "it is a variable";
  EXPECT_THAT(aims_refusal("impact_velocity,"), HasSubstr("not among the figures"));
  EXPECT_THAT(aims_refusal("impact_velocity,Impact velocity"), HasSubstr("twice"));
  EXPECT_THAT(aims_refusal("impact_velocity"), HasSubstr("at least two"));
}

TEST(ExploredFront, HoldsOnlyPointsThatSettleAndHaveFigures) {
  ExplorationReport report{.columns = {{"a", "a", "", false}, {"b", "b", "", false}}};
  report.points = {{7, "done", "", {1, 3}},      {8, "no_contact", "", {0, 0}},       {9, "done", "", {3, 1}},
                   {10, "done", "", {1.5, 1.5}}, {11, "not_settled", "", {0.5, 0.5}}, {12, "done", "", {Metrics::unset, 0}}};
  report.aims = explored_aims(report.columns, "a,b");
  const ExploredFront front = explored_front(report);
  EXPECT_THAT(front.members, ElementsAre(0, 3, 2));
  EXPECT_EQ(front.knee, 3u);
  EXPECT_THAT(front.reference, ElementsAre(3, 3));
  EXPECT_DOUBLE_EQ(front.hypervolume, 1.5 * 1.5);
  EXPECT_DOUBLE_EQ(front.share, 1.5 * 1.5 / 4);

  report.aims[1].is_largest = true;
  EXPECT_THAT(explored_front(report).members, ElementsAre(0)) << "small a and large b";
  report.points.clear();
  EXPECT_TRUE(explored_front(report).members.empty());
}

TEST(ExploredGrid, IsFoundWhateverTheOrderOfThePoints) {
  ExplorationReport report = sample_grid(7, 5);
  std::reverse(report.points.begin(), report.points.end());
  report.points.erase(report.points.begin() + 3);
  const auto grid = internal::grid_of(report);
  ASSERT_TRUE(grid);
  EXPECT_THAT(grid->variables, ElementsAre(0, 1));
  EXPECT_EQ(grid->values[0].size(), 7u);
  EXPECT_EQ(std::count(grid->points.begin(), grid->points.end(), internal::ExploredGrid::nothing), 1);
  const internal::HeatMap map = internal::heat_map_of(report, *grid, 0, 1, 6);
  for (const ExploredPoint& point : report.points) {
    const auto place = grid->place(point);
    const double there = map.values[place[1] * 7 + place[0]];
    EXPECT_TRUE(there == point.values[6] || (std::isnan(there) && std::isnan(point.values[6])));
  }
  EXPECT_FALSE(internal::grid_of(sample_cloud(100)));
  report.points.push_back(report.points.front());
  EXPECT_FALSE(internal::grid_of(report)) << "a combination twice";
}

TEST(Effects, AreQuantilesOfAllPointsAtAValue) {
  const ExplorationReport report = sample_grid(9, 40);
  const auto bins = internal::effect_of(report, 0, 6);
  ASSERT_EQ(bins.size(), 9u);
  for (const internal::EffectBin& bin : bins) {
    std::vector<double> values;
    for (const ExploredPoint& point : report.points) {
      if (point.values[0] == bin.at && std::isfinite(point.values[6])) values.push_back(point.values[6]);
    }
    EXPECT_EQ(bin.points, values.size());
    EXPECT_EQ(bin.quantiles[2], sample_quantile(values, 0.5));
    EXPECT_EQ(bin.quantiles[4], sample_quantile(values, 0.95));
  }
}

TEST(Effects, OfManyValuesAreThoseOfIntervalsOfEquallyManyPoints) {
  const ExplorationReport report = sample_cloud(2400);
  std::size_t points = 0;
  const auto bins = internal::effect_of(report, 0, 9);
  ASSERT_EQ(bins.size(), 24u);
  for (const internal::EffectBin& bin : bins) {
    EXPECT_NEAR(static_cast<double>(bin.points), 100, 1);
    points += bin.points;
  }
  EXPECT_EQ(points, 2400u);
  EXPECT_TRUE(std::is_sorted(bins.begin(), bins.end(), [](const auto& a, const auto& b) { return a.at < b.at; }));
}

/// Returns the value of a column at a drawn point, decoded as the page does.
double decoded(const nlohmann::json& column, std::size_t row) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::string& text = column["data"].get_ref<const std::string&>();
  const auto steps = 64 * letters.find(text[2 * row]) + letters.find(text[2 * row + 1]);
  if (steps == 4095) return Metrics::unset;
  const double value = column["low"].get<double>() + static_cast<double>(steps) * column["step"].get<double>();
  return column["log"].get<bool>() ? std::exp(value) : value;
}

TEST(ExplorationPage, HoldsValuesToAFourThousandthOfTheirRange) {
  const ExplorationReport report = sample_cloud(3000);
  const auto data = internal::exploration_data(report, std::nullopt, explored_front(report));
  EXPECT_EQ(data.thinning, "");
  ASSERT_EQ(data.json["rows"], 3000);
  for (std::size_t c = 0; c < report.columns.size(); ++c) {
    const nlohmann::json& column = data.json["columns"][c];
    const bool logarithmic = column["log"];
    EXPECT_EQ(logarithmic, c == 7) << "the impact energy spans decades";
    for (std::size_t k = 0; k < 3000; k += 7) {
      const double value = report.points[k].values[c], shown = decoded(column, k);
      if (std::isnan(value)) {
        EXPECT_TRUE(std::isnan(shown));
      } else if (c == 8) {
        EXPECT_EQ(shown, value) << "a count is exact";
      } else {
        const double step = column["step"].get<double>() * (logarithmic ? value : 1);
        EXPECT_NEAR(shown, value, 0.51 * step) << c;
      }
    }
  }
}

TEST(ExplorationPage, IsBelowTwoMegabytesWhateverTheNumberOfPoints_optimized) {
  const std::string grid = page_html(exploration_document(sample_grid(200, 200)));
  EXPECT_LT(grid.size(), most_bytes);
  EXPECT_FALSE(holds(grid, "points are drawn")) << "all of 40 000 points fit";
  const std::string large = page_html(exploration_document(sample_grid(400, 500)));
  EXPECT_LT(large.size(), most_bytes);
  EXPECT_THAT(large, HasSubstr("50000 of 200000 points are drawn: one in 2 of the 400 values of structure.length, one in 2 of "
                               "the 500 values of gap.contact. Counts and effects include"));
  const std::string cloud = page_html(exploration_document(sample_cloud(100'000)));
  EXPECT_LT(cloud.size(), most_bytes);
  EXPECT_TRUE(holds(cloud, "of 100000 points are drawn: chosen at random, each with the same probability, and the front."));
}

TEST(ExplorationPage, KeepsEveryPointOfTheFrontWhenItThins_optimized) {
  const ExplorationReport report = sample_cloud(100'000);
  const ExploredFront front = explored_front(report);
  const auto data = internal::exploration_data(report, std::nullopt, front);
  ASSERT_EQ(data.json["front"].size(), front.members.size());
  std::vector<std::int64_t> numbers;
  std::int64_t sum = 0;
  for (const auto& step : data.json["numbers"]) numbers.push_back(sum += step.get<std::int64_t>());
  for (std::size_t k = 0; k < front.members.size(); ++k)
    EXPECT_EQ(numbers[data.json["front"][k].get<std::size_t>()], report.points[front.members[k]].number);
  EXPECT_EQ(data.json["waveforms"].size(), front.members.size());
}

TEST(ExplorationPage, IsWhole) {
  const std::string page = page_html(exploration_document(sample_cloud(500)));
  for (const char* part : {"id=\"front\"", "id=\"parallel\"", "id=\"matrix\"", "id=\"effects\"", "id=\"outcomes\""})
    EXPECT_TRUE(holds(page, part));
  EXPECT_FALSE(holds(page, "id=\"map\""));
  EXPECT_FALSE(holds(page, "http://"));
  EXPECT_FALSE(holds(page, "https://"));
  EXPECT_TRUE(holds(page_html(exploration_document(sample_grid(30, 20))), "<svg class=\"still\""));
}

TEST(ExplorationPage, BearsNoPointsAndOneAndNoneThatIsDone) {
  ExplorationReport report = sample_cloud(40);
  for (ExploredPoint& point : report.points) {
    point.status = "numerical_failure";
    std::fill(point.values.begin() + 5, point.values.end(), Metrics::unset);
  }
  EXPECT_TRUE(holds(page_html(exploration_document(report)), "No point settles and has all the figures of the Pareto front."));
  report.points.resize(1);
  EXPECT_FALSE(page_html(exploration_document(report)).empty());
  report.points.clear();
  EXPECT_FALSE(page_html(exploration_document(report)).empty());
  EXPECT_FALSE(terminal_text(exploration_document(report)).empty());
  EXPECT_TRUE(exploration_json(report)["pareto"]["knee"].is_null());
}

TEST(ExplorationPage, EscapesWhatComesFromOutside) {
  ExplorationReport report = sample_grid(5, 5);
  const std::string hostile = "</script><script>document.body.className='owned'</script>";
  report.title = report.study = report.command = report.plan = report.made_with = hostile;
  for (ExploredColumn& c : report.columns) c.name = hostile;
  for (ExploredPoint& p : report.points) p.status = p.reason = hostile;
  EXPECT_FALSE(holds(page_html(exploration_document(report)), hostile));
  EXPECT_EQ(test::xml_fault(exploration_map_svg(report, 0, 1, 6)), "");
}

TEST(ExplorationText, TellsTheFrontWithItsKnee) {
  const std::string text = terminal_text(exploration_document(sample_cloud(400)));
  EXPECT_THAT(text, HasSubstr("400 points over structure.thickness, gap.electrode, "));
  EXPECT_THAT(text, HasSubstr("Pareto front: "));
  EXPECT_THAT(text, HasSubstr("hypervolume "));
  EXPECT_THAT(text, HasSubstr("* is the knee"));
}

TEST(ExplorationJson, HoldsTheFrontAndHowPointsEnded) {
  const ExplorationReport report = sample_cloud(400);
  const nlohmann::json j = exploration_json(report);
  EXPECT_EQ(j["points"], 400);
  EXPECT_EQ(j["by_status"]["done"].get<int>() + j["by_status"]["no_contact"].get<int>(), 400);
  const ExploredFront front = explored_front(report);
  EXPECT_EQ(j["pareto"]["front"].size(), front.members.size());
  EXPECT_EQ(j["pareto"]["hypervolume"].get<double>(), front.hypervolume);
  EXPECT_EQ(j["pareto"]["aims"][1]["figure"], "impact_velocity_m_s");
  EXPECT_EQ(j["pareto"]["front"][0]["values"]["peak_voltage_V"].get<double>(), report.points[front.members[0]].values[9]);
}

TEST(ExplorationMap, IsAPictureOfItsOwn) {
  const std::string svg = exploration_map_svg(sample_grid(60, 40), 0, 1, 6);
  EXPECT_EQ(test::xml_fault(svg), "");
  EXPECT_THAT(svg, HasSubstr("Impact velocity over structure.length and gap.contact"));
  EXPECT_THROW(static_cast<void>(exploration_map_svg(sample_cloud(50), 0, 1, 6)), InvalidInput);
}

TEST_F(PageInBrowser, DrawsAnExplorationInSilence_browser) {
  for (const ExplorationReport& report : {sample_grid(40, 30), sample_cloud(2000), sample_cloud(3)}) {
    const test::Visit seen = test::visit(program, page_html(exploration_document(report)));
    EXPECT_EQ(seen.console, "");
    EXPECT_THAT(seen.dom, HasSubstr("class=\"drawn\""));
    EXPECT_THAT(seen.dom, HasSubstr("<canvas"));
  }
}

TEST_F(PageInBrowser, CutsNothingOfAnExplorationOnANarrowScreen_browser) {
  for (const int width : {360, 420, 1280}) {
    const std::string dom =
        in_frame(program, page_html(exploration_document(width == 420 ? sample_grid(40, 30) : sample_cloud(2000))), width,
                 "for (const one of page.querySelectorAll('html, main, .scroll, .keys, figure, .part, canvas')) if "
                 "(one.scrollWidth > one.clientWidth + 1) say(one.className || one.tagName);");
    EXPECT_EQ(said(dom), "end;") << width;
  }
}

TEST_F(PageInBrowser, ReadsAnExplorationWithTheKeysAlone_browser) {
  const std::string press =
      "const press = (id, key) => page.querySelector(`#${id} canvas`).dispatchEvent(new "
      "frame.contentWindow.KeyboardEvent('keydown', {key}));";
  const std::string map = in_frame(program, page_html(exploration_document(sample_grid(21, 11))), 900,
                                   press + "press('map', 'ArrowRight'); say(page.querySelector('#map .readout').textContent);");
  EXPECT_THAT(said(map), HasSubstr("Point 126: structure.length 255.0"));
  const std::string front =
      in_frame(program, page_html(exploration_document(sample_cloud(2000))), 900,
               press +
                   "press('front', 'Home'); const first = page.querySelector('#front .readout').textContent; "
                   "press('front', 'ArrowRight'); say(first !== page.querySelector('#front "
                   ".readout').textContent); press('parallel', 'ArrowUp'); "
                   "say(page.querySelector('#parallel .readout').textContent);");
  EXPECT_THAT(said(front), HasSubstr("true;Limits: structure.thickness from 1.55"));
}

TEST(ExplorationMap, OfAMillionPointsStaysBelowTwoMegabytes) {
  ExplorationReport report = sample_grid(1000, 1000);
  EXPECT_LT(exploration_map_svg(report, 0, 1, 6).size(), most_bytes);
  EXPECT_LT(exploration_map_svg(report, 1, 0, 4).size(), most_bytes) << "a figure that jumps from cell to cell";
}

TEST(ExplorationPage, IsMadeOfAnyFigures) {
  const double largest = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  for (const auto& [low, high] : std::vector<std::array<double, 2>>{{1.8e-6, std::nextafter(1.8e-6, 1)},
                                                                    {-1.7e308, 1.7e308},
                                                                    {-largest, largest},
                                                                    {0, least},
                                                                    {least, largest},
                                                                    {7, 7},
                                                                    {-std::numeric_limits<double>::infinity(), 1}}) {
    ExplorationReport report = sample_grid(7, 5);
    for (ExploredPoint& point : report.points) point.values[6] = point.number % 2 == 0 ? low : high;
    report.aims = explored_aims(report.columns, "impact_velocity,initial_contact_time");
    EXPECT_LT(page_html(exploration_document(report)).size(), most_bytes) << low << " " << high;
    EXPECT_FALSE(terminal_text(exploration_document(report)).empty());
    EXPECT_TRUE(holds(exploration_map_svg(report, 0, 1, 6), "</svg>"));
    for (ExploredPoint& point : report.points)
      point.values[0] = std::isfinite(low) ? std::lerp(low, high, static_cast<double>(point.number / 5) / 6) : 1;
    EXPECT_LT(page_html(exploration_document(report)).size(), most_bytes) << "over " << low << " " << high;
  }
}

}  // namespace
}  // namespace softland
