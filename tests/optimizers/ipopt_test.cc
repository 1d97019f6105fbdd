// Tests the special cases of Ipopt.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "optimizers/backends.h"
#include "tests/optimizers/landscapes.h"
#include "tests/optimizers/support.h"

namespace softland {
namespace {

using landscapes::box;
using namespace std::chrono_literals;

OptimizerResult solve(std::uint64_t seed) {
  return minimize(box(3, -2, 2, landscapes::rosenbrock), {.optimizer = "ipopt", .max_evaluations = 150, .seed = seed});
}

TEST(Ipopt, SolvesFromTwoThreadsAtOnce) {
  const OptimizerResult alone_1 = solve(1);
  const OptimizerResult alone_2 = solve(2);
  OptimizerResult together_1;
  OptimizerResult together_2;
  for (int i = 0; i < 3; ++i) {
    {
      const std::jthread one([&] { together_1 = solve(1); });
      const std::jthread two([&] { together_2 = solve(2); });
    }
    expect_same(together_1, alone_1);
    expect_same(together_2, alone_2);
  }
}

OptimizerResult solve_alone(const Problem& problem, const OptimizerOptions& options) {
  internal::EvaluationRecord record(problem, options);
  record.run({{.budget = 100,
               .body = [](internal::BudgetedObjective& budgeted) { (void)internal::run_ipopt({.start = {0.5}}, budgeted); }}});
  return record.result(false, "");
}

TEST(Ipopt, WaitsForAnotherSolveNoLongerThanItsTimeBudget) {
  std::atomic<bool> solving = false;
  std::atomic<bool> stop = false;
  const std::jthread other([&] {
    const auto hold = [&](std::span<const double> x) {
      solving = true;
      while (!stop) std::this_thread::sleep_for(1ms);
      return x[0];
    };
    (void)solve_alone(box(1, 0, 1, hold), {.stop = &stop});
  });
  while (!solving) std::this_thread::sleep_for(1ms);
  const OptimizerResult result = solve_alone(box(1, 0, 1, [](auto x) { return x[0]; }), {.max_seconds = 0.05});
  stop = true;
  EXPECT_EQ(result.termination, Termination::time_budget);
  EXPECT_EQ(result.evaluations, 0);
}

TEST(Ipopt, ReadsNoOptionsFromTheWorkingDirectory) {
  const OptimizerResult usual = solve(1);
  const auto here = std::filesystem::current_path();
  const auto elsewhere = std::filesystem::path(testing::TempDir()) / "softland_ipopt_options";
  std::filesystem::create_directories(elsewhere);
  std::ofstream(elsewhere / "ipopt.opt") << "max_iter 1\n";
  std::filesystem::current_path(elsewhere);
  const OptimizerResult there = solve(1);
  std::filesystem::current_path(here);
  std::filesystem::remove_all(elsewhere);
  expect_same(there, usual);
}

TEST(Ipopt, PrintsNothing) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  static_cast<void>(solve(1));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace softland
