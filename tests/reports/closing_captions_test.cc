#include "reports/closing_captions.h"

#include <gtest/gtest.h>

#include "reports/closing_prose.h"
#include "reports/closing_record.h"
#include "sample_result.h"
#include "studies/closing/hold.h"

namespace softland::internal {
namespace {

using nlohmann::json;
using softland::test::sample_optimize_result;
using softland::test::sample_simulate_result;

constexpr std::size_t few_rows = 601;

/// Replaces no-break spaces by plain ones, so that expected texts are readable.
std::string plain(std::string words) {
  constexpr std::string_view no_break = "\u00a0";
  for (std::size_t at = 0; (at = words.find(no_break, at)) != std::string::npos;) words.replace(at, no_break.size(), " ");
  return words;
}

std::string sentence(const json& result) { return plain(headline(read_closing(result)).whole()); }

TEST(Headline, OfASoftLandingNamesBothClosings) {
  json result = sample_optimize_result(few_rows);
  result["checks"].erase(1);
  EXPECT_EQ(sentence(result),
            "Softland's waveform closes the switch bounce-free at 44.5 µs; with the plain step it first touches at 23.2 µs, then "
            "bounces about 57 times up to 803 nm and settles after about 374 µs.");
}

TEST(Headline, SaysWhenTheGoalWasNotMet) {
  json result = sample_optimize_result(few_rows);
  result["goal_met"] = false;
  json& metrics = result["best"]["metrics"];
  metrics["bounce_count"] = 1;
  metrics["major_bounce_height_m"] = 12.3e-9;
  metrics["permanent_contact_time_s"] = 61e-6;
  result["errors"] = nullptr;
  EXPECT_EQ(sentence(result),
            "The goal was not met. With softland's waveform the switch first touches at 44.5 µs, then bounces once up to 12.3 nm "
            "and settles after 61.0 µs; with the plain step it "
            "first touches at 23.2 µs, then bounces about 57 times up to 803 nm and settles after about 374 µs.");
}

TEST(Headline, SaysWhenNothingTouches) {
  json result = sample_optimize_result(few_rows);
  result["goal_met"] = false;
  result["checks"].erase(1);
  result["baseline"]["metrics"] = {
      {"initial_contact_time_s", nullptr}, {"permanent_contact_time_s", nullptr}, {"bounce_count", nullptr}, {"settled", false}};
  EXPECT_EQ(sentence(result),
            "The goal was not met. Softland's waveform closes the switch bounce-free at 44.5 µs; the plain step does not "
            "close it within 600 µs.");
  json single = sample_simulate_result(few_rows);
  single["status"] = "no_contact";
  single["metrics"] = {{"initial_contact_time_s", nullptr}, {"settled", false}};
  EXPECT_EQ(sentence(single), "The switch does not close within 600 µs.");
}

TEST(Headline, SaysWhenASwitchHasNotSettled) {
  json result = sample_simulate_result(few_rows);
  result["status"] = "not_settled";
  result["metrics"]["settled"] = false;
  result["metrics"]["permanent_contact_time_s"] = nullptr;
  result["errors"] = nullptr;
  EXPECT_EQ(
      sentence(result),
      "The switch first touches at 23.2 µs, then bounces about 57 times up to 803 nm and has not settled when the window ends at "
      "600 µs (later bounces are not counted).");
  result["warnings"] = {not_held};
  EXPECT_EQ(sentence(result),
            "The switch first touches at 23.2 µs, then bounces about 57 times up to 803 nm and does not stay closed: its hold "
            "voltage is below the release voltage.");
}

TEST(Headline, QuotesIllConditionedFiguresWithAbout) {
  EXPECT_EQ(sentence(sample_simulate_result(few_rows)),
            "The switch first touches at 23.2 µs, then bounces about 57 times up to 803 nm and settles after about 370 µs.");
}

TEST(Headline, NamesTheReboundsThatAreTooSmallToCount) {
  json result = sample_optimize_result(few_rows);
  result["best"]["metrics"]["major_bounce_height_m"] = 0.42e-9;
  EXPECT_EQ(plain(headline(read_closing(result)).main),
            "Softland's waveform closes the switch bounce-free at 44.5 µs (highest rebound 420 pm)");
}

TEST(Headline, SaysWhyThereIsNoClosing) {
  EXPECT_EQ(sentence({{"kind", "simulate"}, {"status", "collapsed_at_rest"}}),
            "The switch has no stable equilibrium to start from at the voltages before t = 0 (an open one, unless before_state "
            "asks for a closed one).");
  EXPECT_EQ(sentence({{"kind", "simulate"},
                      {"status", "collapsed_onto_electrode"},
                      {"metrics", {{"initial_contact_time_s", nullptr}, {"settled", false}}}}),
            "The switch collapses onto an electrode before it touches its contact.");
  EXPECT_EQ(sentence({{"kind", "simulate"}, {"status", "collapsed_onto_electrode"}}),
            "The switch collapses onto the electrode, past its contact.");
  EXPECT_EQ(sentence({{"kind", "simulate"}, {"status", "numerical_failure"}}), "The switch could not be simulated to the end.");
  EXPECT_EQ(sentence({{"kind", "simulate"}}), "There are no figures for the switch.");
  json result = sample_optimize_result(few_rows);
  result["best"] = nullptr;
  result["metrics"] = nullptr;
  result["goal_met"] = false;
  result["baseline"]["metrics"]["bounce_count"] = 0;
  result["baseline"]["metrics"]["major_bounce_height_m"] = 0;
  EXPECT_EQ(sentence(result),
            "The goal was not met. No feasible waveform was found; the plain step closes it bounce-free at 23.2 µs.");
}

TEST(Headline, OfAnInterruptedSearchIsAboutItsBestSoFar) {
  json result = sample_optimize_result(few_rows);
  result["status"] = "interrupted";
  EXPECT_TRUE(sentence(result).starts_with(
      "The search was interrupted; this is its best so far. Softland's waveform closes the switch bounce-free at 44.5 µs"))
      << sentence(result);
}

TEST(Captions, StateWhatTheNumbersSay) {
  const json result = sample_optimize_result(few_rows);
  EXPECT_EQ(
      plain(gap_caption(read_closing(result))),
      "Distance of the contact point from the contact plane (positive: open); dots mark rebounds above 1 nm. With the plain "
      "step the switch bounces about 57 times, up to 803 nm, until about 374 µs; with softland's waveform the switch lands "
      "at 44.5 µs with an impact velocity of 900 µm/s and stays closed.");
  EXPECT_EQ(plain(landing_caption(read_closing(result))),
            "The same gap, enlarged around the contact plane; below the plane the contact is compressed. With the plain step the "
            "switch reaches the plane at 133 mm/s and rebounds by up to 803 nm; with softland's waveform the switch reaches the "
            "plane at 900 µm/s and does not rebound.");
  EXPECT_EQ(plain(velocity_caption(read_closing(result))),
            "Velocity of the contact point, positive towards the contact. The impact velocity is 133 mm/s under the plain step "
            "and 900 µm/s under softland's waveform (148 times lower).");
  EXPECT_EQ(
      plain(force_caption(read_closing(result))),
      "Force of the contact on the beam. Its peak is 290 µN under the plain step and 2.70 µN under softland's waveform (107 "
      "times lower). Closed and at rest, the contact carries 2.10 µN.");
  EXPECT_EQ(plain(waveform_caption(read_closing(result), "piezo")),
            "Voltage of the drive “piezo”. Softland's waveform runs between 0 mV and 603 mV, with a slew rate of at most 121 "
            "mV/µs; the plain step "
            "stays at 0 V.");
  EXPECT_EQ(plain(waveform_caption(read_closing(result), "main")), "Voltage of the drive “main”. Both waveforms stay at 28.1 V.");
  EXPECT_EQ(plain(checks_caption(*read_closing(result).search)),
            "Not confirmed: simulated again with a tolerance of 1e-9 and with 6 modes, the switch is not bounce-free in 1 of 2 "
            "re-runs; at worst it rebounds by up to 3.20 nm after an impact velocity of 2.30 mm/s (modes 6).");
  EXPECT_FALSE(checks_agree(read_closing(result)));
}

TEST(Captions, OfWhatConfirmsAWinnerTellGasLawsFromModes) {
  json result = sample_optimize_result(few_rows);
  const json clean = result["checks"][0]["metrics"], bounces = result["checks"][1]["metrics"];
  result["checks"] = {{{"name", "tolerance 1e-9"}, {"metrics", clean}},
                      {{"name", "modes 6"}, {"metrics", clean}},
                      {{"name", "modes 8"}, {"metrics", clean}},
                      {{"name", "modes 10"}, {"metrics", clean}},
                      {{"name", "gas veijola"}, {"metrics", bounces}}};
  EXPECT_EQ(plain(checks_caption(*read_closing(result).search)),
            "Confirmed: simulated again with a tolerance of 1e-9 and with 6, 8 and 10 modes, the switch closes bounce-free, with "
            "an impact velocity of at most 880 µm/s. Under the other gas laws that are valid here (veijola) this waveform may "
            "bounce: it rebounds by up to 3.20 nm after an impact velocity of 2.30 mm/s (veijola).");
  EXPECT_TRUE(checks_agree(read_closing(result)));
  EXPECT_FALSE(all_checks_land(*read_closing(result).search));
  EXPECT_EQ(headline(read_closing(result)).whole().find("modes"), std::string::npos);
  result["checks"][4]["metrics"] = clean;
  EXPECT_TRUE(all_checks_land(*read_closing(result).search));
  result["checks"][2]["metrics"] = bounces;
  EXPECT_FALSE(checks_agree(read_closing(result)));
  EXPECT_TRUE(sentence(result).ends_with(
      "This result holds for the number of modes in the scene only: with 8 modes it rebounds by up to 3.20 nm after an "
      "impact velocity of 2.30 mm/s."));
  EXPECT_EQ(worst_figure(*worst_check(read_closing(result).search->checks)), "major_bounce_height_m");
  result["checks"][2]["metrics"] = {{"initial_contact_time_s", nullptr}};
  EXPECT_EQ(worst_figure(*worst_check(read_closing(result).search->checks)), "initial_contact_time_s");
}

TEST(Captions, OfALandingNeverCallItCleanerThanItIs) {
  json result = sample_optimize_result(few_rows);
  result["best"]["metrics"]["major_bounce_height_m"] = 0.42e-9;
  EXPECT_TRUE(plain(gap_caption(read_closing(result))).ends_with("and stays closed but for rebounds of at most 420 pm."));
  EXPECT_TRUE(plain(landing_caption(read_closing(result))).ends_with("at 900 µm/s and rebounds by up to 420 pm."));
  result["best"]["metrics"]["settled"] = false;
  EXPECT_TRUE(
      plain(gap_caption(read_closing(result))).ends_with("rebounds, up to 420 pm, and has not settled when the window ends."));
  result["best"]["metrics"] = {{"initial_contact_time_s", nullptr}};
  result["curves"]["best"]["tip_gap_m"] = {2e-6, 1.25e-6, nullptr, 1.5e-6};
  EXPECT_TRUE(plain(gap_caption(read_closing(result)))
                  .ends_with("with softland's waveform the switch never touches: the smallest gap is 1.25 µm."));
}

TEST(Captions, OfASearchNameTheWinner) {
  json result{{"kind", "optimize"},
              {"evaluations", 300},
              {"search", {{"value_name", "cost"}, {"best_so_far", {{1, 2.0}, {17, nullptr}, {120, 0.5}, {240, 0.5}}}}}};
  EXPECT_EQ(search_caption(read_closing(result), *read_closing(result).search),
            "Cost of every waveform tried (dots) and of the best so far (line). In 300 evaluations the cost fell from 2 to 0.5 "
            "(4.0 times lower); the chosen waveform is "
            "number 120.");
  result["search"]["best_so_far"] = {{1, 2.0}, {40, 1.0}, {120, 0.5}};
  result["best"]["cost"] = 1.0;  // the run with the lowest cost misses the goal
  result["baseline"]["cost"] = 0.97;
  EXPECT_EQ(search_caption(read_closing(result), *read_closing(result).search),
            "Cost of every waveform tried (dots) and of the best so far (line); that of the plain step is 0.97. In 300 "
            "evaluations the cost fell from 2 to 0.5 (4.0 times lower); the chosen waveform is number 40.");
  result["search"]["best_so_far"] = {{0, 2.0}};
  result["best"]["cost"] = 2.0;
  result["search"]["evaluations"] = {{0, 2.0}, {7, 3.0}};
  EXPECT_TRUE(search_caption(read_closing(result), *read_closing(result).search)
                  .ends_with("In 300 evaluations the cost stayed at 2; the chosen waveform is number 1."));
  result["search"]["value_name"] = "cost, on the nominal design";
  EXPECT_EQ(
      search_caption(read_closing(result), *read_closing(result).search),
      "Cost of every waveform tried (dots) and of the best so far (line) in the search for the nominal design alone. In 300 "
      "evaluations the cost stayed at 2; its result is drawing.toml.");
}

TEST(Goal, ComparesTheFiguresOfTheTarget) {
  json result = sample_optimize_result(few_rows);
  EXPECT_EQ(goal_text(read_closing(result), figure_of(&Metrics::bounce_count)), "0");
  EXPECT_EQ(goal_text(read_closing(result), figure_of(&Metrics::settled)), "yes");
  EXPECT_EQ(goal_text(read_closing(result), figure_of(&Metrics::impact_velocity)), "");
  result["target"] = "impact";
  EXPECT_EQ(plain(goal_text(read_closing(result), figure_of(&Metrics::impact_velocity))), "below 132.8 mm/s");
  EXPECT_EQ(goal_text(read_closing(result), figure_of(&Metrics::bounce_count)), "");
  EXPECT_EQ(goal_text(read_closing(sample_simulate_result(few_rows)), figure_of(&Metrics::settled)), "");
}

TEST(Captions, OfASingleRunSpeakOfTheSwitch) {
  const json result = sample_simulate_result(few_rows);
  EXPECT_EQ(plain(gap_caption(read_closing(result))),
            "Distance of the contact point from the contact plane (positive: open); dots mark rebounds above 1 nm. The switch "
            "bounces about 57 times, up to 803 nm, until about 370 µs.");
  EXPECT_EQ(plain(force_caption(read_closing(result))),
            "Force of the contact on the beam. Its peak is 290 µN. Closed and at rest, the contact carries 2.10 µN.");
}

TEST(Change, DistinguishesBetterFromWorse) {
  EXPECT_EQ(change(374, 44.5, true, ChangeKind::time).words, "8.4 times shorter");
  EXPECT_EQ(change(374, 44.5, true, ChangeKind::time).verdict, Verdict::better);
  EXPECT_EQ(change(1, 2, true).words, "2.0 times higher");
  EXPECT_EQ(change(1, 2, true).verdict, Verdict::worse);
  EXPECT_EQ(change(1, 2, false).verdict, Verdict::neutral);
  EXPECT_EQ(change(57, 0, true, ChangeKind::count).words, "none left");
  EXPECT_EQ(change(0, 3, true, ChangeKind::count).words, "more");
  EXPECT_EQ(change(0, 0, true).words, "unchanged");
  EXPECT_EQ(change(100, 95, true).words, "5.0 % lower");
  EXPECT_EQ(change(1, std::nan(""), true).words, "");
}

TEST(FamiliesCaption, LeavesOutFamiliesThatAStoppedSearchDidNotReach) {
  SearchRecord search;
  search.families = {
      {.family = "knots", .evaluations = 40, .cost = 0.5}, {.family = "ramp", .evaluations = 7}, {.family = "catch"}};
  EXPECT_EQ(families_caption(search), "knots 0.5, ramp does not close");
}

}  // namespace
}  // namespace softland::internal
