// What a larger budget of evaluations comes to, on switches that are searched in seconds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "studies/optimize.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

// How a winner ends: 0 without a rebound, 1 settled, 2 open or not settled, 3 none.
int kind_of(const OptimizeResult& found) {
  if (!found.best) return 3;
  const Metrics& m = found.best->metrics;
  return !m.settled ? 2 : m.bounce_count > 0 ? 1 : 0;
}

// The cost of a landing may be a little more: families share another budget in another way.
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
