// Success rates of the optimizers over seeds, as a Markdown table: bench_optimizers [BUDGET [SEEDS [OPTIMIZER ...]]].
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "optimizers/problem.h"
#include "tests/optimizers/landscapes.h"

int main(int argc, char** argv) {
  const long budget = argc > 1 ? std::atol(argv[1]) : 1500;
  const std::uint64_t seeds = argc > 2 ? static_cast<std::uint64_t>(std::atol(argv[2])) : 20;
  std::vector<std::string> optimizers(argv + std::min(argc, 3), argv + argc);
  if (optimizers.empty()) optimizers.assign(softland::optimizer_names().begin(), softland::optimizer_names().end());

  const std::vector<softland::landscapes::Landscape> landscapes = softland::landscapes::all();
  fmt::print("Runs of {} that reach a solution within {} evaluations, and the median of the best value\n\n| |", seeds, budget);
  for (const auto& landscape : landscapes) fmt::print(" {} |", landscape.name);
  fmt::print(" all |\n|---|");
  for (std::size_t i = 0; i <= landscapes.size(); ++i) fmt::print("---|");
  fmt::print("\n");
  for (const std::string& optimizer : optimizers) {
    fmt::print("| {} |", optimizer);
    long all_solved = 0;
    for (const auto& landscape : landscapes) {
      std::vector<double> values;
      for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const auto result =
            softland::minimize(landscape.problem, {.optimizer = optimizer, .max_evaluations = budget, .seed = seed, .jobs = 2});
        values.push_back(result.value);
      }
      std::sort(values.begin(), values.end());
      const auto solved = std::count_if(values.begin(), values.end(), [&](double value) { return value <= landscape.solved; });
      all_solved += solved;
      fmt::print(" {} ({:.1e}) |", solved, values[values.size() / 2]);
      std::fflush(stdout);
    }
    fmt::print(" {} of {} |\n", all_solved, seeds * landscapes.size());
  }
}
