// Tests optimizers on failing objectives: NaN, infinities, exceptions, plateaus, steps. Each case is a failure that occurred in
// one of the libraries.
#include <cmath>
#include <stdexcept>

#include "tests/optimizers/landscapes.h"
#include "tests/optimizers/support.h"
#include "tests/support/not_finite.h"

namespace softland {
namespace {

using landscapes::bowl;
using landscapes::box;

constexpr long kBudget = 250;

struct Counted {
  OptimizerResult result;
  long calls = 0;
};

/// Runs on one thread and counts the calls of the objective.
Counted run(const std::string& optimizer, const std::function<double(std::span<const double>)>& objective,
            std::size_t dimension = 3, long budget = kBudget) {
  Counted counted;
  const auto count = [&](std::span<const double> x) {
    ++counted.calls;
    return objective(x);
  };
  counted.result = minimize(box(dimension, -1, 1, count), {.optimizer = optimizer, .max_evaluations = budget});
  EXPECT_EQ(counted.result.evaluations, counted.calls);
  EXPECT_LE(counted.calls, budget);
  return counted;
}

using Failing = EveryOptimizer;
INSTANTIATE_TEST_SUITE_P(Optimizers, Failing, testing::ValuesIn(every_name()), case_name);

TEST_P(Failing, AnObjectiveThatIsAlwaysNanHasNoFeasiblePoint) {
  const OptimizerResult result = run(GetParam(), [](auto) { return kNaN; }).result;
  EXPECT_EQ(result.termination, Termination::no_feasible_point);
  EXPECT_TRUE(result.x.empty());
  EXPECT_TRUE(std::isnan(result.value));
  EXPECT_TRUE(result.improvements.empty());
  EXPECT_THAT(result.message, testing::HasSubstr("none of "));
}

TEST_P(Failing, InfinitiesOfEitherSignAreInfeasible) {
  for (const double value : {kInfinity, -kInfinity}) {
    const OptimizerResult result = run(GetParam(), [&](auto) { return value; }).result;
    EXPECT_EQ(result.termination, Termination::no_feasible_point);
    EXPECT_TRUE(result.x.empty());
  }
}

TEST_P(Failing, AnObjectiveThatAlwaysThrowsKeepsTheFirstException) {
  int calls = 0;
  const OptimizerResult result =
      run(GetParam(), [&](auto) -> double { throw std::invalid_argument("call " + std::to_string(++calls)); }).result;
  EXPECT_EQ(result.termination, Termination::no_feasible_point);
  EXPECT_EQ(result.first_exception, "call 1");
}

TEST_P(Failing, AnythingMayBeThrown) {
  const OptimizerResult result = run(GetParam(), [](auto) -> double { throw 42; }).result;
  EXPECT_EQ(result.termination, Termination::no_feasible_point);
  EXPECT_EQ(result.first_exception, "an exception that is not a std::exception");
}

TEST_P(Failing, AHalfSpaceOfNanHidesNoMinimumBeyondIt) {
  // The minimum of the feasible half is on its border, where differences have one side only.
  const OptimizerResult result = run(GetParam(), [](auto x) { return x[0] < 0.4 ? kNaN : bowl(x); }).result;
  ASSERT_FALSE(result.x.empty());
  EXPECT_GE(result.x[0], 0.4);
  EXPECT_EQ(result.value, bowl(result.x));
  // 0.01 on the border; the global methods come this close with this budget
  EXPECT_LT(result.value, 0.3);
}

TEST_P(Failing, OccasionalExceptionsDoNotEndTheSearch) {
  const OptimizerResult result = run(GetParam(), [](auto x) {
                                   if (x[0] > 0.6) throw std::runtime_error("too far");
                                   return bowl(x);
                                 }).result;
  ASSERT_FALSE(result.x.empty());
  EXPECT_LT(result.value, 0.1);
  EXPECT_THAT(result.first_exception, testing::AnyOf("", "too far"));
}

TEST_P(Failing, HugeValuesOverflowNothing) {
  const OptimizerResult result = run(GetParam(), [](auto x) { return 1e307 * (bowl(x) - 0.5); }).result;
  ASSERT_FALSE(result.x.empty());
  EXPECT_LT(result.value, -2e306);
}

TEST_P(Failing, AStaircaseIsSearchedUntilTheBudgetIsUsed) {
  const Counted counted = run(GetParam(), [](auto x) { return std::floor(5 * bowl(x)); });
  ASSERT_FALSE(counted.result.x.empty());
  EXPECT_LE(counted.result.value, 2);
  if (counted.result.termination != Termination::converged) {
    EXPECT_EQ(counted.calls, kBudget);
  }
}

TEST_P(Failing, AConstantObjectiveEnds) {
  const OptimizerResult result = run(GetParam(), [](auto) { return 3.0; }).result;
  EXPECT_EQ(result.value, 3.0);
  EXPECT_EQ(result.improvements.size(), 1u);
  EXPECT_THAT(result.termination, testing::AnyOf(Termination::converged, Termination::evaluation_budget));
}

TEST_P(Failing, TheBudgetIsNeverExceeded) {
  for (const long budget : {1L, 2L, 3L, 10L, 57L}) {
    for (const bool failing : {false, true}) {
      const auto objective = [&](std::span<const double> x) { return failing && x[0] * x[1] > 0 ? kNaN : bowl(x); };
      const Counted counted = run(GetParam(), objective, 4, budget);
      EXPECT_GE(counted.calls, 1);
      EXPECT_NE(counted.result.termination, Termination::not_run);
      EXPECT_NE(counted.result.termination, Termination::failure) << counted.result.message;
    }
  }
}

TEST(Penalty, IsMetByMethodsThatComparePointsAsWorseThanTheWorst) {
  // The start is in the infeasible half: the simplex must leave it, although all finite values are enormous.
  const auto objective = [](std::span<const double> x) { return x[0] < 0 ? kNaN : 1e14 + 1e13 * bowl(x); };
  Problem problem = box(2, -1, 1, objective);
  problem.starts = {{-0.1, 0.0}};
  const OptimizerResult result = minimize(problem, {.optimizer = "nelder-mead", .max_evaluations = 100});
  ASSERT_FALSE(result.x.empty());
  EXPECT_LT(result.value, 1e14 + 1e10);
}

TEST(Result, IsNotFooledByAnExceptionInACallback) {
  const OptimizerResult result = minimize(
      box(2, -1, 1, bowl),
      {.max_evaluations = 100, .jobs = 2, .on_evaluation = [](const Evaluation&) { throw std::runtime_error("disk full"); }});
  EXPECT_EQ(result.termination, Termination::failure);
  EXPECT_EQ(result.message, "on_evaluation or on_improvement threw: disk full");
  EXPECT_LE(result.evaluations, 2);
}

}  // namespace
}  // namespace softland
