// Tests the contract of problem.h.
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <thread>

#include "base/require.h"
#include "tests/optimizers/landscapes.h"
#include "tests/optimizers/support.h"

namespace softland {
namespace {

using landscapes::bowl;
using landscapes::box;
using namespace std::chrono_literals;

/// A landing that is infeasible in some places, in three ways, and whose evaluation takes longer in one half.
double difficult(std::span<const double> x) {
  if (x[0] < 0.375) {
    for (int i = 0; i < 5; ++i) static_cast<void>(landscapes::landing_4(x));
  }
  if (x[1] > 0.7) throw std::runtime_error("level " + std::to_string(x[1]));
  if (x[2] > 3.5) return std::numeric_limits<double>::quiet_NaN();
  if (x[3] > 3.8) return std::numeric_limits<double>::infinity();
  return landscapes::landing_4(x);
}

Problem difficult_problem() {
  Problem problem = landscapes::landing_problem(2);
  problem.objective = difficult;
  return problem;
}

std::string message_of(const Problem& problem, const OptimizerOptions& options) {
  try {
    static_cast<void>(minimize(problem, options));
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "nothing was refused";
}

using Minimize = EveryOptimizer;
INSTANTIATE_TEST_SUITE_P(Optimizers, Minimize, testing::ValuesIn(every_name()), case_name);

TEST_P(Minimize, GivesTheSameBitsForAnyNumberOfJobs) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const auto run = [&](int jobs) {
      return minimize(difficult_problem(), {.optimizer = GetParam(), .max_evaluations = 400, .seed = seed, .jobs = jobs});
    };
    const OptimizerResult alone = run(1);
    EXPECT_FALSE(alone.x.empty());
    for (const int jobs : {1, 2, 3, 8}) expect_same(run(jobs), alone);
  }
}

TEST_P(Minimize, StopsAtTheTargetWithTheSameResultForAnyNumberOfJobs) {
  for (const double target : {0.9, 0.35, 0.15}) {
    const auto run = [&](int jobs) {
      return minimize(difficult_problem(), {.optimizer = GetParam(), .max_evaluations = 400, .jobs = jobs, .target = target});
    };
    const OptimizerResult alone = run(1);
    if (alone.termination == Termination::target_reached) {
      EXPECT_LE(alone.value, target);
      // Only the last improvement reaches the target.
      for (std::size_t k = 0; k + 1 < alone.improvements.size(); ++k) EXPECT_GT(alone.improvements[k].value, target);
    } else {
      EXPECT_GT(alone.value, target);
    }
    for (const int jobs : {2, 3, 8}) expect_same(run(jobs), alone);
  }
}

TEST_P(Minimize, LooksElsewhereWithAnotherSeed) {
  const auto first_points = [&](std::uint64_t seed) {
    std::set<std::vector<double>> points;
    static_cast<void>(minimize(
        box(3, 0, 1, bowl), {.optimizer = GetParam(), .max_evaluations = 60, .seed = seed, .on_evaluation = [&](const auto& e) {
                               points.insert(e.x);
                             }}));
    return points;
  };
  const auto one = first_points(1);
  const auto two = first_points(2);
  std::vector<std::vector<double>> common;
  std::set_intersection(one.begin(), one.end(), two.begin(), two.end(), std::back_inserter(common));
  EXPECT_LE(common.size(), one.size() / 4);
}

TEST_P(Minimize, StaysWithinTheBoundsExactly) {
  const double lower = 0.1;
  const double upper = 0.1 + 0.7;  // sums that have no exact representation: scaling back rounds
  Problem problem = box(3, lower, upper, [&](std::span<const double> x) {
    EXPECT_THAT(x, testing::Each(testing::AllOf(testing::Ge(lower), testing::Le(upper))));
    return -x[0] - x[1] + x[2];
  });
  const OptimizerResult result = minimize(problem, {.optimizer = GetParam(), .max_evaluations = 300});
  EXPECT_THAT(result.x, testing::Each(testing::AllOf(testing::Ge(lower), testing::Le(upper))));
}

TEST_P(Minimize, HoldsAVariableWhoseBoundsAreEqual) {
  Problem problem = box(3, 0, 1, bowl);
  problem.variables[1] = {.name = "held", .lower = 0.7, .upper = 0.7};
  long calls = 0;
  problem.objective = [&](std::span<const double> x) {
    ++calls;
    EXPECT_EQ(x[1], 0.7);
    return bowl(x);
  };
  const OptimizerResult result = minimize(problem, {.optimizer = GetParam(), .max_evaluations = 200});
  EXPECT_EQ(result.evaluations, calls);
  ASSERT_EQ(result.x.size(), 3u);
  EXPECT_EQ(result.x[1], 0.7);
  EXPECT_LT(result.value, 0.16 + 0.05);
}

TEST_P(Minimize, EvaluatesOnceWhenAllVariablesAreHeld) {
  const OptimizerResult result = minimize(box(2, 0.5, 0.5, bowl), {.optimizer = GetParam()});
  EXPECT_EQ(result.evaluations, 1);
  EXPECT_EQ(result.x, (std::vector{0.5, 0.5}));
  EXPECT_EQ(result.termination, Termination::converged);
}

TEST_P(Minimize, WorksInOneVariable) {
  const OptimizerResult result = minimize(box(1, -3, 5, bowl), {.optimizer = GetParam(), .max_evaluations = 200});
  ASSERT_EQ(result.x.size(), 1u);
  const bool coarse = GetParam() == "isres" || GetParam() == "esch";
  EXPECT_NEAR(result.x[0], 0.3, coarse ? 0.05 : 1e-3);
}

TEST_P(Minimize, KeepsToTheTimeBudget) {
  const auto slow = [](std::span<const double> x) {
    std::this_thread::sleep_for(2ms);
    return landscapes::rosenbrock(x);
  };
  const auto begin = std::chrono::steady_clock::now();
  const OptimizerResult result =
      minimize(box(3, -2, 2, slow), {.optimizer = GetParam(), .max_evaluations = 1'000'000, .max_seconds = 0.05, .jobs = 2});
  const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_EQ(result.termination, Termination::time_budget);
  EXPECT_EQ(result.message, "time budget of 0.05 s used up after " + std::to_string(result.evaluations) + " evaluations");
  EXPECT_FALSE(result.x.empty());
  EXPECT_GE(taken, 0.05);
  EXPECT_LT(taken, 2);  // a generous limit for a busy machine
}

TEST_P(Minimize, EndsWhenTheStopFlagIsSet) {
  std::atomic<bool> stop = false;
  long calls = 0;
  const auto objective = [&](std::span<const double> x) {
    if (++calls == 12) stop = true;
    return landscapes::rosenbrock(x);
  };
  const OptimizerResult result = minimize(box(3, -2, 2, objective), {.optimizer = GetParam(), .stop = &stop});
  EXPECT_EQ(result.termination, Termination::interrupted);
  EXPECT_EQ(result.evaluations, 12);
  EXPECT_EQ(calls, 12);
  EXPECT_FALSE(result.x.empty());
}

TEST_P(Minimize, EndsBeforeTheFirstEvaluationWhereItIsToldTo) {
  const std::atomic<bool> stop = true;
  Problem problem = box(2, -2, 2, landscapes::rosenbrock);
  problem.starts = {{0, 0}, {1, 0}};
  const OptimizerResult result = minimize(problem, {.optimizer = GetParam(), .stop = &stop});
  EXPECT_EQ(result.termination, Termination::interrupted);
  EXPECT_EQ(result.evaluations, 0);
  EXPECT_TRUE(result.x.empty());
}

TEST_P(Minimize, EvaluatesTheStartsFirstAndToTheLastDigit) {
  Problem problem = box(2, 1e-6, 9.7e-5, [](std::span<const double> x) { return x[0] + x[1]; });
  // Several starts, since scaling there and back keeps the digits of some.
  for (int k = 1; k <= 10; ++k) problem.starts.push_back({k * 0.91e-5, k * 0.37e-5});
  auto expected = problem.starts;
  problem.starts.push_back({3.7e-5, 1.0});  // outside of the bounds: moved to the bound
  expected.push_back({3.7e-5, 9.7e-5});
  std::vector<std::vector<double>> points;
  const auto note = [&](const Evaluation& evaluation) { points.push_back(evaluation.x); };
  static_cast<void>(minimize(problem, {.optimizer = GetParam(), .max_evaluations = 20, .on_evaluation = note}));
  ASSERT_GE(points.size(), expected.size());
  points.resize(expected.size());
  EXPECT_EQ(points, expected);
}

TEST_P(Minimize, NeverEvaluatesAPointTwice) {
  std::set<std::vector<double>> seen;
  long calls = 0;
  const auto objective = [&](std::span<const double> x) {
    seen.emplace(x.begin(), x.end());
    ++calls;
    return landscapes::creases(x);
  };
  Problem problem = box(2, -2, 2, objective);
  problem.starts = {{0, 0}, {0, 0}};
  static_cast<void>(minimize(problem, {.optimizer = GetParam(), .max_evaluations = 400}));
  // `auto` may evaluate a point in two searches of a round. Rounding by scaling may merge two neighbours.
  EXPECT_GE(static_cast<long>(seen.size()), calls - 4);
}

TEST_P(Minimize, ReportsLiveWhatTheResultSays) {
  const auto run = [&](int jobs) {
    std::map<long, Evaluation> all;
    std::vector<Evaluation> improvements;
    const OptimizerResult result =
        minimize(difficult_problem(), {.optimizer = GetParam(),
                                       .max_evaluations = 300,
                                       .jobs = jobs,
                                       .on_evaluation = [&](const auto& e) { all.emplace(e.index, e); },
                                       .on_improvement = [&](const auto& e) { improvements.push_back(e); }});
    EXPECT_EQ(static_cast<long>(all.size()), result.evaluations);  // so all indices differ
    for (const Evaluation& improvement : result.improvements) expect_same(all.at(improvement.index), improvement);
    EXPECT_EQ(improvements.back().value, result.value);
    if (jobs == 1) {
      EXPECT_EQ(improvements.size(), result.improvements.size());
    }
    std::vector<long> indices;
    for (const auto& entry : all) indices.push_back(entry.first);
    return indices;
  };
  EXPECT_EQ(run(1), run(3));
}

TEST_P(Minimize, HasADescriptionOfOneLine) {
  EXPECT_FALSE(optimizer_description(GetParam()).empty());
  EXPECT_THAT(std::string(optimizer_description(GetParam())), testing::Not(testing::HasSubstr("\n")));
}

const std::string choices = [] {
  std::string text = "one of ";
  for (const std::string_view name : optimizer_names())
    text += (name == optimizer_names().front() ? "" : ", ") + std::string(name);
  return text;
}();

TEST(OptimizerNames, AutoComesFirst) { EXPECT_EQ(optimizer_names().front(), "auto"); }

TEST(OptimizerNames, AnUnknownNameIsAnsweredWithTheNamesThereAre) {
  EXPECT_EQ(message_of(box(1, 0, 1, bowl), {.optimizer = "simplex"}), "optimizer simplex: must be " + choices);
  EXPECT_EQ(message_of(box(1, 0, 1, bowl), {.optimizer = "bobyq"}),
            "optimizer bobyq: must be " + choices + " (did you mean 'bobyqa'?)");
  EXPECT_THROW(static_cast<void>(optimizer_description("simplex")), InvalidInput);
}

TEST(OptimizerNames, MethodsThatCannotBeTrustedAreRefusedWithTheReason) {
  const std::map<std::string, std::string> reasons = {
      {"AGS", "it crashes on non-finite values"},  {"stogo", "it swallows exceptions and reports success"},
      {"newuoa", "it hangs on non-finite values"}, {"NEWUOA_BOUND", "it hangs on non-finite values"},
      {"Praxis", "it is not repeatable"},          {"cobyla", "it can hang between evaluations, where no budget reaches it"}};
  for (const auto& [name, reason] : reasons) {
    EXPECT_EQ(message_of(box(1, 0, 1, bowl), {.optimizer = name}),
              "optimizer " + name + ": is refused, because " + reason + "; choose " + choices);
  }
}

TEST(BadInput, IsRefusedWithValueAndRule) {
  const auto with = [](auto change) {
    Problem problem = box(2, 0, 1, bowl);
    OptimizerOptions options;
    change(problem, options);
    return message_of(problem, options);
  };
  EXPECT_EQ(with([](auto& p, auto&) { p.variables.clear(); }), "a problem needs at least one variable");
  EXPECT_EQ(with([](auto& p, auto&) { p.objective = nullptr; }), "a problem needs an objective");
  EXPECT_EQ(with([](auto& p, auto&) { p.variables[1].lower = 2; }),
            "variable \"x1\": lower bound 2 must not exceed upper bound 1");
  EXPECT_EQ(with([](auto& p, auto&) { p.variables[0].upper = std::numeric_limits<double>::infinity(); }),
            "variable \"x0\": bounds [0, inf] must be finite");
  EXPECT_EQ(with([](auto& p, auto&) { p.variables[0].lower = std::nan(""); }), "variable \"x0\": bounds [nan, 1] must be finite");
  EXPECT_EQ(with([](auto& p, auto&) { p.starts = {{0.5}}; }), "a start has 1 values; it must have 2, one per variable");
  EXPECT_EQ(with([](auto& p, auto&) { p.starts = {{0.5, std::nan("")}}; }), "variable \"x1\": start nan must be finite");
  EXPECT_EQ(with([](auto&, auto& o) { o.max_evaluations = 0; }), "max_evaluations = 0 must be positive");
  EXPECT_EQ(with([](auto&, auto& o) { o.max_seconds = 0; }), "max_seconds = 0 must be positive");
  EXPECT_EQ(with([](auto&, auto& o) { o.max_seconds = std::nan(""); }), "max_seconds = nan must be positive");
  EXPECT_EQ(with([](auto&, auto& o) { o.jobs = 0; }), "jobs = 0 must be at least 1");
  EXPECT_EQ(with([](auto&, auto& o) { o.population = 0.5; }), "population = 0.5 must be in [1, 1000]");
  EXPECT_EQ(with([](auto&, auto& o) { o.target = std::nan(""); }), "target must not be NaN");
}

TEST(Result, BeginsAsNotRun) {
  EXPECT_EQ(OptimizerResult{}.termination, Termination::not_run);
  EXPECT_EQ(to_string(OptimizerResult{}.termination), "not_run");
  EXPECT_TRUE(std::isnan(OptimizerResult{}.value));
}

TEST(Result, SpansTheWidestBox) {
  constexpr double kHuge = 1.7e308;
  const OptimizerResult result =
      minimize(box(2, -kHuge, kHuge, [](auto x) { return std::abs(x[0] / kHuge) + std::abs(x[1] / kHuge - 0.5); }),
               {.optimizer = "nelder-mead", .max_evaluations = 300});
  EXPECT_NEAR(result.x[1] / kHuge, 0.5, 1e-3);
}

}  // namespace
}  // namespace softland
