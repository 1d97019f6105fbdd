// Tests the report of varied devices on synthetic outcomes.
#include "reports/robustness_report.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include "document/text.h"
#include "reports/robustness_prose.h"
#include "reports/robustness_sections.h"
#include "studies/closing/auto_settings.h"

namespace softland::robustness_report_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Study {
  PreparedScene nominal;
  RobustnessOptions options;
  Robustness found;
  Sensitivity sensitivity;
  Derivatives derivatives;
  std::vector<DeviceCourse> courses;
  std::optional<BoxAndChaos> box_and_chaos;

  [[nodiscard]] RobustnessReport report() const {
    return {.nominal = nominal,
            .found = found,
            .options = options,
            .command = "softland robustness 'a & b.toml'",
            .sensitivity = sensitivity,
            .derivatives = derivatives,
            .courses = courses,
            .box_and_chaos = box_and_chaos};
  }
};

const Study& study() {
  static const Study made = [] {
    SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml");
    for (const char* set : {"waveform.main.level=17.771 V", "waveform.main.rise_time=20 us", "driver.main.max_voltage=25 V",
                            "simulate.duration=100 us", "structure.modes=2"})
      file.set(set);
    Study s{.nominal = prepare(file), .options = {.samples = 64, .jobs = 2, .worth_of_measuring = true}, .found = {}};
    s.found = robustness(s.nominal,
                         {{.name = "<slow>, \"mine\"",
                           .waveforms = s.nominal.drives.waveforms(),
                           .calibration = {.pull_in_error = 0.01, .frequency_error = 0.0}}},
                         s.options);
    s.sensitivity = sensitivity(s.nominal, s.found.drives.back(), 32, s.options);
    s.derivatives = derivatives(s.nominal, internal::exactly_measured(s.nominal, s.found.drives.back()));
    s.courses = device_courses(s.nominal, s.found.drives.back(), s.found, s.options);
    s.box_and_chaos = box_and_chaos(s.nominal, s.found.drives.back(), s.options, {.closings_per_search = 10, .most_fitted = 40});
    return s;
  }();
  return made;
}

TEST(Quantile, ShowsADashForABoundThatFewDevicesDoNotGive) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const auto text = [](double low, double high) {
    return internal::quantile_text({.value = 37.4e-6, .interval = {low, high}}, "s");
  };
  EXPECT_EQ(text(36.7e-6, 38e-6), "37.4\u00a0µs (36.7 to 38)");
  EXPECT_EQ(text(36.7e-6, infinite), "37.4\u00a0µs (36.7 to —)");
  EXPECT_EQ(text(-infinite, infinite), "37.4\u00a0µs (—)");
}

TEST(RobustnessReport, OfATerminalHasEveryDriveAndWhatMeasuringIsWorth_optimized) {
  const std::string text = terminal_text(robustness_document(study().report()));
  for (const char* words :
       {"64 devices under process variation (sobol points): gap.electrode and gap.contact ± 2.0 % (normal)", "plain step",
        "<slow>, \"mine\"", "Measured on every device", "\nnothing ", "\nVdp and frequency, 8 classes ", "\nVdp and frequency ",
        "\nVdp ± 1.0 %, frequency exactly ", "Share of the variance ", "\nTo first order", " %/%, ", "\nstructure.thickness ",
        "Cross-checks, under <slow>, \"mine\"", "\nWorst in the box: found by search ", "\nWorst B_H ",
        "± 2.39 standard deviations"})
    EXPECT_THAT(text, HasSubstr(words));
  RobustnessReport bare = study().report();
  bare.sensitivity = {};
  bare.box_and_chaos = {};
  bare.derivatives = {};
  EXPECT_THAT(terminal_text(robustness_document(bare)), Not(HasSubstr("Share of the variance")));
  EXPECT_THAT(terminal_text(robustness_document(bare)), Not(HasSubstr("Cross-checks")));
  EXPECT_THAT(terminal_text(robustness_document(bare)), Not(HasSubstr("first order")));
}

TEST(RobustnessReport, AsJsonHoldsWhatTheStudyFound_optimized) {
  const nlohmann::json j = json_of(record_of(study().report()));
  EXPECT_EQ(j["kind"], "robustness");
  EXPECT_EQ(j["devices"], 64);
  ASSERT_EQ(j["drives"].size(), 2U);
  ASSERT_EQ(j["by_knowledge"].size(), 7U);
  EXPECT_EQ(j["by_knowledge"][4]["calibration"]["classes"], 8);
  ASSERT_EQ(j["by_knowledge"][4]["classes"].size(), 8U);
  EXPECT_EQ(j["by_knowledge"][4]["classes"][2]["volts_factor"], study().found.by_knowledge[4].known.classes()[2].centre.volts);
  EXPECT_TRUE(j["by_knowledge"][6]["calibration"]["classes"].is_null());
  EXPECT_TRUE(j["drives"][0]["calibration"]["Vdp_error"].is_null());
  EXPECT_EQ(j["drives"][1]["calibration"]["Vdp_error"], 0.01);
  const auto& index = study().sensitivity.figures[1].estimate.indices->total[0];
  EXPECT_EQ(j["sensitivity"]["figures"]["largest_impact_velocity_m_s"]["variables"]["gaps"]["total"]["value"], index.value);
  const FigureDerivatives& touch = study().derivatives.figures[0];
  const nlohmann::json& derived = j["derivatives"]["figures"]["initial_contact_time_s"];
  EXPECT_EQ(derived["by"]["gaps"]["derivative"], touch.by_variable[0]);
  EXPECT_EQ(derived["by"]["gaps"]["relative"], touch.by_variable[0] / touch.value);
  EXPECT_EQ(derived["by"]["gaps"]["per_standard_deviation"], touch.by_variable[0] * 0.02);
  EXPECT_EQ(derived["standard_deviation"], touch.deviation);
  EXPECT_EQ(j["derivatives"]["grazes"], study().derivatives.grazes());
  for (const DriveRobustness& d : study().found.drives) EXPECT_EQ(d.outcomes.size(), 64U);
  const BoxAndChaos& ways = study().box_and_chaos.value();
  const nlohmann::json& box = j["other_ways"]["box"];
  EXPECT_EQ(box["closings"], ways.closings);
  EXPECT_EQ(box["figures"]["major_bounce_height_m"]["most"]["value"], ways.ranges[2].most.figure);
  EXPECT_EQ(box["figures"]["initial_contact_time_s"]["least"]["values"]["gaps"], ways.ranges[0].least.values[0]);
  EXPECT_EQ(j["other_ways"]["polynomial_chaos"]["largest_impact_velocity_m_s"]["q2_other_devices"], ways.chaos[1].q2_unseen);
}

TEST(RobustnessReport, SaysWhereChaosFails_optimized) {
  RobustnessReport report = study().report();
  BoxAndChaos ways = study().box_and_chaos.value();
  ways.left_out = 3;
  ways.chaos[0].q2_unseen = 0.95;
  ways.chaos[1].q2 = 0.99;  // the error on the other devices is larger
  ways.chaos[1].q2_unseen = 0.4;
  ways.chaos[2].q2 = ways.chaos[2].q2_unseen = Metrics::unset;
  ways.ranges[2].most.figure = std::numeric_limits<double>::infinity();
  report.box_and_chaos = ways;
  std::string text = terminal_text(robustness_document(report));
  std::replace(text.begin(), text.end(), '\n', ' ');
  EXPECT_THAT(text, HasSubstr("3 of them do not close; its mean, standard deviation and percentile treat"));
  EXPECT_THAT(text, HasSubstr("It predicts t_i of those that close"));
  EXPECT_THAT(text, HasSubstr("It fails for v_max (60.0 % of the variance): "));
  EXPECT_THAT(text, HasSubstr("It cannot describe B_H"));
  EXPECT_THAT(text, HasSubstr("∞"));
  const std::string page = page_html(robustness_document(report));
  EXPECT_THAT(page, HasSubstr("It fails for v<sub>max</sub> (60.0"));
  EXPECT_TRUE(json_of(record_of(report))["other_ways"]["box"]["figures"]["major_bounce_height_m"]["most"]["value"].is_null());
}

TEST(RobustnessReport, AsCsvHasALinePerDevice_optimized) {
  std::istringstream in(robustness_csv(study().report()));
  std::string line;
  std::getline(in, line);
  EXPECT_THAT(line, HasSubstr("device,gaps,structure.thickness,structure.youngs_modulus,plain step: status,"));
  EXPECT_THAT(line, HasSubstr("\"<slow>, \"\"mine\"\": status\"")) << "names may hold commas and quotes";
  int lines = 0;
  while (std::getline(in, line)) ++lines;
  EXPECT_EQ(lines, 64);
}

TEST(RobustnessReport, ShowsOfJitterTheTimeOfAnEdge_optimized) {
  SceneFile file = study().nominal.scene.file;
  file.set(R"(spread={"driver.main.jitter"={distribution="uniform", half_width="50 ns"}})");
  Study jittered{.nominal = prepare(file), .options = {.samples = 64}, .found = {}};
  jittered.found = robustness(jittered.nominal, {}, jittered.options);
  EXPECT_THAT(terminal_text(robustness_document(jittered.report())), HasSubstr("The voltage sources have the errors"));
  EXPECT_THAT(terminal_text(robustness_document(jittered.report())),
              HasSubstr("driver.main.jitter within ± 50.0\u00a0ns (uniform)"));
  for (const bool err : {false, true}) {
    const bool said =
        page_html(robustness_document((err ? jittered : study()).report())).find("The voltage sources have the errors") <
        std::string::npos;
    EXPECT_EQ(said, err);
  }
  std::istringstream in(robustness_csv(jittered.report()));
  std::string line;
  std::getline(in, line);
  std::set<double> times;
  while (std::getline(in, line)) times.insert(std::stod(line.substr(line.find(',') + 1)));
  EXPECT_EQ(times.size(), 64U);
  for (const double time : times) EXPECT_LT(std::abs(time), 50e-9);
  EXPECT_GT(*times.rbegin() - *times.begin(), 70e-9);
  // The waveform of a device with jitter is shifted by the time in the report.
  const std::size_t k = jittered.found.drives[0].worst[0];
  const double shown = json_of(record_of(jittered.report()))["drives"][0]["worst"][0]["values"]["driver.main.jitter"];
  EXPECT_TRUE(times.contains(shown));
  const SceneFile own = scene_of_device(jittered.nominal, jittered.found.drives[0], k, jittered.options);
  const Signal drive = prepare(own).signals().front();
  EXPECT_EQ(drive.pieces().back().begin, std::max(0.0, shown));
  // The devices of a box have random numbers, from which their times follow.
  BoxAndChaos ways;
  ways.ranges.push_back({.key = "major_bounce_height_m", .most = {.values = {0.75}}});
  const auto found = internal::record_of(ways, jittered.found.drives[0], jittered.nominal);
  const double in_box = found.ranges[0].most.values.at("driver.main.jitter");
  EXPECT_LT(std::abs(in_box), 50e-9);
}

// Reports say in words where derivatives graze, which figures have none, and what is left out.
TEST(RobustnessReport, SaysWhatItsDerivativesAreWorth_optimized) {
  Derivatives told = study().derivatives;
  told.grazing = 0.03;
  told.figures[2].by_variable.clear();
  told.figures[2].why_none = "ill-conditioned: so & so";
  told.variables[1].why_none = "no device beside it";
  for (FigureDerivatives& figure : told.figures) {
    if (figure.is_known()) figure.by_variable[1] = std::numeric_limits<double>::quiet_NaN();
  }
  RobustnessReport report = study().report();
  report.derivatives = told;
  const std::string text = terminal_text(robustness_document(report)), page = page_html(robustness_document(report));
  const nlohmann::json j = json_of(record_of(report))["derivatives"];
  EXPECT_THAT(text, HasSubstr("To first order (grazing)"));
  EXPECT_THAT(text, HasSubstr("Standard deviation of the devices"));
  EXPECT_THAT(page, HasSubstr("has 3.0 % of the impact velocity"));
  EXPECT_THAT(page, HasSubstr("ill-conditioned: so &amp; so"));
  EXPECT_THAT(page, HasSubstr("structure.thickness is left out: no device beside it."));
  EXPECT_EQ(j["grazes"], true);
  EXPECT_EQ(j["figures"]["major_bounce_height_m"]["why_none"], "ill-conditioned: so & so");
  EXPECT_TRUE(j["figures"]["initial_contact_time_s"]["by"]["structure.thickness"]["derivative"].is_null());
  told.figures.clear();
  told.why_none = "there is no gas";
  report.derivatives = told;
  EXPECT_THAT(terminal_text(robustness_document(report)), HasSubstr("The figures have no derivatives here: there is no gas."));
  EXPECT_THAT(page_html(robustness_document(report)), HasSubstr("The figures have no derivatives here: there is no gas."));
  EXPECT_EQ(json_of(record_of(report))["derivatives"]["why_none"], "there is no gas");
}

TEST(RobustnessReport, AsAPageHasEverySectionAndEscapesNames) {
  const std::string page = page_html(robustness_document(study().report()));
  for (const char* id :
       {"charts", "knowledge", "figures", "scatter", "sensitivity", "derivatives", "ways", "worst", "reproduce", "scene"})
    EXPECT_THAT(page, HasSubstr(std::string("<section id=\"") + id + "\">")) << id;
  EXPECT_THAT(page, Not(HasSubstr("<slow>")));
  EXPECT_THAT(page, HasSubstr("&lt;slow&gt;, &quot;mine&quot;"));
  EXPECT_THAT(page, HasSubstr("softland robustness &#39;a &amp; b.toml&#39;"));
  EXPECT_THAT(page, HasSubstr("data-chart=\"share-v-max\""));
  EXPECT_THAT(page, HasSubstr("data-chart=\"courses\""));
  for (const SpreadVariable& v : study().report().nominal.scene.spread.variables)
    EXPECT_THAT(page, HasSubstr("aria-label=\"Highest rebound by " + v.name));
  EXPECT_LT(page.size(), 1'000'000U);
}

// Returns the heights of the bins that the script of the page draws: two equal values for each bin.
std::vector<double> bins_of(const std::string& page, const std::string& table) {
  const std::string mark = "id=\"data\">";
  const std::size_t begin = page.find(mark) + mark.size();
  const nlohmann::json y = nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin))["tables"][table]["y"];
  double sum = 0;
  std::vector<double> knots = y.value("values", std::vector<double>());  // a logarithmic axis has plain values
  for (const auto& step : y.value("steps", nlohmann::json::array()))
    knots.push_back((sum += step.get<double>()) * y["unit"].get<double>());
  std::vector<double> bins;
  for (std::size_t k = 1; k + 1 < knots.size(); k += 2) {
    EXPECT_EQ(knots[k], knots[k + 1]);
    bins.push_back(knots[k]);
  }
  EXPECT_EQ(knots.front(), 0);
  EXPECT_EQ(knots.back(), 0);
  return bins;
}

TEST(RobustnessReport, HasHistogramsOfAllDevicesInView_optimized) {
  const std::string page = page_html(robustness_document(study().report()));
  double in_view = 0;
  for (const DriveRobustness& d : study().found.drives) {
    std::vector<double> heights;
    for (const DeviceOutcome& o : d.outcomes) heights.push_back(o.metrics.major_bounce_height);
    std::sort(heights.begin(), heights.end());
    in_view = std::max(in_view, heights[64 * 99 / 100]);
  }
  std::size_t bins = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::vector<double> heights = bins_of(page, "count-B-H-" + std::to_string(i));
    double all = 0;
    for (const double height : heights) all += height;
    double expected = 0;
    for (const DeviceOutcome& o : study().found.drives[i].outcomes)
      expected += o.metrics.major_bounce_height <= in_view ? 100.0 / 64 : 0;
    constexpr double stored_to = 1e-4;
    EXPECT_NEAR(all, expected, stored_to) << i;
    EXPECT_GT(heights.size(), 3U);
    EXPECT_TRUE(i == 0 || heights.size() == bins) << "all drives share the bins";
    bins = heights.size();
  }
  for (const char* id : {"count-v-max", "count-t-i"}) EXPECT_THAT(page, HasSubstr(fmt::format("data-chart=\"{}\"", id)));
}

TEST(RobustnessReport, DrawsHistogramsOfVeryDifferentSetsOnALogarithmicAxis_optimized) {
  Study soft = study();
  for (DeviceOutcome& o : soft.found.drives.back().outcomes) o.metrics.largest_impact_velocity *= 0.01;
  soft.found.drives.back().outcomes.front().metrics.largest_impact_velocity = 0;  // has no logarithm
  const internal::Picture drawn = robustness_document(soft.report()).draw();
  const auto chart = std::ranges::find(drawn.charts, "count-v-max", &internal::Chart::id);
  ASSERT_NE(chart, drawn.charts.end());
  EXPECT_EQ(chart->x_scale, internal::AxisScale::logarithmic);
  EXPECT_THAT(chart->caption, HasSubstr("The first also has all smaller values."));
  for (const char* set : {"count-v-max-0", "count-v-max-1"}) {
    const std::vector<double>&edges = drawn.tables.at(set).at("x"), &shares = drawn.tables.at(set).at("y");
    EXPECT_GT(std::ranges::count_if(shares, [](double share) { return share > 0; }), 2 * 3) << set << " has several bars";
    EXPECT_NEAR(edges.front(), chart->x_home[0], 1e-9 * edges.front());
    EXPECT_NEAR(edges[4] / edges[3], edges[2] / edges[1], 1e-9) << "bins are equal on the axis";
  }
}

TEST(RobustnessReport, LeavesOutSobolIndicesOfFewDevices_optimized) {
  RobustnessReport report = study().report();
  report.sensitivity = {};
  add_details(report, false, {});
  const std::string why = "with fewer than 128 devices";
  EXPECT_THAT(terminal_text(robustness_document(report)), HasSubstr("There are no Sobol' indices: " + why));
  EXPECT_THAT(terminal_text(robustness_document(report)), Not(HasSubstr("Share of the variance")));
  EXPECT_THAT(json_of(record_of(report))["sensitivity"]["why_none"].get<std::string>(), HasSubstr(why));
}

TEST(RobustnessReport, ShowsThePlainStepAloneAndDevicesThatDoNotClose_optimized) {
  Study bare{.nominal = study().nominal, .options = {.samples = 8}, .found = study().found};
  bare.found.drives.resize(1);
  bare.found.by_knowledge.clear();
  DriveRobustness& step = bare.found.drives[0];
  step.outcomes.resize(8);
  step.worst = {3};
  step.outcomes[3] = {.metrics = {}, .failure = "gap.contact must be <less>"};
  bare.found.devices = 8;
  const std::string page = page_html(robustness_document(bare.report()));
  EXPECT_THAT(page, HasSubstr("gap.contact must be &lt;less&gt;"));
  EXPECT_THAT(page, HasSubstr("Under the plain step"));
  EXPECT_THAT(page, Not(HasSubstr("id=\"knowledge\"")));
  EXPECT_EQ(json_of(record_of(bare.report()))["drives"][0]["failures"]["gap.contact must be <less>"], 1);
}

TEST(RobustnessReport, LeavesOutAFigureThatNoDeviceHas_optimized) {
  Study rigid{.nominal = study().nominal, .options = study().options, .found = study().found};
  const std::string name = "Peak contact force";
  EXPECT_THAT(terminal_text(robustness_document(rigid.report())), HasSubstr(name));
  for (DriveRobustness& drive : rigid.found.drives) {
    drive.figures[&Metrics::peak_contact_force] = {};
  }
  EXPECT_THAT(terminal_text(robustness_document(rigid.report())), Not(HasSubstr(name)));
  EXPECT_THAT(page_html(robustness_document(rigid.report())), Not(HasSubstr(name)));
  for (DriveRobustness& drive : rigid.found.drives) drive.closing.devices = 0;
  EXPECT_THAT(terminal_text(robustness_document(rigid.report())), HasSubstr(name)) << "where none closes nothing is known";
}

TEST(Sensitivity, SaysWhereFirstContactComesFrom_optimized) {
  const Sensitivity& found = study().sensitivity;
  ASSERT_EQ(found.figures.size(), 3U);
  ASSERT_TRUE(found.figures[0].estimate.indices);
  EXPECT_EQ(found.variables, (std::vector<std::string>{"gaps", "structure.thickness", "structure.youngs_modulus"}));
  double sum = 0;
  for (const SobolIndex& index : found.figures[0].estimate.indices->first_order) sum += index.value;
  EXPECT_NEAR(sum, 1, 0.15) << "the time of first contact is nearly a sum";
}

TEST(DeviceCourses, AreThoseOfTheQuantilesOfTheHighestRebound_optimized) {
  ASSERT_EQ(study().courses.size(), 3U);
  const std::vector<DeviceOutcome>& outcomes = study().found.drives.back().outcomes;
  double before = -1;
  for (const DeviceCourse& course : study().courses) {
    const double height = outcomes[course.device].metrics.major_bounce_height;
    EXPECT_GE(height, before);
    before = height;
    int lower = 0;
    for (const DeviceOutcome& o : outcomes) lower += o.metrics.major_bounce_height < height;
    EXPECT_NEAR(lower, course.probability * 64, 1.5);
    EXPECT_NEAR(metrics(course.trajectory, study().nominal.scene.metrics).major_bounce_height, height, 1e-4 * height)
        << "the same closing, but alone";
  }
}

TEST(RobustnessReport, FitsOnATerminalWithManyDrivesOfLongNames) {
  Study s = study();
  for (int k = 0; k < 9; ++k) {
    s.found.drives.push_back(s.found.drives.back());
    s.found.drives.back().name = std::string(60, 'x') + "/of_run_" + std::to_string(k);
  }
  std::istringstream lines(terminal_text(robustness_document(s.report())));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(internal::display_width(line), 150U) << line;
  for (int k = 0; k < 9; ++k)
    EXPECT_THAT(terminal_text(robustness_document(s.report())), HasSubstr("/of_run_" + std::to_string(k)));
}

// An estimated index may lie outside of [0, 1] by chance.
TEST(RobustnessReport, SharesAreNeverBeyondAll) {
  Study s = study();
  for (FigureSensitivity& f : s.sensitivity.figures) {
    f.estimate.indices->total[0] = {.value = 1.1, .interval = {.low = 0.9, .high = 1.3}};
    f.estimate.indices->first_order[0] = {.value = -0.02, .interval = {.low = -0.1, .high = 0.05}};
  }
  EXPECT_THAT(terminal_text(robustness_document(s.report())),
              ::testing::ContainsRegex("\ngaps +0 % \\(0 to 5\\) +100 % \\(90 to 100\\) "));
  EXPECT_THAT(terminal_text(robustness_document(s.report())), Not(HasSubstr("110 %")));
  EXPECT_THAT(page_html(robustness_document(s.report())), HasSubstr("100 % (90 to 100)"));
  for (FigureChaos& c : s.box_and_chaos->chaos) c.q2 = c.q2_unseen = -0.5;
  EXPECT_THAT(terminal_text(robustness_document(s.report())), Not(HasSubstr("150 %")));
}

TEST(RobustnessReport, SaysWhatIsMissingForShares) {
  Study s = study();
  for (FigureSensitivity& f : s.sensitivity.figures) f.estimate = {.rows = 256, .failed_rows = 12};
  const std::string words = "no indices: 12 of the 256 rows of devices hold one";
  EXPECT_THAT(page_html(robustness_document(s.report())), HasSubstr(words));
  EXPECT_THAT(terminal_text(robustness_document(s.report())), HasSubstr("t_i: " + words));
  EXPECT_THAT(terminal_text(robustness_document(s.report())), Not(HasSubstr("too many"))) << "all devices of the sample close";
}

// First-order derivatives are not shown if the spread of the devices contradicts them.
TEST(RobustnessReport, ShowsNoDerivativesThatTheDevicesContradict) {
  Study s = study();
  EXPECT_THAT(terminal_text(robustness_document(s.report())), HasSubstr(" %/%"));
  for (FigureDerivatives& f : s.derivatives.figures) f.deviation *= 100;
  EXPECT_THAT(terminal_text(robustness_document(s.report())), Not(HasSubstr(" %/%")));
  EXPECT_THAT(page_html(robustness_document(s.report())), Not(HasSubstr(" %/%")));
  EXPECT_THAT(terminal_text(robustness_document(s.report())), HasSubstr("are not shown"));
  EXPECT_FALSE(json_of(record_of(s.report()))["derivatives"]["figures"]["initial_contact_time_s"]["agrees_with_devices"]);
}

}  // namespace
}  // namespace softland::robustness_report_test
