// Compares simulated with measured gap-closing actuators of Rauf et al. 2022, without fitting.
#include "tests/support/measured_actuators.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/closing.h"
#include "model/pull_in.h"

namespace softland {
namespace {

// Bounds for a lumped model with rigid fingers; results/measured-actuators.md lists every deviation. Short fingers pull in at
// lower voltages than simulated: their overlap of 15 um has an error of 0.4 um, and their ends and roots add force.
constexpr double voltage_error = 0.10;  // relative
constexpr double shortest = 38e-6;      // least overlap for which the voltages are compared [m]
constexpr double time_error = 0.10;     // relative error from one and a half times the pull-in voltage on
constexpr double well_above = 1.5;

double pull_in(const Device& d) { return static_pull_in(Switch(d), 0).voltage; }

TEST(GapClosingActuators, PullInWhereMeasured) {
  for (const test::MeasuredPullIn& m : test::measured_pull_in) {
    if (m.overlap < shortest) continue;
    const double simulated = pull_in(test::gap_closing_actuator(m.overlap));
    for (const double measured : m.pull_in) EXPECT_NEAR(simulated, measured, voltage_error * measured) << m.overlap;
  }
}

TEST(GapClosingActuators, LetGoWhereMeasured) {
  // The stop keeps a gap of 1 um between the fingers; a change of the etch by half a micrometre is a quarter of this voltage.
  for (const test::MeasuredPullIn& m : test::measured_pull_in) {
    EXPECT_NEAR(release_voltage(Switch(test::gap_closing_actuator(m.overlap)), 0), m.pull_out, 0.25 * m.pull_out) << m.overlap;
  }
}

TEST(GapClosingActuators, CloseInTheMeasuredTime) {
  for (const test::MeasuredTimes& m : test::measured_times) {
    const Device d = test::gap_closing_actuator(m.overlap);
    const Switch model(d);
    const double threshold = static_pull_in(model, 0).voltage;
    for (const test::MeasuredTime& t : m.times) {
      if (t.volts < well_above * threshold) continue;
      const Trajectory closing =
          simulate_closing(model, std::vector<Signal>{Signal::constant(t.volts)}, {.duration = 200e-6, .after_contact = 0});
      ASSERT_FALSE(closing.touches.empty()) << t.volts;
      EXPECT_NEAR(closing.touches[0].begin, t.time, time_error * t.time) << m.overlap << " m, " << t.volts << " V";
    }
  }
}

}  // namespace
}  // namespace softland
