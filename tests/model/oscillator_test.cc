// The linear limit: without electrodes and contact every mode is an oscillator driven by the piezo, with a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/constants.h"
#include "tests/support/devices.h"
#include "waveforms/harmonic.h"
#include "waveforms/pulse.h"
#include "waveforms/step.h"

namespace softland {
namespace {

using namespace literals;

constexpr double tight = 1e-10;        // integrator tolerance
constexpr double shape_digits = 1e-7;  // error for `tight` after twenty periods, over the largest deflection
constexpr double window = 200_us;

Device oscillator(double damping_ratio) {
  Device device = test::gold_pzt_cantilever();
  device.electrodes.clear();
  device.gas.reset();
  device.contacts.clear();
  device.structure.damping_ratio = damping_ratio;
  return device;
}

/// Returns the response of q'' + 2 zeta w q' + w^2 q = 1 from rest.
double step_response(double w, double zeta, double t) {
  const double root = std::sqrt(1 - zeta * zeta);
  return (1 - std::exp(-zeta * w * t) * (std::cos(w * root * t) + zeta / root * std::sin(w * root * t))) / (w * w);
}

/// Returns the response of q'' + 2 zeta w q' + w^2 q = t from rest.
double ramp_response(double w, double zeta, double t) {
  const double wd = w * std::sqrt(1 - zeta * zeta), decay = std::exp(-zeta * w * t);
  const double a = 2 * zeta / w;  // particular solution (t - a) / w^2
  return (t - a + decay * (a * std::cos(wd * t) + (zeta * w * a - 1) / wd * std::sin(wd * t))) / (w * w);
}

/// Returns the response of q'' + w^2 q = sin(f t + phase) from rest.
double sine_response(double w, double f, double phase, double t) {
  const double gain = 1 / (w * w - f * f);
  return gain * (std::sin(f * t + phase) - std::sin(phase) * std::cos(w * t) - f / w * std::cos(phase) * std::sin(w * t));
}

/// Compares every knot of a run under `drive` with the sum over the modes of `response(w, t)` [s^2 per volt].
template <class Response>
void expect_response(double damping_ratio, const Signal& drive, double volts, Response&& response) {
  const Switch device(oscillator(damping_ratio));
  const std::vector<Signal> drives{drive};
  const Trajectory trajectory = simulate_closing(device, drives, {.duration = window, .tolerance = tight});
  ASSERT_EQ(trajectory.status, Status::done);
  ASSERT_TRUE(trajectory.touches.empty());
  EXPECT_DOUBLE_EQ(trajectory.points.back().time, window);
  const Eigen::VectorXd gain = device.basis().piezo_shape().cwiseProduct(device.basis().contact_shape());
  double largest = 0, worst = 0;
  for (const TrajectoryPoint& p : trajectory.points) {
    double exact = 0;
    for (Eigen::Index i = 0; i < device.modes(); ++i)
      exact += volts * gain[i] * response(device.basis().angular_frequencies()[i], p.time);
    largest = std::max(largest, std::abs(exact));
    worst = std::max(worst, std::abs(p.position - exact));
  }
  EXPECT_GT(largest, 10_nm);
  EXPECT_LT(worst, shape_digits * largest);
}

TEST(LinearLimit, StepOnThePiezoRingsEveryModeAboutItsStaticDeflection_optimized) {
  for (const double zeta : {0.0, 0.05}) {
    expect_response(zeta, Signal::constant(-0.2), -0.2, [&](double w, double t) { return step_response(w, zeta, t); });
  }
}

TEST(LinearLimit, RampIsTheIntegralOfTheStep_optimized) {
  constexpr double rise = 17_us;
  for (const double zeta : {0.0, 0.05}) {
    expect_response(zeta, signal(Step{.level = -0.2, .rise_time = rise}), -0.2 / rise, [&](double w, double t) {
      return ramp_response(w, zeta, t) - (t > rise ? ramp_response(w, zeta, t - rise) : 0);
    });
  }
}

TEST(LinearLimit, PulseIsASumOfSteps_optimized) {
  constexpr double first = 20_us, second = 55_us;
  expect_response(0, signal(Pulse{.levels = {0.2_V, -0.3_V, 0.1_V}, .times = {first, second}, .edge = 0}), 1,
                  [&](double w, double t) {
                    return 0.2 * step_response(w, 0, t) - (t > first ? 0.5 * step_response(w, 0, t - first) : 0) +
                           (t > second ? 0.4 * step_response(w, 0, t - second) : 0);
                  });
}

TEST(LinearLimit, SineDrivesEveryModeBelowAndAboveItsResonance_optimized) {
  for (const double frequency : {5e4, 3e5, 2.2e6}) {  // frequencies between the modes [rad/s]
    constexpr double phase = 0.7;
    expect_response(0, signal(Harmonic{.amplitude = 0.3_V, .angular_frequency = frequency, .phase = phase}), 0.3,
                    [&](double w, double t) { return sine_response(w, frequency, phase, t); });
  }
}

TEST(LinearLimit, EveryIntegratorFollowsTheClosedForm_optimized) {
  const Switch device(oscillator(0));
  const Eigen::VectorXd gain = device.basis().piezo_shape().cwiseProduct(device.basis().contact_shape());
  const std::vector<Signal> drives{Signal::constant(-0.2)};
  for (const Integrator integrator :
       {Integrator::lawson, Integrator::arkode_erk, Integrator::esdirk, Integrator::bdf, Integrator::adams}) {
    const Trajectory trajectory =
        simulate_closing(device, drives, {.duration = 100_us, .tolerance = 1e-9, .integrator = integrator});
    double exact = 0;
    for (Eigen::Index i = 0; i < device.modes(); ++i) {
      exact += -0.2 * gain[i] * step_response(device.basis().angular_frequencies()[i], 0, 100_us);
    }
    constexpr double multistep_digits = 2e-5;  // in multistep methods many thousand small errors add up
    EXPECT_NEAR(trajectory.points.back().position, exact, multistep_digits * 1_um) << static_cast<int>(integrator);
  }
}

TEST(LinearLimit, FreeModesAreExactAtAnyTolerance_optimized) {
  const Switch device(oscillator(0));
  const std::vector<Signal> drives{Signal::constant(-0.2)};
  const Trajectory trajectory = simulate_closing(device, drives, {.duration = 100_us, .tolerance = 0.1});
  const double fastest = device.basis().angular_frequencies().maxCoeff();
  EXPECT_LE(trajectory.work.steps, 10 + static_cast<long>(100_us * fastest / 2)) << "two radians a step";
  const Eigen::VectorXd gain = device.basis().piezo_shape().cwiseProduct(device.basis().contact_shape());
  for (const TrajectoryPoint& point : trajectory.points) {
    double exact = 0;
    for (Eigen::Index i = 0; i < device.modes(); ++i) {
      exact += -0.2 * gain[i] * step_response(device.basis().angular_frequencies()[i], 0, point.time);
    }
    ASSERT_NEAR(point.position, exact, 1e-10 * 1_um);
  }
}

TEST(LinearLimit, EnergyOfTheModesIsTheWorkOfTheDrive_optimized) {
  const Switch device(oscillator(0));
  const std::vector<Signal> drives{Signal::constant(-0.2)};
  const Trajectory trajectory = simulate_closing(device, drives, {.duration = 130_us, .tolerance = tight});
  EXPECT_GT(trajectory.energy.source_work, 0);
  EXPECT_NEAR(trajectory.energy.residual(), 0, 1e-7 * trajectory.energy.source_work);
  // The work of a constant voltage is V times the charge theta q of the deflection.
  double work = 0;
  for (Eigen::Index i = 0; i < device.modes(); ++i) {
    work += 0.2 * 0.2 * std::pow(device.basis().piezo_shape()[i], 2) *
            step_response(device.basis().angular_frequencies()[i], 0, 130_us);
  }
  EXPECT_NEAR(trajectory.energy.source_work, work, 1e-6 * work);
}

TEST(Touch, ThatGrazesThePlaneIsFoundAndItsNearMissIsNot) {
  // One undamped mode overshoots to twice its static deflection. The plane is a ten-millionth of that below or above this
  // point.
  constexpr double margin = 1e-7, volts = -0.2;
  Device d = oscillator(0);
  d.structure.modes = 1;
  d.contacts = test::gold_cantilever().contacts;
  const Switch probe(d);
  const double w = probe.basis().angular_frequencies()[0];
  const double peak = 2 * volts * probe.basis().piezo_shape()[0] * probe.basis().contact_shape()[0] / (w * w);
  for (const bool touches : {true, false}) {
    d.gap.contact = peak * (touches ? 1 - margin : 1 + margin);
    const Switch device(d);
    const std::vector<Signal> drives{Signal::constant(volts)};
    const Trajectory trajectory = simulate_closing(device, drives, {.duration = 2 * pi / w, .tolerance = 1e-11});
    ASSERT_EQ(trajectory.touches.size(), touches ? 1u : 0u);
    if (touches) {
      const double early = std::acos(1 - 2 * margin) / w;  // half the time above the plane
      const Touch& touch = trajectory.touches[0];
      constexpr double event_digits = 0.01;  // error over that short time
      EXPECT_NEAR(touch.begin, pi / w - early, event_digits * early);
      EXPECT_NEAR(touch.end, pi / w + early, event_digits * early);
      EXPECT_NEAR(trajectory.deepest_penetration, margin * peak, event_digits * margin * peak);
      EXPECT_NEAR(touch.impact_velocity, peak / 2 * w * std::sin(early * w), event_digits * touch.impact_velocity);
    }
  }
}

}  // namespace
}  // namespace softland
