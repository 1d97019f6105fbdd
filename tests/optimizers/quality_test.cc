// Tests the quality of the optimizers. Rates were measured over 20 seeds (bench/optimizers prints the table). The thresholds
// allow two or three more failures in ten runs, for other compilers.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/optimizers/landscapes.h"
#include "tests/optimizers/support.h"

namespace softland {
namespace {

using landscapes::box;

/// An elongated, rotated bowl with its minimum 0 inside of the box.
double turned_bowl(std::span<const double> x) {
  const double u = (x[0] - 0.2) + 0.5 * (x[1] + 0.4);
  const double v = (x[1] + 0.4) - 0.5 * (x[0] - 0.2);
  return u * u + 20 * v * v;
}

using Quality = EveryOptimizer;
INSTANTIATE_TEST_SUITE_P(Optimizers, Quality, testing::ValuesIn(every_name()), case_name);

TEST_P(Quality, ATurnedBowlIsSolved) {
  // Accuracy of each optimizer after 500 evaluations. Evolution strategies and DIRECT converge slowly near a minimum. The
  // separable models of mma and ccsaq do not fit a rotated bowl.
  const std::map<std::string, double> coarse = {{"isres", 0.1}, {"esch", 0.1}, {"direct-l", 1e-3},
                                                {"crs2", 1e-4}, {"mma", 1e-3}, {"ccsaq", 1e-3}};
  const auto found = coarse.find(GetParam());
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const OptimizerResult result =
        minimize(box(2, -1, 1, turned_bowl), {.optimizer = GetParam(), .max_evaluations = 500, .seed = seed});
    EXPECT_LT(result.value, found == coarse.end() ? 1e-9 : found->second);
    EXPECT_EQ(result.value, turned_bowl(result.x));
  }
}

TEST(Auto, SearchesNearItsStartsBeforeItLooksElsewhere) {
  // A narrow well, a fiftieth of the box wide, with walls, in a wide bowl whose minimum is elsewhere.
  const auto well = [](std::span<const double> x) {
    double square = 0, bowl = 0;
    for (const double v : x) square += std::pow((v - 0.8) / 0.02, 2), bowl += std::pow(v + 0.5, 2);
    return bowl + 1 - 10 * std::exp(-square) + 0.01 * std::abs(x[0] - 0.801);
  };
  Problem problem = box(6, -1, 1, well);
  problem.starts = {std::vector<double>(6, 0.0), std::vector<double>(6, 0.81)};
  const double depth = well(std::vector<double>(6, 0.8)) + 0.01;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const OptimizerResult result = minimize(problem, {.max_evaluations = 1000, .seed = seed});
    EXPECT_LT(result.value, depth) << seed;
  }
}

TEST(Auto, StaysAroundTheBestPointWhereItGoesOn) {
  // A narrow well with ripples oblique to the variables: a method with a gradient stops at the first of them.
  constexpr std::size_t variables = 20;
  constexpr double centre = 0.8, wide = 0.1, ripple = 0.02, high = 0.05, askew = 0.7;
  const auto turned = [](std::span<const double> x) {
    std::vector<double> y;
    for (std::size_t i = 0; i < x.size(); ++i) y.push_back(x[i] - centre + askew * (x[(i + 1) % x.size()] - centre));
    return y;
  };
  const auto depth = [](const std::vector<double>& y) {
    double square = 0;
    for (const double v : y) square += std::pow(v / wide, 2);
    return 10 * std::exp(-square / static_cast<double>(y.size()));
  };
  Problem problem = box(variables, -1, 1, [&](std::span<const double> x) {
    const std::vector<double> y = turned(x);
    double sum = -depth(y);
    for (const double v : y) sum += high * (1 - std::cos(2 * std::numbers::pi * v / ripple));
    return sum;
  });
  problem.gradient = [&](std::span<const double> x) {
    const std::vector<double> y = turned(x);
    std::vector<double> g(y.size(), 0.0);
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double by_y = 2 * depth(y) * y[i] / (wide * wide * static_cast<double>(y.size())) +
                          high * 2 * std::numbers::pi / ripple * std::sin(2 * std::numbers::pi * y[i] / ripple);
      g[i] += by_y;
      g[(i + 1) % y.size()] += askew * by_y;
    }
    return g;
  };
  problem.starts = {std::vector<double>(variables, 0.86)};
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto share_near = [&](bool goes_on) {
      std::vector<std::vector<double>> points;
      const OptimizerResult result = minimize(
          problem, {.max_evaluations = 6000, .seed = seed, .goes_on = goes_on, .on_evaluation = [&](const Evaluation& e) {
                      points.push_back(e.x);
                    }});
      EXPECT_LT(result.value, problem.objective(problem.starts[0]) - 1);
      const auto is_near = [&](const std::vector<double>& x) {
        constexpr double near = 0.15;
        for (std::size_t i = 0; i < x.size(); ++i) {
          if (std::abs(x[i] - result.x[i]) > near) return false;
        }
        return true;
      };
      return static_cast<double>(std::ranges::count_if(points, is_near)) / static_cast<double>(points.size());
    };
    const double going_on = share_near(true), otherwise = share_near(false);
    EXPECT_GT(going_on, 1.5 * otherwise) << seed;
  }
}

TEST(Auto, FollowsTheGradientAtOnceWhereTheObjectiveIsSmoothAroundTheStarts) {
  Problem problem = box(6, -1, 1, [](std::span<const double> x) {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += static_cast<double>(1 + i * i) * std::pow(x[i] - 0.1, 2);
    return sum;
  });
  problem.starts = {std::vector<double>(6, 0.3)};
  const auto evaluations_before_a_gradient = [&](bool smooth) {
    int evaluations = 0, before = -1;
    problem.gradient = [&](std::span<const double> x) {
      if (before < 0) before = evaluations;
      std::vector<double> g;
      for (std::size_t i = 0; i < x.size(); ++i) g.push_back(2 * static_cast<double>(1 + i * i) * (x[i] - 0.1));
      return g;
    };
    const OptimizerResult result = minimize(
        problem, {.max_evaluations = 2000, .smooth = smooth, .on_evaluation = [&](const Evaluation&) { ++evaluations; }});
    EXPECT_LT(result.value, 1e-8);
    return before;
  };
  EXPECT_EQ(evaluations_before_a_gradient(true), 1);
  EXPECT_GE(evaluations_before_a_gradient(false), 100);
}

TEST_P(Quality, AMinimumInACornerIsFound) {
  const auto slope = [](std::span<const double> x) { return 2 * x[0] - x[1] + 0.5 * x[2]; };
  const OptimizerResult result = minimize(box(3, -1, 1, slope), {.optimizer = GetParam(), .max_evaluations = 500});
  constexpr double kCorner = -3.5;
  const bool coarse = GetParam() == "isres" || GetParam() == "esch" || GetParam() == "crs2" || GetParam() == "direct-l";
  EXPECT_LT(result.value, kCorner + (coarse ? 0.3 : 1e-4));
}

int runs_solved(const landscapes::Landscape& landscape, const std::string& optimizer, long budget, std::uint64_t runs = 10) {
  int solved = 0;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    const OptimizerResult result =
        minimize(landscape.problem, {.optimizer = optimizer, .max_evaluations = budget, .seed = seed, .jobs = 2});
    if (result.value <= landscape.solved) ++solved;
  }
  return solved;
}

TEST(Auto, SolvesTheLandscapesAsOftenAsMeasured_slow) {
  // Shares of 100 seeds that bench_optimizers solved. Other rounding, such as without fused multiply-add, changes a search, so
  // that a smaller number of runs is a sample with this share: the threshold is three standard deviations below.
  const std::map<std::string, double> measured = {
      {"rosenbrock-4", 0.96}, {"rosenbrock-5", 0.90}, {"rosenbrock-7", 0.83}, {"ackley-5", 0.99},  {"creases-4", 0.98},
      {"creases-6", 0.64},    {"valleys-4", 0.66},    {"valleys-6", 0.25},    {"landing-4", 0.64}, {"landing-7", 0.59}};
  constexpr int runs = 40;
  for (const landscapes::Landscape& landscape : landscapes::all()) {
    const auto share = measured.find(landscape.name);
    if (share == measured.end()) continue;
    const double p = share->second;
    EXPECT_GE(runs_solved(landscape, "auto", 1500, runs), runs * p - 3 * std::sqrt(runs * p * (1 - p))) << landscape.name;
  }
}

// Numbers of 400 searches over 200 seeds: auto lands in 177, bobyqa from one start after the other in 92.
TEST(Auto, LandsMoreOftenThanItsPolisherAlone_slow) {
  int by_auto = 0, by_bobyqa = 0;
  for (const std::size_t pulses : {2u, 3u}) {
    const landscapes::Landscape landscape{"landing", landscapes::landing_problem(pulses), 1e-2};
    by_auto += runs_solved(landscape, "auto", 1000, 40);
    by_bobyqa += runs_solved(landscape, "bobyqa", 1000, 40);
  }
  EXPECT_GT(by_auto, by_bobyqa);
}

TEST(CmaEs, PassesOverKinksWhereModelsStop) {
  const landscapes::Landscape creases{"creases-6", box(6, -2, 2, landscapes::creases), 1e-2};
  EXPECT_GE(runs_solved(creases, "cma-es", 1500), 8);
}

// Rastrigin's function in three variables: of 11 x 11 x 11 minima the least is at 0. Ten seeds for each generation.
TEST(CmaEs, OfALargerGenerationFindsTheLeastOfManyMinimaMoreOften) {
  int found = 0, found_by_larger = 0;
  for (const double population : {1.0, 8.0}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Problem rastrigin{.variables = std::vector<Variable>(3, {.name = "x", .lower = -5.12, .upper = 5.12}),
                              .objective =
                                  [](std::span<const double> x) {
                                    double sum = 0;
                                    for (const double xi : x) sum += xi * xi + 10 - 10 * std::cos(2 * std::numbers::pi * xi);
                                    return sum;
                                  },
                              .starts = {{3, 3, 3}}};
      // The budget is that of one search; the rest does not suffice for a second search.
      const OptimizerResult result = minimize(
          rastrigin,
          {.optimizer = "cma-es", .max_evaluations = population > 1 ? 3000 : 600, .seed = seed, .population = population});
      (population > 1 ? found_by_larger : found) += result.value < 1e-3 ? 1 : 0;
    }
  }
  EXPECT_GE(found_by_larger, found + 4);
}

}  // namespace
}  // namespace softland
