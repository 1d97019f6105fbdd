#include "waveforms/limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/not_finite.h"
#include "waveforms/harmonic.h"
#include "waveforms/pulse.h"
#include "waveforms/step.h"

namespace softland {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(DriverLimits, AllowWhatReachesThemExactly) {
  EXPECT_THAT(violation(signal(Step{.level = 45}), {.max_voltage = 45}), IsEmpty());
  EXPECT_THAT(violation(signal(Pulse{.levels = {1, -1, 0}, .times = {2, 4}, .edge = 1}),
                        {.min_voltage = -1, .max_voltage = 1, .max_slew = 2}),
              IsEmpty());
  // 0.2 V + 0.1 V sin is above 0.3 V by rounding.
  EXPECT_THAT(
      violation(signal(Harmonic{.base = 0.2, .amplitude = 0.1, .angular_frequency = 3e5, .phase = 0.1}), {.max_voltage = 0.3}),
      IsEmpty());
}

TEST(DriverLimits, NameTheValueAndTheLimit) {
  EXPECT_THAT(violation(signal(Step{.level = 46}), {.max_voltage = 45}),
              AllOf(HasSubstr("46 V"), HasSubstr("max_voltage of 45 V")));
  EXPECT_THAT(violation(signal(Step{.level = -2}), {.min_voltage = -1, .max_voltage = 45}),
              AllOf(HasSubstr("-2 V"), HasSubstr("min_voltage of -1 V")));
  EXPECT_THAT(violation(signal(Step{.level = 10, .rise_time = 2}), {.max_voltage = 45, .max_slew = 4}),
              AllOf(HasSubstr("5 V/s"), HasSubstr("max_slew of 4 V/s")));
  EXPECT_THAT(violation(signal(Step{.level = 10}), {.max_voltage = 45, .max_slew = 4}),
              HasSubstr("the voltage jumps, faster than the driver's max_slew of 4 V/s"));
}

TEST(DriverLimits, SeeAHarmonicThatNeverEnds) {
  EXPECT_THAT(violation(signal(Harmonic{.base = 30, .amplitude = 15.001, .angular_frequency = 3e5}), {.max_voltage = 45}),
              HasSubstr("45.001"));
}

TEST(DriverLimits, CountTheStartAtZero) {
  EXPECT_THAT(violation(signal(Step{.level = 6}), {.min_voltage = 5, .max_voltage = 45}),
              AllOf(HasSubstr("0 V (the voltage of every drive before t = 0)"), HasSubstr("5 V")));
}

TEST(DriverLimits, AreViolatedWhenTheyAreNotNumbers) {
  const Signal zero;
  EXPECT_THAT(violation(zero, {}), IsEmpty());
  EXPECT_THAT(violation(zero, {.max_voltage = kNaN}), HasSubstr("nan"));
  EXPECT_THAT(violation(zero, {.min_voltage = kNaN}), HasSubstr("nan"));
  EXPECT_THAT(violation(zero, {.max_slew = kNaN}), HasSubstr("nan"));
}

}  // namespace
}  // namespace softland
