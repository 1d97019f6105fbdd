// Tests the study of accuracy against cost, on a small scene.
#include "studies/closing/accuracy.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "scenes.h"
#include "studies/closing/simulate.h"

namespace softland {
namespace {

// The reference closing until its highest rebound.
PreparedScene first_bounces() {
  return prepare(gold({"waveform.main.level=17.771 V", "driver.main.max_voltage=25 V", "simulate.duration=60 us"}));
}

AccuracyOptions few_settings() {
  return {.tolerances = {1e-4, 1e-6, 1e-8}, .points = {8, 24}, .wanted = {1e-2, 1e-4, 1e-15}, .runs = 1};
}

const AccuracyStudy& study_of_first_bounces() {
  static const AccuracyStudy study = study_accuracy(first_bounces(), few_settings());
  return study;
}

std::vector<AccuracyRow> rows_of(const AccuracyStudy& study, Integrator integrator, std::optional<double> points) {
  std::vector<AccuracyRow> rows;
  for (const AccuracyRow& row : study.rows) {
    if (row.integrator == integrator && row.points_per_length == points) rows.push_back(row);
  }
  return rows;
}

TEST(RelativeErrors, AreOfEachFigureAndSayWhatIsMissing) {
  const MetricsOptions counts_from_2_nm{.significant_rebound = 2e-9};
  Metrics reference, value;
  reference.initial_contact_time = 2;
  value.initial_contact_time = 2.5;
  reference.impact_velocity = 1;
  reference.major_bounce_height = 0;
  value.major_bounce_height = 1e-9;
  value.peak_contact_force = 1;
  const FigureErrors errors = relative_errors(value, reference, counts_from_2_nm);
  EXPECT_EQ(errors[0], 0.25);
  EXPECT_EQ(errors[1], std::numeric_limits<double>::infinity()) << "missing where the reference has one";
  EXPECT_EQ(errors[2], 0) << "neither counts";
  EXPECT_TRUE(std::isnan(errors[3])) << "the reference has none";
  value.major_bounce_height = 3e-9;
  EXPECT_DOUBLE_EQ(relative_errors(value, reference, counts_from_2_nm)[2], 0.5) << "against one that just counts";
}

TEST(Accuracy, TriesEverySettingOnce) {
  const AccuracyStudy& study = study_of_first_bounces();
  EXPECT_EQ(study.status, Status::done);
  for (const Integrator integrator : all_integrators)
    EXPECT_EQ(rows_of(study, integrator, 24).size(), 3U) << to_string(integrator);
  EXPECT_EQ(rows_of(study, study.reference.integrator, 8).size(), 3U);
  EXPECT_EQ(study.through.size(), 3 * all_integrators.size());
  for (const AccuracyRow& row : study.through) EXPECT_FALSE(row.restart);
  for (const AccuracyRow& row : study.rows) EXPECT_TRUE(row.restart);
  EXPECT_EQ(study.rows.size(), 3 * (all_integrators.size() + 1));
  std::vector<int> modes;
  for (const AccuracyRow& row : study.modes) modes.push_back(row.modes);
  EXPECT_EQ(modes, (std::vector{3, 5, 6}));
}

// The tolerance falls by a factor of 100. Errors of a method of order p fall with the power p / (p + 1) of the tolerance or
// faster. A tenth allows for all orders up to 5.
TEST(Accuracy, ErrorsFallWithTheTolerance) {
  constexpr double left_at_most = 0.1;
  const AccuracyStudy& study = study_of_first_bounces();
  for (const Integrator integrator : all_integrators) {
    const std::vector<AccuracyRow> rows = rows_of(study, integrator, 24);
    ASSERT_EQ(rows.back().missing, "");
    EXPECT_GT(rows.back().work.rhs_evaluations, rows.front().work.rhs_evaluations) << to_string(integrator);
    EXPECT_LT(study.worst_error(rows[2]), left_at_most * study.worst_error(rows[0])) << to_string(integrator);
  }
}

// Integrators that are not restarted at make and break of contact converge to the same figures with a different amount of work.
TEST(Accuracy, ComparesRunsWithoutARestartAtTheContact) {
  constexpr double close = 1e-4;
  const AccuracyStudy& study = study_of_first_bounces();
  for (const AccuracyRow& row : study.through) {
    ASSERT_EQ(row.missing, "");
    if (row.tolerance == 1e-8) {
      EXPECT_LT(study.worst_error(row), close) << to_string(row.integrator);
    }
    for (const AccuracyRow& restarted : rows_of(study, row.integrator, 24)) {
      if (restarted.tolerance == row.tolerance) {
        EXPECT_NE(row.work.rhs_evaluations, restarted.work.rhs_evaluations);
      }
    }
  }
  const AccuracyStudy memory =
      study_accuracy(prepare(gold({"contact.model=elastic-plastic", "contact.hardness=1 GPa", "simulate.duration=40 us"})),
                     {.tolerances = {1e-4}, .points = {24}, .runs = 1});
  EXPECT_EQ(memory.status, Status::done);
  EXPECT_TRUE(memory.through.empty());
  EXPECT_EQ(memory.why_always_restarted, "a contact law with memory turns at the deepest point");
}

TEST(Accuracy, MoreModesAreAnotherModelAndNotAnError) {
  const AccuracyStudy& study = study_of_first_bounces();
  const double error = study.worst_error(rows_of(study, study.reference.integrator, 24).back());
  for (const AccuracyRow& row : study.modes) {
    EXPECT_GT(row.errors[0], 100 * error) << row.modes << " modes change t_i by more than any integration error";
    EXPECT_LT(row.errors[0], 1e-2) << row.modes;
  }
}

TEST(Accuracy, TheReferenceIsBetterThanEveryRow) {
  const AccuracyStudy& study = study_of_first_bounces();
  EXPECT_EQ(study.reference.points_per_length, 48);
  EXPECT_DOUBLE_EQ(study.reference.tolerance, 1e-12);
  for (const AccuracyRow& row : study.rows) {
    if (!row.missing.empty()) continue;
    for (std::size_t i = 0; i < studied_figures.size(); ++i) {
      EXPECT_LT(study.resolution[i], row.errors[i])
          << studied_figures[i].symbol << " of " << to_string(row.integrator) << " at " << row.tolerance;
    }
  }
}

TEST(Accuracy, RecommendsTheQuickestSettingWithinEachAccuracy) {
  const AccuracyStudy& study = study_of_first_bounces();
  ASSERT_EQ(study.recommendations.size(), 3U);
  for (const Recommendation& r : study.recommendations) {
    const AccuracyRow* quickest = nullptr;
    for (const AccuracyRow& row : study.rows) {
      bool within = row.missing.empty();
      for (const AccuracyRow& tighter : rows_of(study, row.integrator, row.points_per_length)) {
        if (tighter.tolerance <= row.tolerance && tighter.missing.empty())
          within = within && study.worst_error(tighter) <= r.accuracy;
      }
      if (within && (quickest == nullptr || row.seconds < quickest->seconds)) quickest = &row;
    }
    EXPECT_EQ(r.row ? &study.rows[*r.row] : nullptr, quickest) << r.accuracy;
    EXPECT_EQ(r.row.has_value(), r.accuracy > 1e-10) << "nothing reaches 1e-15";
  }
}

TEST(Accuracy, StopsSlowSettingsAndListsThem) {
  AccuracyOptions options = few_settings();
  options.most_seconds = 0;  // the first reading of the clock stops the run
  const AccuracyStudy slow = study_accuracy(first_bounces(), options);
  EXPECT_EQ(slow.status, Status::done) << "the reference has a bound of its own";
  for (const AccuracyRow& row : slow.rows) {
    EXPECT_EQ(row.missing, row.tolerance == 1e-4 ? "cut after 0 s of processor time"
                                                 : "not tried: a looser tolerance took more than 0 s of processor time");
    EXPECT_TRUE(std::isnan(slow.worst_error(row)));
  }
  for (const Recommendation& r : slow.recommendations) EXPECT_FALSE(r.row) << r.accuracy;

  options.all_seconds = 0;
  const AccuracyStudy late = study_accuracy(first_bounces(), options);
  EXPECT_EQ(late.rows.size(), slow.rows.size());
  EXPECT_TRUE(late.rows.front().missing.starts_with("not tried: the time limit of the study")) << late.rows.front().missing;
  EXPECT_TRUE(late.modes.front().missing.starts_with("not tried: the time limit of the study")) << late.modes.front().missing;

  options.reference_seconds = 0;
  const AccuracyStudy none = study_accuracy(first_bounces(), options);
  EXPECT_EQ(none.status, Status::numerical_failure);
  EXPECT_EQ(none.message, "cut after 0 s of processor time");
  EXPECT_TRUE(none.rows.empty());
}

// What else the machine computes stops no run: the limits do not count the time in which the thread waits.
TEST(Accuracy, LimitsCountTheProcessorTimeOfTheThread) {
  constexpr std::chrono::milliseconds waited{60};
  const AccuracyOptions options;
  const double start = options.clock();
  std::this_thread::sleep_for(waited);
  EXPECT_LT(options.clock() - start, 0.5 * std::chrono::duration<double>(waited).count());
}

TEST(Accuracy, ReportsItsProgressAndCanBeStopped) {
  std::atomic<bool> stop{false};
  AccuracyOptions options = few_settings();
  std::size_t last = 0, all = 0;
  options.stop = &stop;
  options.on_progress = [&](std::size_t done, std::size_t of) {
    EXPECT_EQ(done, last + 1);
    last = done;
    all = of;
    if (done == 5) stop = true;
  };
  const AccuracyStudy study = study_accuracy(first_bounces(), options);
  EXPECT_EQ(study.status, Status::interrupted);
  EXPECT_EQ(last, all);
  EXPECT_EQ(study.rows.back().missing, "interrupted");
}

TEST(Accuracy, OfAPlateHasNoOtherModesAndWithoutContactNoRebounds) {
  const AccuracyStudy study = study_accuracy(prepare(scene("purdue-nickel.toml")), few_settings());
  EXPECT_EQ(study.status, Status::done);
  EXPECT_TRUE(study.modes.empty());
  EXPECT_EQ(study.rows.size(), 3 * all_integrators.size()) << "the points do not matter";
  for (const AccuracyRow& row : study.rows) EXPECT_FALSE(row.points_per_length);
  EXPECT_TRUE(study.conditioned[0]);
  EXPECT_FALSE(study.conditioned[2]) << "the run ends at first touch";
  EXPECT_TRUE(std::isnan(study.rows.front().errors[3]));
}

// The pressures of its film are states, so that a reference at a tolerance of 1e-13 takes many seconds.
TEST(Accuracy, OfASlowSceneHasTheReferenceThatItsTimeAllows) {
  const PreparedScene p = prepare(scene("hung-senturia.toml", {"structure.modes=1", "simulate.accuracy=1e-2"}));
  // This clock counts its readings, one in 64 steps, so that the time limit does not depend on the machine.
  double looks = 0;
  const AccuracyStudy study = study_accuracy(p, {.tolerances = {1e-3, 1e-6, 1e-9},
                                                 .points = {24},
                                                 .runs = 1,
                                                 .most_seconds = 40,
                                                 .reference_seconds = 60,
                                                 .all_seconds = 100,
                                                 .clock = [&looks] { return looks++; }});
  ASSERT_EQ(study.status, Status::done) << study.message;
  EXPECT_GT(study.reference.tolerance, 1e-12);
  EXPECT_NE(study.message, "");
  EXPECT_TRUE(std::isfinite(study.resolution[0]));
  for (const AccuracyRow& row : study.rows) {
    const bool judged =
        row.tolerance > 9 * study.reference.tolerance && 2 * *row.points_per_length <= study.reference.points_per_length;
    const bool cut = row.missing.starts_with("cut") || row.missing.find("took more") != std::string::npos;
    if (!cut) {
      EXPECT_EQ(row.missing.starts_with("not tried: the reference"), !judged) << row.tolerance << row.missing;
    }
  }
}

TEST(Accuracy, WithoutATouchHasNothingToStudy) {
  const AccuracyStudy study = study_accuracy(prepare(gold({"waveform.main.level=3 V"})), few_settings());
  EXPECT_EQ(study.status, Status::no_contact);
  EXPECT_TRUE(study.rows.empty());
}

// Just above the lowest step that closes, the closing time depends on the last digits of the voltage.
TEST(Accuracy, CallsFiguresIllConditionedThatImperceptibleChangesMove) {
  const auto at = [](double volts) {
    return prepare(gold({fmt::format("waveform.main.level={:.17g} V", volts), "simulate.duration=250 us"}));
  };
  double below = 14, above = 14.5;
  while (above / below - 1 > 1e-9) {
    const double middle = (below + above) / 2;
    const PreparedScene p = at(middle);
    const Trajectory t = simulate_closing(p.model, p.signals(), {.duration = p.duration, .tolerance = 1e-5, .after_contact = 0});
    (t.touches.empty() ? below : above) = middle;
  }
  AccuracyOptions options = few_settings();
  options.tolerances = {1e-5};
  const AccuracyStudy hair = study_accuracy(at(above * (1 + 1e-6)), options);
  ASSERT_EQ(hair.status, Status::done);
  EXPECT_FALSE(hair.conditioned[0]);
  EXPECT_GT(hair.cloud[0].high / hair.cloud[0].low - 1, ill_conditioned_range);
  for (const bool conditioned : study_of_first_bounces().conditioned) EXPECT_TRUE(conditioned);
}

// Long after the first large rebound the closing is chaotic: see docs/reference/errors.md.
TEST(Accuracy, ShowsTheEndOfAChaoticClosingAsACloud) {
  const PreparedScene p = prepare(gold({"waveform.main.level=17.771 V", "driver.main.max_voltage=25 V"}));
  AccuracyOptions options = few_settings();
  options.tolerances = {1e-5};
  const AccuracyStudy study = study_accuracy(p, options);
  constexpr double visible = 1e-3;  // relative; the cloud has a range of a tenth
  EXPECT_EQ(study.permanent_contact_time.runs, 8);
  EXPECT_GT(study.permanent_contact_time.high, (1 + visible) * study.permanent_contact_time.low);
  EXPECT_TRUE(study.conditioned[2]) << "the highest rebound is the first large one";
}

}  // namespace
}  // namespace softland
