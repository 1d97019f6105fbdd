#include "optimizers/problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/optimizers/landscapes.h"

namespace softland {
namespace {

TEST(Auto, FindsTheEndOfACurvedValley) {
  const OptimizerResult result =
      minimize(landscapes::box(4, -2, 2, landscapes::rosenbrock), {.max_evaluations = 1500, .seed = 1});
  EXPECT_LT(result.value, 1e-6);
  EXPECT_EQ(result.termination, Termination::evaluation_budget);
}

}  // namespace
}  // namespace softland
