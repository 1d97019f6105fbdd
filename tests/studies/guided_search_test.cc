// A search that one cost leads and another one finishes, on analytic functions.
#include "studies/search/guided_search.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

namespace softland {
namespace {

// The own cost has two valleys, at -0.6 and 0.6. The leading cost has only the right one, which is less deep in the own cost.
SearchCosts prices(std::span<const double> x) {
  const double u = x[0] - 0.6, v = x[1] - 0.2;
  const double guide = u * u + v * v;
  const double own = guide < 0.04 ? std::abs(x[0] - 0.65) + std::abs(x[1] - 0.2) - 1 : 1 + std::abs(x[0] + 0.6);
  return {.guide = guide, .target = own};
}

struct StagesLog {
  std::map<long, Evaluation> evaluations;
  OptimizerResult result;
};

StagesLog search_in_stages(OptimizerOptions options, Costs costs = Costs::both,
                           const std::function<SearchCosts(std::span<const double>)>& f = prices) {
  StagesLog log;
  GuidedSearch stages(f, [&](const Evaluation& e) { EXPECT_TRUE(log.evaluations.emplace(e.index, e).second) << e.index; });
  log.result = stages.run({.variables = {{"a", -1, 1}, {"b", -1, 1}}, .starts = {{-0.6, 0.9}}}, options, costs);
  return log;
}

TEST(GuidedSearch, FollowTheLeadingCostFirstAndTheirOwnToItsMinimum) {
  const StagesLog log = search_in_stages({.max_evaluations = 1500});
  EXPECT_NEAR(log.result.value, -1, 1e-3);
  EXPECT_NEAR(log.result.x[0], 0.65, 1e-3);
}

TEST(GuidedSearch, LogTheOwnCostOfEveryEvaluation) {
  const StagesLog log = search_in_stages({.max_evaluations = 100});
  EXPECT_EQ(log.result.evaluations, 100);
  EXPECT_EQ(log.evaluations.size(), 100U);
  for (const auto& [index, e] : log.evaluations) EXPECT_EQ(e.value, prices(e.x).target) << index;
  double best = std::numeric_limits<double>::infinity();
  std::vector<long> improving;
  for (const auto& [index, e] : log.evaluations) {
    if (!(e.value < best)) continue;
    best = e.value;
    improving.push_back(index);
  }
  ASSERT_EQ(log.result.improvements.size(), improving.size());
  for (std::size_t k = 0; k < improving.size(); ++k) EXPECT_EQ(log.result.improvements[k].index, improving[k]);
  EXPECT_EQ(log.result.value, best);
}

TEST(GuidedSearch, AreTheSameWhateverTheNumberOfJobs_optimized) {
  const StagesLog one = search_in_stages({.max_evaluations = 200}), three = search_in_stages({.max_evaluations = 200, .jobs = 3});
  ASSERT_EQ(one.evaluations.size(), three.evaluations.size());
  for (const auto& [index, e] : one.evaluations) {
    ASSERT_TRUE(three.evaluations.contains(index)) << index;
    EXPECT_EQ(three.evaluations.at(index).x, e.x) << index;
  }
  EXPECT_EQ(one.result.x, three.result.x);
}

TEST(GuidedSearch, AreOneWhereTheCostsAreTheSame) {
  const auto bowl = [](std::span<const double> x) {
    return SearchCosts{.guide = x[0] * x[0] + x[1], .target = x[0] * x[0] + x[1]};
  };
  const StagesLog log = search_in_stages({.max_evaluations = 80}, Costs::same, bowl);
  const OptimizerResult alone = minimize({.variables = {{"a", -1, 1}, {"b", -1, 1}},
                                          .objective = [&](std::span<const double> x) { return bowl(x).target; },
                                          .starts = {{-0.6, 0.9}}},
                                         {.max_evaluations = 80});
  EXPECT_EQ(log.result.x, alone.x);
  EXPECT_EQ(log.result.evaluations, alone.evaluations);
  EXPECT_EQ(log.result.message, alone.message);
  EXPECT_EQ(log.result.improvements.size(), alone.improvements.size());
}

TEST(GuidedSearch, GoOnFromTheBestPointsWhereNoneHasLandedAndMoreIsGranted) {
  for (const bool lands : {true, false}) {
    const auto bowl = [&](std::span<const double> x) {
      const double cost = x[0] * x[0] + x[1] * x[1];
      return SearchCosts{.guide = cost, .target = cost, .bounce_free = lands};
    };
    std::map<long, Evaluation> seen;
    GuidedSearch stages(bowl, [&](const Evaluation& e) { seen.emplace(e.index, e); });
    const OptimizerResult result = stages.run({.variables = {{"a", -1, 1}, {"b", -1, 1}}, .starts = {{-0.6, 0.9}}},
                                              {.max_evaluations = 40}, Costs::same, 25);
    EXPECT_EQ(result.evaluations, lands ? 40 : 65);
    EXPECT_EQ(seen.size(), lands ? 40U : 65U);
  }
}

TEST(GuidedSearch, KnowTheSurestOfThePromisingPoints) {
  GuidedSearch stages(prices, [](const Evaluation&) {});
  const OptimizerResult result =
      stages.run({.variables = {{"a", -1, 1}, {"b", -1, 1}}, .starts = {{-0.6, 0.9}}}, {.max_evaluations = 300}, Costs::both);
  const double below = result.value + 0.3;
  const auto surest = stages.surest_below(below, {});
  ASSERT_TRUE(surest);
  EXPECT_LT(surest->value, below);
  const auto next = stages.surest_below(below, {surest->x});
  ASSERT_TRUE(next);
  EXPECT_NE(next->x, surest->x);
  EXPECT_LE(prices(surest->x).guide, prices(next->x).guide);
  EXPECT_FALSE(stages.surest_below(result.value, {}));
}

TEST(GuidedSearch, GoOnFromTheBestPointsInAFurtherRun) {
  std::map<long, Evaluation> seen;
  const auto bowl = [](std::span<const double> x) {
    const double cost = x[0] * x[0] + x[1] * x[1];
    return SearchCosts{.guide = cost, .target = cost};
  };
  GuidedSearch stages(bowl, [&](const Evaluation& e) { seen.emplace(e.index, e); });
  const Problem problem{.variables = {{"a", -1, 1}, {"b", -1, 1}}, .starts = {{-0.6, 0.9}}};
  const OptimizerResult first = stages.run(problem, {.max_evaluations = 40}, Costs::same);
  const long next = 1000;
  const OptimizerResult all = stages.run(problem, {.max_evaluations = 40}, Costs::same, 0, next);
  EXPECT_EQ(seen.at(next).x, first.x);
  EXPECT_EQ(stages.log().size(), 80U);
  EXPECT_LE(all.value, first.value);
  EXPECT_EQ(all.improvements.front().index, 0) << "of both runs";
}

TEST(GuidedSearch, FollowOneCostAloneWhereTold) {
  GuidedSearch stages(prices, [](const Evaluation&) {});
  const Problem problem{.variables = {{"a", -1, 1}, {"b", -1, 1}}, .starts = {{-0.6, 0.9}}};
  const OptimizerResult first = stages.run(problem, {.max_evaluations = 400}, Costs::guide);
  EXPECT_EQ(first.evaluations, 400);
  const auto guide = stages.best(Costs::guide);
  ASSERT_TRUE(guide);
  EXPECT_NEAR(guide->cost, 0, 1e-6);
  EXPECT_EQ(guide->cost, prices(guide->evaluation.x).guide);
  const OptimizerResult all = stages.run(problem, {.max_evaluations = 400}, Costs::target, 0, 400);
  const auto own = stages.best(Costs::target);
  ASSERT_TRUE(own);
  EXPECT_NEAR(own->cost, -1, 1e-3);
  EXPECT_EQ(all.value, own->cost);
  EXPECT_LT(own->cost, prices(guide->evaluation.x).target);
}

TEST(GuidedSearch, EndWithTheFirstWhenToldToStop) {
  std::atomic<bool> stop = false;
  std::atomic<long> calls = 0;
  const auto counting = [&](std::span<const double> x) {
    if (++calls == 12) stop = true;
    return prices(x);
  };
  const StagesLog log = search_in_stages({.max_evaluations = 1000, .stop = &stop}, Costs::both, counting);
  EXPECT_EQ(log.result.termination, Termination::interrupted);
  EXPECT_EQ(log.result.evaluations, 12);
}

TEST(GuidedSearch, KeepAnInfeasiblePointAndOneThatThrows) {
  const auto failing = [](std::span<const double> x) -> SearchCosts {
    if (x[0] > 0.5) throw std::runtime_error("too far");
    if (x[0] > 0.2) return {};
    return {.guide = x[0] * x[0], .target = x[1] * x[1]};
  };
  const StagesLog log = search_in_stages({.max_evaluations = 600}, Costs::both, failing);
  EXPECT_EQ(log.result.first_exception, "too far");
  EXPECT_TRUE(std::isfinite(log.result.value));
  for (const auto& [index, e] : log.evaluations) EXPECT_EQ(std::isfinite(e.value), e.x[0] <= 0.2) << index;
}

TEST(GuidedSearch, WithoutAFeasiblePointSaySo) {
  const StagesLog log =
      search_in_stages({.max_evaluations = 20}, Costs::both, [](std::span<const double>) { return SearchCosts{}; });
  EXPECT_EQ(log.result.termination, Termination::no_feasible_point);
  EXPECT_TRUE(log.result.x.empty());
}

}  // namespace
}  // namespace softland
