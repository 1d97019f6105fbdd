// The gold cantilever with a PZT layer, against an independent program (stepped-beam modes in closed form, another integrator).
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/pull_in.h"
#include "objectives/metrics.h"
#include "tests/regression/gold_digits.h"
#include "tests/support/devices.h"
#include "waveforms/pulse.h"

namespace softland {
namespace {

using namespace literals;
using test::fine;
using test::frequency_digits;
using test::impact_digits;
using test::time_digits;

constexpr double pzt_voltage_digits = 1e-3;    // relative: what users may rely on
constexpr double hold_level = 1.25 * 22.4695;  // [V], 1.25 Vdp

Device pzt_with_modes(int modes) {
  Device device = test::gold_pzt_cantilever();
  device.structure.modes = modes;
  return device;
}

Metrics closing(const Switch& device, const Signal& piezo, double duration, double tolerance) {
  const std::vector<Signal> drives{Signal::constant(hold_level), piezo};
  return metrics(simulate_closing(device, drives, {.duration = duration, .tolerance = tolerance}));
}

/// Returns the V^2 of the electrode that holds the contact point at deflection s against the beam and a constant piezo voltage.
/// `q` is the start of Newton's method, and then the solution. The library's pull-in is not used, since it keeps the other
/// drives at 0 V.
double square_at(const Switch& device, double s, double piezo_volts, Eigen::VectorXd& q, double square) {
  const Eigen::Index n = device.modes();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(n), shape = device.basis().contact_shape();
  Switch::Workspace work = device.workspace();
  Eigen::MatrixXd by_q(n, n), by_v(n, n), system(n + 1, n + 1);
  Eigen::VectorXd force(n), without(n), right(n + 1);
  for (int i = 0; i < 100; ++i) {
    const std::vector<double> volts{std::sqrt(square), piezo_volts}, electrode_off{0, piezo_volts};
    device.accelerations(q.data(), rest.data(), volts, false, work, force.data());
    device.jacobian(q.data(), rest.data(), volts, false, work, by_q, by_v);
    device.accelerations(q.data(), rest.data(), electrode_off, false, work, without.data());
    const Eigen::VectorXd stiffness = device.basis().angular_frequencies().cwiseAbs2();
    system.topLeftCorner(n, n) = stiffness.cwiseInverse().asDiagonal() * by_q;
    system.topRightCorner(n, 1) = (force - without).cwiseQuotient(square * stiffness);
    system.bottomLeftCorner(1, n) = shape.transpose();
    system(n, n) = 0;
    right.head(n) = -force.cwiseQuotient(stiffness);
    right[n] = s - shape.dot(q);
    const Eigen::VectorXd step = system.partialPivLu().solve(right);
    q += step.head(n);
    square += step[n];
    if (step.head(n).norm() < 1e-11 * q.norm()) return square;
  }
  return std::nan("");
}

TEST(GoldPzt, HasTheReferenceFrequencies) {
  const Switch device(test::gold_pzt_cantilever());
  const std::array reference{97117.55, 615469.80, 1736866.72, 3424811.84};
  ASSERT_EQ(device.modes(), 4);
  for (int i = 0; i < 4; ++i) {
    const double expected = reference[static_cast<std::size_t>(i)];
    EXPECT_NEAR(device.basis().angular_frequencies()[i], expected, frequency_digits * expected) << "mode " << i;
  }
}

TEST(GoldPzt, PullsInAtTheReferenceVoltages) {
  const Switch device(test::gold_pzt_cantilever());
  const StaticPullIn statically = static_pull_in(device, 0);
  ASSERT_EQ(statically.status, Status::done);
  EXPECT_NEAR(statically.voltage, 24.500, pzt_voltage_digits * 24.500);
  const DynamicPullIn dynamically = dynamic_pull_in(device, 0, statically);
  ASSERT_EQ(dynamically.status, Status::done);
  EXPECT_NEAR(dynamically.voltage, 22.4695, pzt_voltage_digits * 22.4695);
}

TEST(GoldPzt, ATenthOfAVoltAgainstTheLayerLowersThePullInVoltage) {
  const Switch device(test::gold_pzt_cantilever());
  const auto fold = [&](double piezo_volts) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(device.modes());
    double best = 0, square = 100;
    // Steps of 5 nm give the voltage within 1e-6 at the flat maximum; a negative voltage bends the beam down before the
    // electrode pulls.
    for (double s = 0.6_um; s < 1.9_um; s += 5_nm) {
      square = square_at(device, s, piezo_volts, q, square);
      if (!std::isfinite(square)) {
        ADD_FAILURE() << "no equilibrium at " << s;
        break;
      }
      best = std::max(best, square);
    }
    return std::sqrt(best);
  };
  EXPECT_NEAR(fold(0), 24.500, pzt_voltage_digits * 24.500);
  EXPECT_NEAR(fold(-0.1_V), 23.111, pzt_voltage_digits * 23.111);
}

TEST(GoldPzt, ClosesUnderAStepAsTheReferenceDoes) {
  const Metrics m = closing(Switch(test::gold_pzt_cantilever()), Signal(), 100_us, fine);
  EXPECT_NEAR(m.initial_contact_time, 23.186_us, time_digits * 23.186_us);
  EXPECT_NEAR(m.impact_velocity, 0.1328, impact_digits * 0.1328);
  EXPECT_NEAR(m.major_bounce_height, 803.1_nm, impact_digits * 803.1_nm);
}

TEST(GoldPzt, BounceHeightDependsOnTheNumberOfModes) {
  constexpr std::array<std::pair<int, double>, 4> reference{{{3, 664_nm}, {4, 803_nm}, {5, 976_nm}, {6, 904_nm}}};
  for (const auto& [modes, height] : reference) {
    const Metrics m = closing(Switch(pzt_with_modes(modes)), Signal(), 100_us, fine);
    EXPECT_NEAR(m.major_bounce_height, height, impact_digits * height) << modes << " modes";
  }
}

TEST(GoldPzt, LandsWithoutReboundWhenThePiezoHelps) {
  // From an independent search. The landing is so soft that t_i has an error of a tenth of a microsecond.
  constexpr double soft_landing_time = 0.1_us, soft_landing_speed = 2e-3;  // [s], [m/s]
  const Switch device(test::gold_pzt_cantilever());
  const Signal piezo = signal(Pulse{.levels = {0.17327_V, 0.60281_V, 0_V}, .times = {19.74662_us, 40.90419_us}, .edge = 5_us});
  for (const double tolerance : {1e-6, fine}) {
    const Metrics m = closing(device, piezo, 300_us, tolerance);
    EXPECT_EQ(m.status, Status::done);
    EXPECT_NEAR(m.initial_contact_time, 44.5_us, soft_landing_time);
    EXPECT_EQ(m.permanent_contact_time, m.initial_contact_time);
    EXPECT_EQ(m.bounce_count, 0);
    EXPECT_LT(m.impact_velocity, soft_landing_speed);
  }
}

}  // namespace
}  // namespace softland
