// Tests the cost function of searches on synthetic trajectories. No weight is repeated here: the tests hold for any weights.
#include "objectives/cost.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/closing.h"
#include "scenes.h"
#include "studies/closing/prepared.h"

namespace softland {
namespace {

constexpr double gap = 2e-6, score_window = 100e-6;
const MetricsOptions options;

// Returns a landing that approaches at `speed`, touches at `at`, has a rebound of `height` and duration `flight`, and stays
// closed.
Trajectory landing(double at, double speed, double height, double flight, double excess) {
  Trajectory t;
  t.status = Status::done;
  t.contact_gap = gap;
  t.landing_excess = excess;
  t.energy.source_work = 1e-11 * speed;
  const double dip = 1e-9, dwell = 2e-6, end = at + score_window;
  const auto add = [&](double time, double position, double velocity, double acceleration = 0) {
    t.points.push_back({time, position, velocity, acceleration, 0});
  };
  add(0, 0, 0);
  add(at, gap, speed);
  add(at + dwell / 2, gap + dip, 0);
  const Touch first{
      .begin = at, .end = at + dwell, .impact_velocity = speed, .peak_force = 1e-5 * speed, .peak_energy = 1e-12 * speed};
  if (height > 0) {
    const double g = 8 * height / (flight * flight), leave = at + dwell;
    add(leave, gap, -g * flight / 2, g);
    add(leave + flight / 2, gap - height, 0, g);
    add(leave + flight, gap, g * flight / 2, g);
    t.touches = {first,
                 {.begin = leave + flight,
                  .end = std::numeric_limits<double>::quiet_NaN(),
                  .impact_velocity = speed / 10,
                  .peak_force = 1e-6,
                  .peak_energy = 1e-13 * speed}};
  } else {
    t.touches = {first};
    t.touches[0].end = std::numeric_limits<double>::quiet_NaN();
  }
  add(end, gap + dip, 0);
  t.force.steady_force_time = t.electrical.closed_from = at + dwell + (height > 0 ? flight : 0);
  return t;
}

Trajectory plain_step() { return landing(20e-6, 0.3, 100e-9, 8e-6, 1e-12); }

CostScale scale() {
  return {.step = metrics(plain_step(), options), .score_window = score_window, .contact_gap = gap, .free_touch = 1.5};
}

double cost(const Aim& aim, const Trajectory& trajectory, const CostScale& scale, const MetricsOptions& options) {
  return softland::cost(aim, metrics(trajectory, options), scale, options);
}

TEST(Metrics, OfALandingMadeByHandHaveWhatCostsAreMadeOf) {
  const Metrics m = scale().step;
  EXPECT_TRUE(m.touched());
  EXPECT_DOUBLE_EQ(m.initial_contact_time, 20e-6);
  EXPECT_DOUBLE_EQ(m.largest_impact_velocity, 0.3);
  EXPECT_NEAR(m.major_bounce_height, 100e-9, 1e-13);
  EXPECT_NEAR(m.separated, 8e-6, 1e-11);
  EXPECT_NEAR(m.last_rebound_end, 30e-6, 1e-11);
  EXPECT_NEAR(m.impact_energy, 0.33e-12, 1e-20);
  EXPECT_DOUBLE_EQ(m.landing_excess, 1e-12);
}

TEST(Cost, OfTheStepItselfIsAboutOneAndAboutTwoByAFigureOfItsOwn) {
  for (const Target target : every_target)
    EXPECT_NEAR(cost(target, plain_step(), scale(), options), has_own_cost(target) ? 2 : 1, 0.3) << to_string(target);
}

TEST(Cost, BelowOneIsThatOfALandingWithoutSignificantReboundByItsOwnFigureAlone) {
  const double insignificant = 0.4 * options.significant_rebound, significant = 1.1 * options.significant_rebound;
  for (const Target target : every_target) {
    if (!has_own_cost(target)) continue;
    EXPECT_LT(cost(target, landing(45e-6, 0.6, insignificant, 1e-6, 5e-12), scale(), options), 1) << to_string(target);
    EXPECT_GT(cost(target, landing(20e-6, 0.01, significant, 1e-6, 0), scale(), options), 1) << to_string(target);
  }
  // An early, hard landing against a late, soft one: the target settling prefers the first, impact and energy the second, even
  // by the smallest difference.
  const Trajectory early = landing(30.0e-6, 0.1005, 0, 0, 1e-13), soft = landing(30.1e-6, 0.1, 0, 0, 5e-13);
  const auto prefers_early = [&](Target target) {
    return cost(target, early, scale(), options) < cost(target, soft, scale(), options);
  };
  EXPECT_TRUE(prefers_early(Target::settling));
  EXPECT_FALSE(prefers_early(Target::impact));
  EXPECT_FALSE(prefers_early(Target::energy));
}

TEST(Cost, OfTheEnergyOfSoftTouchesIsLedByItAndNotByTheirLateness) {
  Trajectory early = landing(28e-6, 0.001, 0, 0, 0), late = landing(36e-6, 0.001, 0, 0, 0);
  early.touches[0].peak_energy = 2.6e-4 * scale().step.impact_energy;
  late.touches[0].peak_energy = 0.95 * early.touches[0].peak_energy;
  EXPECT_LT(cost(Target::energy, late, scale(), options), cost(Target::energy, early, scale(), options));
  EXPECT_LT(cost(Target::bounce, early, scale(), options), cost(Target::bounce, late, scale(), options));
}

TEST(Cost, OfForceAndDriveFollowTheirFigures) {
  Trajectory one = landing(20e-6, 0.1, 0, 0, 0), other = one;
  other.touches[0].peak_force *= 0.99;
  EXPECT_LT(cost(Target::force, other, scale(), options), cost(Target::force, one, scale(), options));
  EXPECT_EQ(cost(Target::drive, other, scale(), options), cost(Target::drive, one, scale(), options));
  other = one;
  other.energy.source_work *= 0.99;
  EXPECT_LT(cost(Target::drive, other, scale(), options), cost(Target::drive, one, scale(), options));
  EXPECT_EQ(cost(Target::force, other, scale(), options), cost(Target::force, one, scale(), options));
}

TEST(Cost, OfASumLiesBetweenThoseOfItsPartsAndKnowsOnlyTheRatiosOfItsWeights) {
  const Trajectory t = landing(24e-6, 0.1, 0, 0, 1e-14);
  const double settling = cost(Target::settling, t, scale(), options), energy = cost(Target::energy, t, scale(), options);
  ASSERT_LT(energy, settling);
  double before = settling;
  for (const double weight : {0.1, 0.5, 0.9}) {
    const Aim sum({{Target::settling, 1 - weight}, {Target::energy, weight}});
    const double between = cost(sum, t, scale(), options);
    EXPECT_LT(between, before) << weight;
    EXPECT_GT(between, energy) << weight;
    EXPECT_NEAR(cost(Aim({{Target::settling, 7 * (1 - weight)}, {Target::energy, 7 * weight}}), t, scale(), options), between,
                1e-15);
    before = between;
  }
  EXPECT_EQ(Aim({{Target::bounce, 0.7}, {Target::energy, 0.3}}).text(), "0.7 bounce + 0.3 energy");
  EXPECT_EQ(refusal([] {
              Aim({{Target::bounce, 1}, {Target::bounce, 2}});
            }),
            "bounce appears twice in a sum of targets; name each target once");
  EXPECT_EQ(refusal([] {
              Aim({{Target::bounce, 0}, {Target::drive, 2}});
            }),
            "the weight of bounce is 0; it must be finite and > 0");
}

TEST(Cost, OfWhatNeverTouchesIsTenAndThePartOfTheGapItLeft) {
  Trajectory open;
  open.status = Status::done;
  open.contact_gap = gap;
  open.points = {{0, 0, 0, 0, 0}, {20e-6, 0.75 * gap, 0, 0, 0}, {40e-6, 0.5 * gap, 0, 0, 0}};
  for (const Target target : every_target) EXPECT_NEAR(cost(target, open, scale(), options), 10.25, 1e-12) << to_string(target);
}

TEST(Shares, OfAnUnknownFigureAreUnknownWhateverTheStepIs) {
  constexpr double unknown = Metrics::unset;
  for (const double of_step : {0.5, 0.0, unknown}) EXPECT_TRUE(std::isnan(Shares::ratio(unknown, of_step))) << of_step;
  EXPECT_EQ(Shares::ratio(3, 2), 1.5);
  EXPECT_EQ(Shares::ratio(3, 0), 1);
  EXPECT_EQ(Shares::ratio(0, 0), 0);
}

TEST(Cost, OfARunThatFailedIsInfinite) {
  for (const Status status : {Status::numerical_failure, Status::interrupted, Status::collapsed_at_rest,
                              Status::collapsed_onto_electrode, Status::not_run}) {
    Trajectory failed = plain_step();
    failed.status = status;
    for (const Target target : every_target)
      EXPECT_EQ(cost(target, failed, scale(), options), std::numeric_limits<double>::infinity()) << to_string(target);
  }
}

TEST(Cost, OfALowerSofterReboundIsLower) {
  double previous = std::numeric_limits<double>::infinity();
  for (const double part : {2.0, 1.0, 0.5, 0.2, 0.05}) {
    const Trajectory t = landing(20e-6, 0.3 * part, 100e-9 * part * part, 8e-6 * part, 1e-12 * part * part);
    for (const Target target : every_target)
      EXPECT_LT(cost(target, t, scale(), options), cost(target, plain_step(), scale(), options) + (part < 1 ? 0 : 10))
          << to_string(target) << " at " << part;
    const double bounce = cost(Target::bounce, t, scale(), options);
    EXPECT_LT(bounce, previous) << part;
    previous = bounce;
  }
}

TEST(Cost, OfALandingWithoutReboundIsLowerThanOfTheSameWithOne) {
  const Trajectory soft = landing(20e-6, 0.3, 0, 0, 1e-12), bouncing = landing(20e-6, 0.3, 30e-9, 8e-6, 1e-12);
  for (const Target target : every_target)
    EXPECT_LT(cost(target, soft, scale(), options), cost(target, bouncing, scale(), options)) << to_string(target);
}

TEST(Cost, OfTheSameLandingLaterIsNotLower) {
  const Trajectory early = plain_step(), late = landing(35e-6, 0.3, 100e-9, 8e-6, 1e-12);
  for (const Target target : every_target)
    EXPECT_GT(cost(target, late, scale(), options), cost(target, early, scale(), options)) << to_string(target);
}

// A search keeps no trajectory: it computes the figures while the closing runs.
TEST(MetricsObserver, GathersWhatCostsAreMadeOfAsATrajectoryHasIt) {
  for (const char* level : {"17.771 V", "21 V", "13 V", "5 V"}) {
    for (const char* window : {"600 us", "60 us"}) {  // the short one ends during a rebound
      const PreparedScene p =
          prepare(gold({fmt::format("waveform.main.level={}", level), fmt::format("simulate.duration={}", window)}));
      const ClosingOptions run{.duration = p.duration, .tolerance = 1e-4, .closed_potential = -1e-12};
      const Trajectory t = simulate_closing(p.model, p.signals(), run);
      MetricsObserver observer(t.contact_gap, options);
      const Trajectory end = observe_closing(p.model, p.signals(), run, observer);
      EXPECT_TRUE(end.points.empty() && end.touches.empty());
      EXPECT_EQ(end.status, t.status);
      const Metrics own = observer.metrics(end);
      SCOPED_TRACE(fmt::format("{} {}", level, window));
      ASSERT_TRUE(own.is_complete());
      EXPECT_EQ(own.drive_energy, t.energy.source_work);
      EXPECT_EQ(own.end, t.points.back().time);
      ASSERT_EQ(own.touched(), !t.touches.empty());
      if (!own.touched()) {
        double closest = t.contact_gap;
        for (const TrajectoryPoint& point : t.points) closest = std::min(closest, t.contact_gap - point.position);
        EXPECT_EQ(own.closest, closest);
        EXPECT_TRUE(std::isnan(own.separated));
        continue;
      }
      EXPECT_EQ(own.initial_contact_time, t.touches.front().begin);
      double force = 0, energy = 0, speed = 0;
      for (const Touch& touch : t.touches) {
        force = std::max(force, touch.peak_force), speed = std::max(speed, touch.impact_velocity);
        energy += touch.peak_energy;
      }
      EXPECT_EQ(own.peak_contact_force, force);
      EXPECT_EQ(own.impact_energy, energy);
      EXPECT_EQ(own.largest_impact_velocity, speed);
      EXPECT_EQ(std::isnan(own.landing_excess), !std::isfinite(t.landing_excess));
      double separated = 0, height = 0, last_end = own.initial_contact_time;
      for (const Rebound& r : rebounds(t)) {
        const double until = std::isfinite(r.end) ? r.end : t.points.back().time;
        separated += until - r.begin;
        height = std::max(height, r.height);
        if (r.height > options.significant_rebound) last_end = until;
      }
      EXPECT_EQ(own.separated, separated);
      EXPECT_EQ(own.major_bounce_height, height);
      EXPECT_EQ(own.last_rebound_end, last_end);
    }
  }
}

TEST(Cost, IsFiniteWhereTheEnergyWasNotMeasured) {
  Trajectory t = plain_step();
  t.landing_excess = std::numeric_limits<double>::quiet_NaN();
  for (const Target target : every_target) EXPECT_TRUE(std::isfinite(cost(target, t, scale(), options))) << to_string(target);
}

TEST(Cost, OfASwitchThatReopensIsMoreThanOfAnyThatStays) {
  // The switch touches softly, opens again, and is in flight when the run ends.
  Trajectory reopening = landing(20e-6, 0.01, 0, 0, 0);
  reopening.landing_excess = std::numeric_limits<double>::quiet_NaN();
  reopening.touches[0].end = 22e-6;
  reopening.points.back() = {22e-6, gap, -0.02, 0, 0};
  reopening.points.push_back({20e-6 + score_window, 0.2 * gap, 0, 0, 0});
  EXPECT_TRUE(metrics(reopening, options).reopened);
  EXPECT_FALSE(metrics(plain_step(), options).reopened);
  for (const Target target : every_target) {
    for (const double speed : {0.01, 0.3, 0.6}) {
      EXPECT_GT(cost(target, reopening, scale(), options),
                cost(target, landing(20e-6, speed, 900e-9, 40e-6, 3e-12), scale(), options))
          << to_string(target);
    }
    Trajectory away = landing(20e-6, 0.01, 0, 0, 0);
    away.touches.clear();
    away.points.resize(1);
    EXPECT_LT(cost(target, reopening, scale(), options), cost(target, away, scale(), options)) << to_string(target);
  }
}

TEST(Cost, IsFiniteWhereTheStepItselfLandsSoftly) {
  CostScale soft = scale();
  soft.step = metrics(landing(20e-6, 0.01, 0, 0, 0), options);
  for (const Target target : every_target) {
    EXPECT_TRUE(std::isfinite(cost(target, plain_step(), soft, options))) << to_string(target);
    EXPECT_LT(cost(target, landing(20e-6, 0.01, 0, 0, 0), soft, options), cost(target, plain_step(), soft, options))
        << to_string(target);
  }
}

}  // namespace
}  // namespace softland
