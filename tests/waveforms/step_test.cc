#include "waveforms/step.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/literals.h"
#include "tests/waveforms/expect_invalid.h"

namespace softland {
namespace {

using namespace literals;
using test::expect_invalid;

TEST(Step, WithoutRiseTimeIsAConstant) {
  EXPECT_EQ(signal(Step{.level = 45_V}).pieces(), Signal::constant(45_V).pieces());
  EXPECT_TRUE(signal(Step{}).is_zero());
}

TEST(Step, RisesLinearlyAndHolds) {
  const Signal step = signal(Step{.level = 40_V, .rise_time = 2_us});
  EXPECT_EQ(step.breakpoints(), (std::vector<double>{0, 2_us}));
  EXPECT_EQ(step.voltage(0), 0);
  EXPECT_DOUBLE_EQ(step.voltage(0.5_us), 10);
  EXPECT_EQ(step.voltage(2_us), 40);
  EXPECT_EQ(step.voltage_before(2_us), 40);
  EXPECT_EQ(step.voltage(1), 40);
  EXPECT_EQ(step.hold_level(), 40);
  EXPECT_DOUBLE_EQ(step.peak_slew(), 40 / 2e-6);
}

TEST(Step, RiseOfAPicosecondIsNoJump) {
  const Signal step = signal(Step{.level = 40_V, .rise_time = 1e-12});
  EXPECT_DOUBLE_EQ(step.peak_slew(), 4e13);
  EXPECT_EQ(step.voltage(1e-12), 40);
}

TEST(Step, NamesParameterValueAndRule) {
  expect_invalid([] { (void)signal(Step{.level = std::numeric_limits<double>::quiet_NaN()}); }, {"level", "nan V", "finite"});
  expect_invalid([] { (void)signal(Step{.level = 1, .rise_time = -1e-6}); }, {"rise_time", "-1e-06 s", ">= 0"});
  expect_invalid([] { (void)signal(Step{.level = 1, .rise_time = std::numeric_limits<double>::infinity()}); },
                 {"rise_time", "inf"});
}

}  // namespace
}  // namespace softland
