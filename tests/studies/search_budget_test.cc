// The budget of a search and its parts, on a clock that the test sets.
#include "studies/search/search_budget.h"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace softland::search_budget_test {
namespace {

TEST(SearchBudget, CountsWhatItsPartsTake) {
  SearchBudget whole({.evaluations = 100});
  SearchBudget part(whole, 40), part_of_part(part, 10);
  whole.took(1);
  part.took(20);
  part_of_part.took(12);
  EXPECT_EQ(whole.taken(), 33);
  EXPECT_EQ(whole.left(), 67);
  EXPECT_EQ(part.taken(), 32);
  EXPECT_EQ(part.share_taken(), 0.8);
  EXPECT_EQ(part_of_part.left(), -2);
  EXPECT_EQ(part_of_part.share_taken(), 1);
  part.allow(64);
  EXPECT_EQ(part.share_taken(), 0.5);
}

TEST(SearchBudget, IsOverWhenItsTimeIsUp) {
  double now = 100;
  SearchBudget whole({.seconds = 60, .clock = [&] { return now; }});
  now = 130;
  const SearchBudget part(whole, 1, 20), as_long(whole, 1);
  EXPECT_EQ(whole.elapsed(), 30);
  EXPECT_EQ(whole.seconds_left(0.75), 15);
  EXPECT_EQ(as_long.seconds(), 30);
  now = 150;
  EXPECT_FALSE(part.over());
  now = 151;
  EXPECT_TRUE(part.over() && part.out_of_time() && !part.interrupted());
  EXPECT_FALSE(whole.over() || as_long.over());
  now = 161;
  EXPECT_TRUE(whole.over() && as_long.over());
}

TEST(SearchBudget, LeavesOutTheTimeOfWorkThatDoesNotCount) {
  double now = 0;
  SearchBudget budget({.seconds = 10, .clock = [&] { return now; }});
  now = 4;
  budget.leave_out([&] { now = 1000; });
  EXPECT_EQ(budget.elapsed(), 4);
  EXPECT_FALSE(budget.over());
}

TEST(SearchBudget, WithoutLimitsEndsWhenAsked) {
  std::atomic<bool> stop = false;
  SearchBudget whole({.stop = &stop});
  SearchBudget part(whole, 1), other(whole, 1);
  EXPECT_EQ(part.seconds(), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(part.over());
  part.give_up();
  EXPECT_TRUE(part.over());
  EXPECT_FALSE(whole.over() || other.over());
  whole.give_up();
  EXPECT_TRUE(other.over() && other.given_up() && !other.interrupted());
  stop = true;
  EXPECT_TRUE(other.interrupted());
}

TEST(SearchBudget, IsWhatAMinimisationTakesAndTells) {
  SearchBudget budget({.evaluations = 30});
  budget.took(5);
  std::vector<double> parts;
  const Progress progress{.report = [&](std::string_view what, double part) {
    EXPECT_EQ(what, "points");
    parts.push_back(part);
  }};
  const auto square = [](std::span<const double> x) { return x[0] * x[0]; };
  const OptimizerResult found =
      minimize_within(budget, {.variables = {{"x", -1, 2}}, .objective = square}, 1, 1, progress, "points");
  EXPECT_EQ(found.evaluations, 25);
  EXPECT_EQ(budget.left(), 0);
  ASSERT_EQ(parts.size(), 25U);
  EXPECT_EQ(parts.front(), 6.0 / 30);
  EXPECT_EQ(parts.back(), 1);
}

}  // namespace
}  // namespace softland::search_budget_test
