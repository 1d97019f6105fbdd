// Tests the values that optimizer libraries receive.
#include "optimizers/evaluation_record.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "tests/optimizers/landscapes.h"
#include "tests/optimizers/support.h"
#include "tests/support/not_finite.h"

namespace softland::internal {
namespace {

using landscapes::box;

/// Gives the body a budgeted problem over [0, 1]^n, in which points equal x.
void with_strand(std::size_t dimension, const std::function<double(std::span<const double>)>& objective,
                 const std::function<void(BudgetedObjective&)>& body, long budget = 1000) {
  const Problem problem = box(dimension, 0, 1, objective);
  const OptimizerOptions options{.max_evaluations = budget};
  EvaluationRecord record(problem, options);
  record.run({{.budget = budget, .body = body}});
}

TEST(Answers, RankInfeasiblePointsBelowEverythingSeen) {
  // x selects a value from a list of all magnitudes; every second point is infeasible.
  const std::vector<double> values = {-1e300, -1e13, -5, 0, 1e-9, 1, 3, 1e11, 1e12, 1e13, 1e14, 1e200, 1.7e308};
  const auto objective = [&](std::span<const double> x) {
    const auto k = static_cast<std::size_t>(std::lround(x[0] * 1000));
    return k % 2 == 0 ? kNaN : values[k / 2];
  };
  with_strand(1, objective, [&](BudgetedObjective& budgeted) {
    double worst = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 2 * values.size(); ++k) {
      const Answer answer = budgeted(std::vector{static_cast<double>(k) / 1000});
      EXPECT_EQ(answer.feasible, k % 2 == 1);
      EXPECT_TRUE(std::isfinite(answer.value * answer.value)) << "libraries square";
      EXPECT_GT(answer.value, worst) << k;  // holds for finite values since the list ascends
      if (answer.feasible) worst = answer.value;
    }
  });
}

TEST(Answers, BeforeAnyFeasiblePointArePenaltiesAboveAnyLaterValue) {
  with_strand(
      1, [](auto x) { return x[0] < 0.5 ? kNaN : std::numeric_limits<double>::max(); },
      [](BudgetedObjective& budgeted) {
        const Answer dark = budgeted(std::vector{0.1});
        EXPECT_GT(dark.value, budgeted(std::vector{0.9}).value);
      });
}

TEST(Answers, AreOfTheSizeOfTheValuesSeen) {
  with_strand(
      1, [](auto x) { return x[0] > 0.5 ? kNaN : x[0]; },
      [](BudgetedObjective& budgeted) {
        budgeted(std::vector{0.1});
        budgeted(std::vector{0.4});
        EXPECT_LT(budgeted(std::vector{0.9}).value, 10);
      });
}

TEST(Answers, ToKnownPointsAreFree) {
  with_strand(
      1, [](auto x) { return x[0]; },
      [](BudgetedObjective& budgeted) {
        for (int i = 0; i < 10; ++i) EXPECT_EQ(budgeted(std::vector{0.25}).value, 0.25);
        EXPECT_EQ(budgeted.evaluations(), 1);
        EXPECT_EQ(budgeted(std::vector{-0.0}).value, 0);
        EXPECT_EQ(budgeted(std::vector{0.0}).value, 0);
        EXPECT_EQ(budgeted(std::vector{-1e-17}).value, 0);  // outside of the bounds by rounding
        EXPECT_EQ(budgeted.evaluations(), 2);
      });
}

TEST(Answers, EndASearchThatGoesInCircles) {
  with_strand(
      1, [](auto x) { return x[0]; },
      [](BudgetedObjective& budgeted) {
        const auto circle = [&] {
          for (int i = 0; i < 1'000'000; ++i) budgeted(std::vector{i % 2 == 0 ? 0.25 : 0.75});
        };
        EXPECT_THROW(circle(), Cut);
        EXPECT_FALSE(budgeted.over()) << "the budget is left for another search";
        budgeted.begin_search();
        EXPECT_EQ(budgeted(std::vector{0.5}).value, 0.5);
      });
}

TEST(Answers, ToNanCoordinatesAreThoseOfTheMiddle) {
  with_strand(
      1, [](auto x) { return x[0]; }, [](BudgetedObjective& budgeted) { EXPECT_EQ(budgeted(std::vector{kNaN}).value, 0.5); });
}

TEST(Answers, EndWithTheBudget) {
  with_strand(
      1, [](auto x) { return x[0]; },
      [](BudgetedObjective& budgeted) {
        budgeted(std::vector{0.1});
        budgeted(std::vector{0.2});
        EXPECT_TRUE(budgeted.over());
        EXPECT_THROW(budgeted(std::vector{0.3}), Cut);
        EXPECT_THROW(budgeted(std::vector{0.1}), Cut) << "once cut, a library is not to go on among known points";
      },
      2);
}

TEST(Rounds, EndWithTheFirstTaskAtTheTargetEvenWhenALaterOneIsThereSooner) {
  std::atomic<int> tasks_there = 0;
  const Problem problem = box(1, 0, 1, [](auto x) { return x[0]; });
  const OptimizerOptions options{.jobs = 3, .target = 0.2};
  EvaluationRecord record(problem, options);
  // The last task reaches the goal first, then the second, then the first.
  const auto reach = [&tasks_there](int place, double goal) {
    return [&tasks_there, place, goal](BudgetedObjective& budgeted) {
      budgeted(std::vector{goal + 0.7});
      while (tasks_there < place) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      budgeted(std::vector{goal + 0.6});  // an earlier task continues
      try {
        budgeted(std::vector{goal});
      } catch (const Cut&) {
        ++tasks_there;
        throw;
      }
    };
  };
  record.run(
      {{.budget = 5, .body = reach(2, 0.15)}, {.budget = 5, .body = reach(1, 0.1)}, {.budget = 5, .body = reach(0, 0.05)}});
  const OptimizerResult result = record.result(false, "");
  EXPECT_EQ(result.termination, Termination::target_reached);
  EXPECT_EQ(result.value, 0.15);
  EXPECT_EQ(result.evaluations, 3);
  EXPECT_EQ(result.improvements.size(), 3u);
  EXPECT_TRUE(record.over());
}

// A few roundings of values of order 1 at both ends of a step of 1e-5.
constexpr double kDifferenceRounding = 10 * std::numeric_limits<double>::epsilon() / 1e-5;

TEST(Gradient, OfAParabolaIsExactInsideAndAtTheBounds) {
  const auto parabola = [](std::span<const double> x) { return 3 * x[0] * x[0] - x[0] + 2 * x[1] * (1 - x[1]); };
  with_strand(2, parabola, [](BudgetedObjective& budgeted) {
    for (const double u : {0.0, 1e-9, 5e-6, 0.3, 1 - 5e-6, 1.0}) {
      std::vector<double> gradient(2);
      budgeted.gradients(std::vector{u, 1 - u}, gradient);
      EXPECT_NEAR(gradient[0], 6 * u - 1, kDifferenceRounding);
      EXPECT_NEAR(gradient[1], 2 - 4 * (1 - u), kDifferenceRounding);
    }
  });
}

TEST(Gradient, TakesDifferencesAwayFromInfeasiblePoints) {
  const auto line = [](std::span<const double> x) { return x[0] < 0.5 ? kNaN : 2 * x[0]; };
  with_strand(1, line, [](BudgetedObjective& budgeted) {
    std::vector<double> gradient(1);
    budgeted.gradients(std::vector{0.5}, gradient);
    EXPECT_NEAR(gradient[0], 2, kDifferenceRounding);
    budgeted.gradients(std::vector{0.1}, gradient);
    EXPECT_EQ(gradient[0], 0);
  });
}

TEST(Gradient, OfAnObjectiveOfShortSmoothPiecesIsThatOfThePiece) {
  // Pieces of a five-thousandth of the box, with jumps between them.
  const auto pieces = [](std::span<const double> x) { return 3 * x[0] + 0.1 * std::fmod(std::floor(5000 * x[0]), 2); };
  with_strand(1, pieces, [](BudgetedObjective& budgeted) {
    for (const double middle : {0.1001, 0.5003, 0.7777}) {
      std::vector<double> gradient(1);
      budgeted.gradients(std::vector{middle}, gradient);
      EXPECT_NEAR(gradient[0], 3, kDifferenceRounding) << middle;
    }
  });
}

TEST(Gradient, CountsAgainstTheBudget) {
  with_strand(
      3, [](auto x) { return x[0]; },
      [](BudgetedObjective& budgeted) {
        std::vector<double> gradient(3);
        budgeted.gradients(std::vector{0.5, 0.5, 0.5}, gradient);
        EXPECT_EQ(budgeted.evaluations(), 7);
      });
}

}  // namespace
}  // namespace softland::internal
