// Figures of merit with reliable errors, and clouds for ill-conditioned figures.
#include "studies/closing/certify.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/constants.h"
#include "scenes.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/open_state.h"
#include "tests/support/random_scenes.h"

namespace softland {
namespace {

using testing::Contains;
using testing::IsEmpty;
using testing::Not;

PreparedScene prepared_gold(std::string_view duration, std::string_view accuracy = "1e-6") {
  return prepare(gold({"waveform.main.level=17.771 V", "driver.main.max_voltage=25 V",
                       fmt::format("simulate.duration={}", duration), fmt::format("simulate.accuracy={}", accuracy)}));
}

std::vector<std::string_view> ill_conditioned(const Closing& c) {
  std::vector<std::string_view> keys;
  for (const IllConditioned& f : c.certificate->ill_conditioned) keys.push_back(f.figure.key);
  return keys;
}

// Returns the numbers of well-conditioned figures whose true error is covered, and not covered.
std::pair<int, int> coverage(const PreparedScene& p, const Closing& c) {
  const Switch fine(p.scene.device, {.points_per_length = std::max(96.0, 4 * c.quadrature.points_per_length)});
  const ClosingOptions options{.duration = p.duration, .tolerance = std::max(1e-13, 1e-4 * c.tolerance)};
  const Trajectory best_run = simulate_closing(fine, p.signals(), options);
  if (best_run.status != Status::done) return {};
  Metrics truth = metrics(best_run, p.scene.metrics);
  set_open_figures(truth, best_run, fine, p.signals());
  constexpr double rounding = 1e-11;  // relative difference below which two runs cannot be distinguished
  std::pair<int, int> counts;
  const std::vector<std::string_view> ill = ill_conditioned(c);
  for (const Figure& f : all_figures) {
    const double own = f.value(c.metrics), best = f.value(truth);
    if (!f.has_error() || f.conditioning == Conditioning::rest || !std::isfinite(own) ||
        std::find(ill.begin(), ill.end(), f.key) != ill.end())
      continue;
    const bool covered = std::abs(own - best) <= std::max(c.errors[f], rounding * std::abs(best));
    ++(covered ? counts.first : counts.second);
  }
  return counts;
}

// Includes scenes in which simulate() has to tighten its run to reach the accuracy.
TEST(Certify, DoesNotChangeTheFigures) {
  int tightened = 0;
  const auto expect_same = [&](const PreparedScene& p) {
    const Closing plain = simulate(p, true), certified = certify(p);
    EXPECT_EQ(plain.certificate, nullptr);
    ASSERT_NE(certified.certificate, nullptr);
    for (const Figure& f : all_figures) {
      const double own = f.value(certified.metrics), other = f.value(plain.metrics);
      EXPECT_TRUE(own == other || (std::isnan(own) && std::isnan(other))) << f.key << ": " << own << ", " << other;
    }
    tightened += plain.tolerance < p.tolerance;
  };
  expect_same(prepared_gold("60 us"));
  for (const std::uint64_t index : {18U, 69U, 120U, 185U}) {
    SCOPED_TRACE(index);
    SceneFile file = test::random_scene(3, index);
    file.set("simulate.accuracy=1e-3");
    expect_same(prepare(file));
  }
  EXPECT_GE(tightened, 1);
}

TEST(Certify, CoversTheTrueErrorsOfAWellConditionedClosing) {
  for (const char* accuracy : {"1e-2", "1e-4", "1e-6"}) {
    const PreparedScene p = prepared_gold("60 us", accuracy);
    const Closing c = certify(p);
    EXPECT_THAT(ill_conditioned(c), IsEmpty()) << accuracy << ": a loose tolerance is an error, not a condition";
    EXPECT_FALSE(c.certificate->grazing);
    const auto [covered, missed] = coverage(p, c);
    EXPECT_GE(covered, 6);
    EXPECT_EQ(missed, 0) << accuracy;
    EXPECT_GT(c.errors[&Metrics::hold_force], 0);
    EXPECT_LT(c.errors[&Metrics::hold_force], 1e-3 * c.metrics.hold_force);
  }
}

// bench/certify_coverage.cc checks the same on hundreds of scenes.
TEST(Certify, CoversTheTrueErrorsOfRandomScenes) {
  int covered = 0, missed = 0;
  for (std::uint64_t i = 0; i < 24; ++i) {
    SceneFile file = test::random_scene(3, i);
    file.set("simulate.accuracy=1e-4");
    const PreparedScene p = prepare(file);
    constexpr long most_steps = 1000;  // longer closings are left to the bench
    const ClosingOptions options{.duration = p.duration, .tolerance = p.tolerance, .max_steps = most_steps};
    if (p.model.film_states() > 0 || simulate_closing(p.model, p.signals(), options).work.steps >= most_steps) continue;
    const Closing c = certify(p);
    if (!c.certificate) continue;
    const auto [yes, no] = coverage(p, c);
    covered += yes;
    missed += no;
  }
  EXPECT_GE(covered, 20);
  EXPECT_LE(missed, 2);  // covered in 95 % of the cases: three or more misses of 25 have a probability of 13 %
}

TEST(Certify, NoErrorOfADriveEnergyIsBelowTheResidualOfTheEnergies) {
  int seen = 0;
  for (std::uint64_t i = 0; i < 12; ++i) {
    SceneFile file = test::random_scene(3, i);
    file.set("simulate.accuracy=1e-3");
    const PreparedScene p = prepare(file);
    constexpr long most_steps = 1000;
    const ClosingOptions options{.duration = p.duration, .tolerance = p.tolerance, .max_steps = most_steps};
    if (p.model.film_states() > 0 || simulate_closing(p.model, p.signals(), options).work.steps >= most_steps) continue;
    for (const Closing& c : {simulate(p, true), certify(p)}) {
      const double error = c.errors[&Metrics::drive_energy];
      if (!std::isfinite(error)) continue;
      EXPECT_GE(error, c.trajectory.energy_error) << i;
      ++seen;
    }
  }
  EXPECT_GE(seen, 8);
}

TEST(Certify, GivesChaoticFiguresAsACloudAndSaysWhereItParts) {
  const PreparedScene p = prepared_gold("600 us", "1e-3");
  const Closing c = certify(p);
  EXPECT_THAT(ill_conditioned(c), Contains("permanent_contact_time_s"));
  EXPECT_THAT(ill_conditioned(c), Not(Contains("major_bounce_height_m"))) << "the first large rebound";
  for (const IllConditioned& f : c.certificate->ill_conditioned) {
    EXPECT_LE(f.spread.low, f.spread.median) << f.figure.key;
    EXPECT_LE(f.spread.median, f.spread.high) << f.figure.key;
    EXPECT_EQ(f.spread.runs, 16) << f.figure.key;
    if (f.figure.key != "permanent_contact_time_s") continue;
    EXPECT_LT(f.spread.low, f.spread.high);
    EXPECT_GE(c.errors[&Metrics::permanent_contact_time], c.metrics.permanent_contact_time - f.spread.low);
    EXPECT_GE(c.errors[&Metrics::permanent_contact_time], f.spread.high - c.metrics.permanent_contact_time);
  }
  ASSERT_TRUE(c.certificate->grazing);
  EXPECT_GT(c.certificate->grazing->number, 1);
  EXPECT_GT(c.certificate->grazing->time, c.metrics.initial_contact_time);
  EXPECT_LT(c.certificate->grazing->impact_velocity, c.metrics.impact_velocity);
}

// Returns the dynamic pull-in voltage by bisection, a hundred thousand times as precise as dynamic_pull_in().
double tight_pull_in(const PreparedScene& p) {
  const Switch fine(p.scene.device, {.points_per_length = 48});
  const double known = p.pull_in.at("main").dynamically.voltage;
  const ClosingOptions options{
      .duration = 100 * 2 * pi / fine.basis().angular_frequencies()[0], .tolerance = 1e-12, .after_contact = 0};
  double low = known * (1 - 1e-6), high = known * (1 + 1e-6);
  while (high - low > 1e-12 * high) {
    const double middle = (low + high) / 2;
    const std::vector<Signal> step{Signal::constant(middle)};
    (simulate_closing(fine, step, options).touches.empty() ? low : high) = middle;
  }
  return high;
}

// Runs the scene at the true voltage of its level: the errors must cover the difference.
TEST(Certify, CoversTheErrorOfTheVoltagesThatDrivesAreWrittenIn_optimized) {
  const auto driven = [](const char* accuracy, const std::string& level) {
    return prepare(gold({fmt::format("waveform.main.level={}", level), "simulate.duration=60 us",
                         fmt::format("simulate.accuracy={}", accuracy)}));
  };
  for (const double level : {1.25, 1.05}) {
    const std::string in_pull_in = fmt::format("{} Vdp", level);
    const double volts = level * tight_pull_in(driven("1e-4", in_pull_in));
    const Closing truth = simulate(driven("1e-9", fmt::format("{:.17g} V", volts)), false);
    for (const char* accuracy : {"1e-2", "1e-4", "1e-8"}) {
      const Closing c = certify(driven(accuracy, in_pull_in));
      for (const Figure& f : all_figures) {
        if (!f.has_error() || f.is_count() || !std::isfinite(f.value(c.metrics))) continue;
        const double off = std::abs(f.value(c.metrics) - f.value(truth.metrics));
        EXPECT_LE(off, c.errors[f]) << f.key << ' ' << level << ' ' << accuracy;
      }
      EXPECT_LT(c.errors[&Metrics::impact_velocity], 0.05 * c.metrics.impact_velocity) << "not by naming any number";
    }
  }
  SceneFile file = gold({"simulate.duration=60 us", "simulate.accuracy=1e-4"});
  const double all = certify(prepare(file)).errors[&Metrics::impact_velocity];
  file.set("structure.damping_ratio=1e-9");
  file.set("simulate.effects=auto");  // the voltages, and their errors, are those of the scene with all effects
  EXPECT_NEAR(certify(prepare_and_choose(file)).errors[&Metrics::impact_velocity], all, 0.5 * all);
}

TEST(Simulate, DoesNotTakeAQuietEndForRestWhereTheHoldLevelsDoNotKeepTheSwitchClosed) {
  const auto closing = [](std::string_view duration) {
    SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/tests/studies/soft_contact.toml");
    file.set(fmt::format("simulate.duration={}", duration));
    return simulate(prepare(file), false);
  };
  const Closing c = closing("23 us"), later = closing("60 us");
  EXPECT_EQ(later.trajectory.status, Status::collapsed_onto_electrode) << "the electrode has it";
  EXPECT_EQ(c.trajectory.status, Status::done);
  EXPECT_EQ(c.metrics.bounce_count, 0);
  EXPECT_EQ(c.metrics.status, Status::not_settled);
  EXPECT_FALSE(c.metrics.settled);
  EXPECT_TRUE(std::isnan(c.metrics.permanent_contact_time));
  EXPECT_THAT(c.warnings, Contains(testing::HasSubstr("do not keep the switch closed")));
  const auto is_held = [](const SceneFile& file) {
    const PreparedScene p = prepare(file);
    const Hold hold = hold_of(p.model, p.signals());
    EXPECT_EQ(std::isfinite(hold.force), hold.is_held);
    return hold.is_held;
  };
  EXPECT_TRUE(is_held(gold()));
  // A step that closes the switch dynamically, below the release voltage of so small a gap.
  EXPECT_FALSE(is_held(gold({"gap.contact=0.3 um", "waveform.main.level=1.02 Vdp"})));
}

PreparedScene far_electrode(std::string_view setting) {
  SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/tests/studies/far_electrode.toml");
  file.set(std::string(setting));
  return prepare(file);
}

// The error of a maximum that a later, chaotic touch may exceed is not stated, or agrees with a tighter run.
TEST(Simulate, StatesNoErrorOfAMaximumThatChanceMayExceed_optimized) {
  constexpr double rounding = 1e-9;
  for (const char* modulus : {"1549.009475642491 GPa", "400 GPa", "78 GPa"}) {
    const auto closing = [&](std::string_view accuracy) {
      return simulate(
          prepare(gold({fmt::format("structure.youngs_modulus={}", modulus), "contact.asperity_density=2130192156318.5112 1/m^2",
                        fmt::format("simulate.accuracy={}", accuracy)})),
          true);
    };
    const Closing loose = closing("1e-4"), tight = closing("1e-8");
    for (const auto member : {&Metrics::peak_contact_force, &Metrics::major_bounce_height, &Metrics::impact_energy}) {
      const double error = loose.errors[member], apart = std::abs(loose.metrics.*member - tight.metrics.*member);
      if (!std::isfinite(error)) continue;
      EXPECT_LE(apart, std::max(10 * error, rounding * loose.metrics.*member)) << modulus;
    }
  }
}

// A run that leaves no room for a tighter one is judged by a looser one, at any tolerance.
TEST(Simulate, IsNeverItsOwnJudge_optimized) {
  for (const char* setting : {"simulate.accuracy=1e-8", "simulate.accuracy=1e-12", "simulate.tolerance=1e-13"}) {
    const Closing c = simulate(far_electrode(setting), true);
    ASSERT_EQ(c.judge->status, Status::done) << setting;
    EXPECT_NE(c.judge->tolerance, c.tolerance) << setting;
    EXPECT_NE(c.judge->quadrature.points_per_length, c.quadrature.points_per_length) << setting;
    for (const Figure& f : all_figures) {
      if (f.conditioning == Conditioning::high_rebound) continue;  // stated if the later rebounds are low, at any tolerance
      const bool known = f.conditioning == Conditioning::first_touch;
      EXPECT_EQ(c.errors[f] > 0, known) << f.key << ' ' << setting << ": of what comes after the runs part there is none";
    }
  }
  const Closing asked = simulate(far_electrode("simulate.accuracy=1e-12"), true);
  EXPECT_THAT(asked.warnings, Contains(testing::HasSubstr("accuracy 1e-12 is not reached")));
  // The known accuracy is printed with enough digits to differ from the requested one.
  for (const char* setting : {"simulate.accuracy=1e-12", "simulate.accuracy=1e-11", "simulate.accuracy=1e-10"}) {
    const std::string asked_for = std::string(setting).substr(18);
    for (const std::string& warning : simulate(far_electrode(setting), true).warnings)
      EXPECT_THAT(warning, testing::Not(testing::HasSubstr("still known to " + asked_for + " only")));
  }
}

TEST(Certify, GivesTheRangeOfAChaoticCount_optimized) {
  const Closing c = certify(far_electrode("simulate.accuracy=1e-8"));
  EXPECT_THAT(ill_conditioned(c), Contains("bounce_count"));
  EXPECT_GE(c.errors[&Metrics::bounce_count], 2);
}

TEST(Certify, SaysNothingOfARunThatIsNotDone) {
  const PreparedScene p = prepared_gold("60 us");
  const std::atomic<bool> stop{true};
  const Closing c = certify(p, {.stop = &stop});
  EXPECT_EQ(c.certificate, nullptr);
  EXPECT_TRUE(std::isnan(c.errors[&Metrics::impact_velocity]));
}

TEST(Simulate, AskedToStopWhileItEstimatesErrorsKeepsTheFiguresWithoutThem) {
  const PreparedScene p = prepared_gold("60 us");
  std::atomic<bool> stop{false};
  const Progress progress{.stop = &stop, .report = [&](std::string_view what, double part) {
                            EXPECT_TRUE(part >= 0 && part <= 1) << what;
                            stop = stop || what.starts_with("closing again");
                          }};
  const Closing c = simulate(p, true, progress), first = simulate(p, false);
  EXPECT_TRUE(stop);
  EXPECT_EQ(c.metrics.status, Status::interrupted);
  EXPECT_EQ(c.metrics.impact_velocity, first.metrics.impact_velocity);
  EXPECT_TRUE(std::isnan(c.errors[&Metrics::impact_velocity]));
  for (const std::string& warning : c.warnings) EXPECT_EQ(warning.find("is not reached"), std::string::npos) << warning;
}

// A trajectory with ballistic rebounds of these heights [m], and touches of 1 us between them.
Trajectory hops(const std::vector<double>& heights) {
  constexpr double gap = 1e-6, pull = 1e3, dwell = 1e-6;
  Trajectory t;
  t.status = Status::done;
  t.contact_gap = gap;
  double time = 1e-3, in = 1;
  t.points.push_back({.time = 0, .position = 0, .velocity = gap / time, .acceleration = 0});
  for (const double height : heights) {
    const double out = std::sqrt(2 * pull * height);
    t.touches.push_back({.begin = time, .end = time + dwell, .impact_velocity = in});
    t.points.push_back({.time = time, .position = gap, .velocity = in, .acceleration = 0});
    time += dwell;
    t.points.push_back({.time = time, .position = gap, .velocity = -out, .acceleration = 0});
    t.points.push_back({.time = time, .position = gap, .velocity = -out, .acceleration = pull});
    time += 2 * out / pull;
    t.points.push_back({.time = time, .position = gap, .velocity = out, .acceleration = pull});
    in = out;
  }
  t.touches.push_back({.begin = time, .impact_velocity = in});
  t.points.push_back({.time = time, .position = gap, .velocity = in, .acceleration = 0});
  t.points.push_back({.time = time + dwell, .position = gap + in * dwell / 2, .velocity = 0, .acceleration = 0});
  return t;
}

TEST(GrazingRebound, IsNoneWhereRunsAgree) {
  const std::vector<Trajectory> alike{hops({5e-9, 50e-9, 5e-9}), hops({5.1e-9, 50e-9, 5.1e-9})};
  EXPECT_FALSE(grazing_rebound(alike, {}));
  EXPECT_FALSE(grazing_rebound({}, {}));
}

TEST(GrazingRebound, IsTheOneThatCountsInSomeRunsOnly) {
  const std::vector<Trajectory> runs{hops({5e-9, 50e-9, 1.01e-9, 3e-9}), hops({5e-9, 50e-9, 0.99e-9, 3e-9})};
  const auto found = grazing_rebound(runs, {.significant_rebound = 1e-9});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->at_threshold);
  EXPECT_EQ(found->number, 3);
  EXPECT_NEAR(found->height, 1.01e-9, 1e-12);
  EXPECT_NEAR(found->time, runs[0].touches[2].end, 1e-12);
}

TEST(GrazingRebound, FollowsTheGentlestTouchBeforeTheRunsPart) {
  const std::vector<Trajectory> runs{hops({5e-9, 2e-9, 50e-9, 80e-9, 1.5e-9}), hops({5e-9, 2e-9, 51e-9, 8e-9, 1.5e-9})};
  const auto found = grazing_rebound(runs, {.significant_rebound = 1e-9});
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->at_threshold);
  EXPECT_EQ(found->number, 3) << "after the rebound of 2 nm";
  EXPECT_EQ(found->impact_velocity, runs[0].touches[2].impact_velocity);
}

TEST(GrazingRebound, IsSeenWhereSomeRunsGoOn) {
  const std::vector<Trajectory> fewer{hops({50e-9, 5e-9}), hops({50e-9, 5e-9, 2e-9})};
  ASSERT_TRUE(grazing_rebound(fewer, {}));
  EXPECT_EQ(grazing_rebound(fewer, {})->number, 2);
  const std::vector<Trajectory> more{fewer[1], fewer[0]};
  EXPECT_EQ(grazing_rebound(more, {})->number, 3);
}

TEST(Certify, FindsNothingIllConditionedWhereNothingTouches) {
  SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml");
  file.set("simulate.duration=20 us");
  const Closing c = certify(prepare(file));
  ASSERT_EQ(c.metrics.status, Status::no_contact);
  ASSERT_TRUE(c.certificate);
  EXPECT_TRUE(c.certificate->ill_conditioned.empty()) << c.certificate->ill_conditioned.front().figure.key;
}

}  // namespace
}  // namespace softland
