// Tests the report of an accuracy study on synthetic numbers.
#include "reports/accuracy_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/xml.h"

namespace softland {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

AccuracyRow row(Integrator integrator, double tolerance, double points, double error, double seconds) {
  AccuracyRow r{.integrator = integrator, .tolerance = tolerance, .points_per_length = points, .modes = 4};
  r.figures.initial_contact_time = 34.257e-6;
  r.figures.impact_velocity = 0.08564;
  r.figures.major_bounce_height = 495.9e-9;
  r.errors = {error / 10, error, error, Metrics::unset};
  r.work = {.steps = 100, .rhs_evaluations = 600, .wall = seconds};
  r.seconds = seconds;
  r.runs = 7;
  return r;
}

// The peak force is missing, and B_H is ill-conditioned.
AccuracyStudy sample() {
  AccuracyStudy s;
  s.status = Status::done;
  s.reference = row(all_integrators[0], 1e-8, 48, 0, 1e-2);
  s.resolution = {1e-12, 1e-11, 1e-10, Metrics::unset};
  for (const double points : {24.0, 8.0}) {
    s.rows.push_back(row(all_integrators[0], 1e-3, points, 1e-3, 1.5e-4));
    s.rows.push_back(row(all_integrators[0], 1e-4, points, 1e-5, 3e-4));
  }
  s.rows.push_back(row(all_integrators[1], 1e-3, 24, 1e-4, 0.23));
  s.rows.push_back({.integrator = all_integrators[1], .tolerance = 1e-4, .points_per_length = 24, .missing = "cut after 2 s"});
  s.through.push_back(row(all_integrators[0], 1e-3, 24, 2e-3, 1.6e-4));
  s.through.push_back(row(all_integrators[0], 1e-4, 24, 2e-5, 4e-4));
  for (AccuracyRow& r : s.through) r.restart = false;
  s.modes.push_back(row(all_integrators[0], 1e-4, 24, 1e-2, 1e-3));
  s.modes.back().modes = 5;
  s.conditioned = {true, true, false, false};
  s.cloud[0] = {.low = 34.2e-6, .median = 34.2e-6, .high = 34.2e-6, .runs = 8};
  s.cloud[2] = {.low = 400e-9, .median = 480e-9, .high = 600e-9, .runs = 8};
  s.bounce_count = {.low = 44, .median = 54, .high = 60, .runs = 8};
  s.recommendations = {{.accuracy = 1e-3, .row = 2}, {.accuracy = 1e-9, .row = {}}};
  return s;
}

const PreparedScene& gold() {
  static const PreparedScene scene = prepare(SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml"));
  return scene;
}

AccuracyRecord record(const AccuracyStudy& study, const PreparedScene& scene = gold(), const char* command = "") {
  return {.origin = whole_origin_of("accuracy", scene, command), .found = study};
}

std::string accuracy_text(const AccuracyStudy& study) { return terminal_text(document_of(record(study))); }

TEST(AccuracyText, RecommendsAndListsEverySetting) {
  const std::string text = accuracy_text(sample());
  const std::string own(to_string(all_integrators[0]));
  EXPECT_THAT(text, ContainsRegex("\n1e-3 +" + own + " +1e-3 +8 +150\u00a0µs\n"));
  EXPECT_THAT(text, ContainsRegex("\n1e-9 +no setting that was tried\n"));
  EXPECT_THAT(text, HasSubstr("1e-4  cut after 2 s\n"));
  EXPECT_THAT(text, ContainsRegex("1e-6 +1e-5 +1e-5 +— +600 +300\u00a0µs\n"));
  EXPECT_THAT(text, HasSubstr("a reference run (" + own + ", tolerance 1e-8, 48 points per length, 4 modes):"));
  EXPECT_THAT(text, HasSubstr("t_i 34.26\u00a0µs (< 1e-9)"));
}

TEST(AccuracyText, ShowsIllConditionedFiguresAsClouds) {
  const std::string text = accuracy_text(sample());
  EXPECT_THAT(text, ContainsRegex("B_H +400.0\u00a0nm +480.0\u00a0nm +600.0\u00a0nm +8  ill-conditioned\n"));
  EXPECT_THAT(text, ContainsRegex("N_B +44 +54 +60 +8  ill-conditioned\n"));
  EXPECT_THAT(text, ContainsRegex("t_p +— +— +— +0\n"));
  EXPECT_THAT(text, HasSubstr("Ill-conditioned figures are left out: B_H.\n"));
  AccuracyStudy none = sample();
  none.conditioned = {};
  EXPECT_THAT(accuracy_text(none), HasSubstr("No figure is well-conditioned here"));
}

TEST(AccuracyText, ListsWhatWasTriedWithoutARestartOrWhyNothingWas) {
  const std::string own(to_string(all_integrators[0]));
  EXPECT_THAT(accuracy_text(sample()), ContainsRegex("it there.\n\nIntegrator +Tolerance [^\n]+\n" + own +
                                                     " +1e-3 +2e-4 +2e-3 +2e-3 +— +600 +160\u00a0µs\n"));
  AccuracyStudy none = sample();
  none.through.clear();
  none.why_always_restarted = "there is no contact";
  EXPECT_THAT(accuracy_text(none), HasSubstr("without a restart at the contact: there is no contact.\n\n"));
  EXPECT_THAT(svg_of(record(none)), Not(HasSubstr("no restart")));
}

TEST(AccuracyText, OfAPlateSaysThatPointsDoNotMatterAndListsNone) {
  AccuracyStudy plate = sample();
  std::erase_if(plate.rows, [](const AccuracyRow& r) { return r.points_per_length != 24; });
  for (AccuracyRow& r : plate.rows) r.points_per_length.reset();
  plate.reference.points_per_length.reset();
  plate.reference.modes = 1;
  plate.modes.clear();
  plate.recommendations = {{.accuracy = 1e-3, .row = 0}};
  const PreparedScene prepared = prepare(SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/two-electrodes.toml"));
  const AccuracyRecord of_plate = record(plate, prepared);
  const std::string page = page_html(document_of(of_plate)), text = accuracy_text(plate), svg = svg_of(of_plate);
  EXPECT_THAT(text, HasSubstr("tolerance 1e-8, 1 mode): "));
  for (const std::string& shown : {page, text, svg}) {
    EXPECT_THAT(shown, Not(HasSubstr("per length")));
    EXPECT_THAT(shown, Not(HasSubstr("Points per")));
  }
  for (const std::string& shown : {page, text}) EXPECT_THAT(shown, HasSubstr("A rigid plate has the same gap"));
  EXPECT_TRUE(json_of(of_plate)["rows"][0]["points_per_length"].is_null());
}

TEST(AccuracyText, SaysWhenTheReferenceIsLooserThanPlanned) {
  AccuracyStudy study = sample();
  study.message = "too slow";
  EXPECT_THAT(accuracy_text(study), HasSubstr("\nThe reference: too slow.\n"));
}

TEST(AccuracyText, OfNoStudySaysWhy) {
  AccuracyStudy none;
  none.status = Status::no_contact;
  EXPECT_THAT(accuracy_text(none), HasSubstr("does not touch within the window"));
  none.status = Status::numerical_failure;
  none.message = "cut after 20 s";
  EXPECT_THAT(accuracy_text(none), HasSubstr("no reference to compare with: cut after 20 s"));
}

TEST(AccuracyPage, HoldsRecommendationsDiagramsTablesAndClouds) {
  const std::string own(to_string(all_integrators[0]));
  AccuracyStudy study = sample();
  study.rows.back().missing = "cut <early>";
  AccuracyRecord asked = record(study, gold(), "softland accuracy 'a & b.toml'");
  asked.origin.scene["simulate"]["accuracy"] = 1e-8;
  const std::string page = page_html(document_of(asked));
  EXPECT_THAT(page, HasSubstr("<h1>No setting that was tried has t_i and v_i within 1e-9.<"))
      << "nearest to the accuracy that the scene asks for";
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">1e-3</th><td>" + own + "</td><td>1e-3</td><td>8</td><td>150\u00a0µs</td>"));
  EXPECT_THAT(page, HasSubstr("id=\"figure-work-precision\""));
  EXPECT_THAT(page, HasSubstr("id=\"figure-contact\""));
  EXPECT_THAT(page, HasSubstr("cut &lt;early&gt;"));
  EXPECT_THAT(page, HasSubstr("B<sub>H</sub></th><td>400.0\u00a0nm</td><td>480.0\u00a0nm</td><td>600.0\u00a0nm</td><td>8</td>"));
  EXPECT_THAT(page, HasSubstr("softland accuracy &#39;a &amp; b.toml&#39;"));
  EXPECT_THAT(page, HasSubstr("data-chart=\"work-precision\""));
  EXPECT_THAT(page, HasSubstr("\"scale\":\"log\""));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
  EXPECT_THAT(page, Not(HasSubstr("{{")));
  asked.found.recommendations.pop_back();
  EXPECT_THAT(page_html(document_of(asked)), HasSubstr("<h1>A closing with t_i and v_i within 1e-3 takes 150\u00a0µs<"));
  asked.found.conditioned = {};
  EXPECT_THAT(page_html(document_of(asked)), HasSubstr("<h1>No figure is well-conditioned here"));
}

// A title of the page's text size, with some 7 px for a letter, fits into the width of a chart.
TEST(AccuracyPicture, HasTitlesThatFitIntoThePage) {
  AccuracyStudy study = sample();
  study.conditioned.fill(true);
  const std::string svg = svg_of(record(study));
  constexpr std::size_t widest = 75;
  for (const char* title : {"Largest relative error of ", "Largest relative error, with and without ", "Quadrature: "}) {
    const std::size_t begin = svg.find(title);
    ASSERT_NE(begin, std::string::npos) << title;
    EXPECT_LT(svg.find('<', begin) - begin, widest);
  }
}

TEST(AccuracyPicture, IsWellFormedAndHasACurveForWhateverHasErrors) {
  AccuracyRecord named = record(sample());
  named.origin.scene["title"] = "Gold & more";
  const std::string svg = svg_of(named);
  EXPECT_EQ(softland::test::xml_fault(svg), "");
  EXPECT_THAT(svg, HasSubstr("Gold &amp; more: accuracy against computing time"));
  EXPECT_THAT(svg, HasSubstr("Largest relative error of t_i and v_i"));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_THAT(svg, HasSubstr(">" + std::string(to_string(all_integrators[i])) + "<"));
  EXPECT_THAT(svg, Not(HasSubstr(">" + std::string(to_string(all_integrators[2])) + "<")));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, HasSubstr(">" + std::string(to_string(all_integrators[0])) + ", no restart<"));
  EXPECT_THAT(svg, HasSubstr(">1e-4</text>")) << "the tolerances along the curve of the own integrator";
  AccuracyStudy none = sample();
  none.conditioned = {};
  EXPECT_EQ(softland::test::xml_fault(svg_of(record(none))), "");
}

}  // namespace
}  // namespace softland
