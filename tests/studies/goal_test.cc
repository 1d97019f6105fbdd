// Tests when a search may report that it has reached its goal.
#include <gtest/gtest.h>

#include <cmath>
#include <variant>

#include "scenes.h"
#include "studies/search/optimize.h"

namespace softland {
namespace {

Metrics closing(bool settled, int bounces, double settling_time, double velocity, double energy) {
  Metrics m;
  m.status = settled ? Status::done : Status::not_settled;
  m.settled = settled;
  m.initial_contact_time = 10e-6;
  m.permanent_contact_time = settled ? settling_time : Metrics::unset;
  m.bounce_count = bounces;
  m.major_bounce_height = bounces > 0 ? 50e-9 : 0;
  m.impact_velocity = velocity;
  m.impact_energy = energy;
  for (const TargetRow& row : targets) {  // all other figures have the value of the velocity
    if (const auto* const figure = std::get_if<double Metrics::*>(&row.figure); figure != nullptr && std::isnan(m.*(*figure)))
      m.*(*figure) = velocity;
  }
  return m;
}

const Metrics baseline = closing(true, 7, 40e-6, 0.3, 2e-12);

TEST(GoalMet, NothingUnsettledMeetsAnyGoal) {
  const Metrics soft_but_unsettled = closing(false, 0, 0, 0.01, 1e-15);
  for (const Target target : every_target) EXPECT_FALSE(goal_met(target, soft_but_unsettled, baseline)) << to_string(target);
}

TEST(GoalMet, AClosingThatIsBetterInEveryFigureMeetsEveryGoal) {
  const Metrics better = closing(true, 0, 12e-6, 0.1, 1e-12);
  for (const Target target : every_target) EXPECT_TRUE(goal_met(target, better, baseline)) << to_string(target);
}

TEST(GoalMet, OneSignificantReboundFailsEveryGoalHoweverMuchBetterTheFigure) {
  const Metrics nearly = closing(true, 1, 30e-6, 0.1, 1e-12);
  for (const Target target : every_target) EXPECT_FALSE(goal_met(target, nearly, baseline)) << to_string(target);
}

TEST(GoalMet, WithoutReboundTheBounceTargetsDoNotAskForMore) {
  const Metrics slow_and_hard = closing(true, 0, 90e-6, 0.9, 9e-12);
  for (const Target target : every_target)
    EXPECT_EQ(goal_met(target, slow_and_hard, baseline), !has_own_cost(target)) << to_string(target);
}

TEST(GoalMet, SettlingImpactAndEnergyAskForTheirOwnFigureToo) {
  EXPECT_TRUE(goal_met(Target::settling, closing(true, 0, 12.9e-6, 0.9, 9e-12), baseline));
  EXPECT_FALSE(goal_met(Target::settling, closing(true, 0, 13.1e-6, 0.1, 1e-12), baseline)) << "the step touches at 10 us";
  EXPECT_TRUE(goal_met(Target::impact, closing(true, 0, 90e-6, 0.29, 9e-12), baseline));
  EXPECT_FALSE(goal_met(Target::impact, closing(true, 0, 30e-6, 0.31, 1e-12), baseline));
  EXPECT_TRUE(goal_met(Target::energy, closing(true, 0, 90e-6, 0.9, 1.9e-12), baseline));
  EXPECT_FALSE(goal_met(Target::energy, closing(true, 0, 30e-6, 0.1, 2.1e-12), baseline));
}

TEST(GoalMet, EqualToTheBaselineIsNotBetter) {
  for (const Target target : every_target) EXPECT_FALSE(goal_met(target, baseline, baseline)) << to_string(target);
}

TEST(GoalMet, AnySettledClosingIsBetterThanABaselineThatNeverTouches) {
  Metrics open;
  open.status = Status::no_contact;
  const Metrics settled = closing(true, 0, 90e-6, 0.9, 9e-12);
  for (const Target target : every_target) EXPECT_TRUE(goal_met(target, settled, open)) << to_string(target);
}

}  // namespace
}  // namespace softland
