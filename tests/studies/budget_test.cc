// Tests that a larger budget of evaluations does not worsen a search, on switches that are searched in seconds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "studies/search/optimize.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

// Returns how the closing of a winner ends: 0 without a rebound, 1 settled, 2 open or not settled, 3 without a winner.
int kind_of(const OptimizeResult& found) {
  if (!found.best) return 3;
  const Metrics& m = found.best->metrics;
  return !m.settled ? 2 : m.bounce_count > 0 ? 1 : 0;
}

OptimizeOptions halved(const std::string& families, long budget, std::uint64_t seed) {
  return {.family = families, .max_evaluations = budget, .begins_with_half = true, .seed = seed};
}

TEST(Budget, ThatIsTwiceAsLargeBeginsWithTheSmallerOne_slow) {
  const SceneFile file = scene("two-electrodes.toml", {"simulate.accuracy=1e-4"});
  for (const std::string& families : {std::string("pulse"), std::string(default_families(Shaped::electrode))}) {
    std::vector<std::vector<double>> values;  // costs for each budget
    double least = std::numeric_limits<double>::infinity();
    for (const long budget : {100L, 200L, 400L}) {
      std::vector<double>& own = values.emplace_back();
      OptimizeOptions options = halved(families, budget, 1);
      options.on_evaluation = [&](const Evaluation& e, const OptimizeProgress&) { own.push_back(e.value); };
      const OptimizeResult found = optimize(file, options);
      EXPECT_LE(found.best_cost, least) << families << ", " << budget << " evaluations";
      least = found.best_cost;
      EXPECT_GT(own.size(), static_cast<std::size_t>(budget) * 3 / 4);
      EXPECT_LE(own.size(), static_cast<std::size_t>(budget));
    }
    for (std::size_t k = 1; k < values.size(); ++k) {
      ASSERT_GT(values[k].size(), values[k - 1].size());
      EXPECT_TRUE(std::ranges::equal(values[k - 1], std::span(values[k]).first(values[k - 1].size()), [](double a, double b) {
        return a == b || (std::isnan(a) && std::isnan(b));
      })) << families;
    }
  }
}

TEST(Budget, ThatIsTwiceAsLargeNeverCostsMore_slow) {
  for (const std::string name : {"two-electrodes.toml", "gap-closing-actuator.toml", "mem-gold.toml", "nem-tin.toml"}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      double least = std::numeric_limits<double>::infinity();
      for (const long budget : {100L, 200L, 400L, 800L, 1600L}) {
        const OptimizeResult found = optimize(scene(name.c_str(), {"simulate.accuracy=1e-4"}),
                                              halved(std::string(default_families(Shaped::electrode)), budget, seed));
        EXPECT_TRUE(found.best_cost <= least || std::isinf(least))
            << found.best_cost << " " << name << ", seed " << seed << ", " << budget << " evaluations";
        least = std::fmin(least, found.best_cost);
      }
    }
  }
}

// A larger budget may raise the cost a little if the search does not begin with half of it: the families then share it
// differently.
TEST(Budget, ThatIsLargerNeverEndsInAWorseKindOfClosing_slow) {
  for (const std::string name : {"two-electrodes.toml", "gap-closing-actuator.toml"}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      int least = 3;
      for (const long budget : {50L, 100L, 200L, 400L, 800L, 1600L}) {
        const OptimizeResult found =
            optimize(scene(name.c_str(), {"simulate.accuracy=1e-4"}),
                     {.family = std::string(default_families(Shaped::electrode)), .max_evaluations = budget, .seed = seed});
        const int kind = kind_of(found);
        EXPECT_LE(kind, least) << name << ", seed " << seed << ", " << budget << " evaluations";
        least = std::min(least, kind);
      }
      EXPECT_EQ(least, 0) << name;
    }
  }
}

}  // namespace
}  // namespace softland
