// Conditions in methods with a gradient, on problems whose minima are known.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/optimizers/landscapes.h"
#include "tests/optimizers/support.h"

namespace softland {
namespace {

constexpr std::string_view followers[] = {"slsqp", "mma", "ccsaq", "ipopt", "auto"};

using Values = std::function<std::vector<double>(std::span<const double>)>;

// Minimises the first of `values`, with the others as conditions. Broken conditions also add to the cost, as in a search of
// closings.
Problem conditioned(Problem problem, std::size_t count, const Values& values, const Values& gradients) {
  problem.objective = [values](std::span<const double> x) {
    const std::vector<double> all = values(x);
    double broken = 0;
    for (std::size_t k = 1; k < all.size(); ++k) broken += std::max(all[k], 0.0);
    return all[0] + 3 * broken / (1 + broken);
  };
  problem.conditions = {.count = count, .values = values, .gradients = gradients};
  return problem;
}

// A quadratic bowl above a line: the nearest point of the line is (0.6, 0.6), with the value 0.18.
std::vector<double> above_a_line(std::span<const double> x) { return {landscapes::bowl(x), 1.2 - x[0] - x[1]}; }
std::vector<double> slopes_above_a_line(std::span<const double> x) { return {2 * (x[0] - 0.3), 2 * (x[1] - 0.3), -1, -1}; }

TEST(Conditions, AreFollowedToTheirEdge) {
  for (const std::string_view name : followers) {
    const OptimizerResult found = minimize(conditioned(landscapes::box(2, -2, 2, {}), 1, above_a_line, slopes_above_a_line),
                                           {.optimizer = std::string(name)});
    EXPECT_NEAR(found.value, 0.18, 1e-5) << name;
    EXPECT_LT(above_a_line(found.x)[1], 1e-6) << name;
  }
}

TEST(Conditions, AreFollowedByDifferencesToo) {
  const auto unknown = [](std::span<const double> x) {
    std::vector<double> slopes = slopes_above_a_line(x);
    slopes[1] = slopes[2] = std::numeric_limits<double>::quiet_NaN();
    return slopes;
  };
  for (const std::string_view name : followers) {
    for (const Values& gradients : {Values(), Values(unknown)}) {
      const OptimizerResult found =
          minimize(conditioned(landscapes::box(2, -2, 2, {}), 1, above_a_line, gradients), {.optimizer = std::string(name)});
      EXPECT_NEAR(found.value, 0.18, 1e-5) << name << (gradients ? ", of two derivatives" : ", of all");
    }
  }
}

// A curved valley in a disc and on one side of a line: the minimum is on the edge of the disc.
TEST(Conditions, MayBeCurvedAndSeveral) {
  const auto values = [](std::span<const double> x) {
    return std::vector<double>{landscapes::rosenbrock(x), x[0] * x[0] + x[1] * x[1] - 1, x[0] - 0.9};
  };
  double least = 1;
  for (int k = 0; k < 1'000'000; ++k) {
    const double angle = 2 * std::numbers::pi * k / 1e6;
    const double x[] = {std::cos(angle), std::sin(angle)};
    if (x[0] <= 0.9) least = std::min(least, landscapes::rosenbrock(x));
  }
  for (const std::string_view name : followers) {
    const OptimizerResult found =
        minimize(conditioned(landscapes::box(2, -2, 2, {}), 2, values, {}), {.optimizer = std::string(name)});
    EXPECT_NEAR(found.value, least, 1e-5) << name;
  }
}

TEST(Conditions, ThatThrowAreTakenForKept) {
  const auto thrown = [](std::span<const double>) -> std::vector<double> { throw std::runtime_error("no conditions today"); };
  Problem problem = landscapes::box(2, -2, 2, landscapes::bowl);
  problem.conditions = {.count = 1, .values = thrown, .gradients = thrown};
  for (const std::string_view name : followers) {
    const OptimizerResult found = minimize(problem, {.optimizer = std::string(name)});
    EXPECT_LT(found.value, 1e-3) << name;
    EXPECT_EQ(found.first_exception, "no conditions today") << name;
  }
}

TEST(Conditions, AreFollowedAlikeOnAnyNumberOfThreads_optimized) {
  const Problem problem = conditioned(landscapes::box(2, -2, 2, {}), 1, above_a_line, slopes_above_a_line);
  for (const char* name : {"auto", "ipopt"})
    expect_same(minimize(problem, {.optimizer = name, .jobs = 3}), minimize(problem, {.optimizer = name}));
}

}  // namespace
}  // namespace softland
