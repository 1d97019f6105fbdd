// Landings of an undamped switch with one degree of freedom, without a rebound.
#include "studies/search/bang_bang.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "model/closing.h"
#include "model/constants.h"
#include "scenes.h"

namespace softland {
namespace {

TEST(BangBang, OfAConstantForceOnASpringFollowsTheCosine) {
  // The plate moves from rest under the force F, x = F / k (1 - cos w t), to x_s = k c^2 / (2 F), then freely to rest at c, x =
  // c cos(w (t - t_c)).
  constexpr double k = 3, m = 0.7, c = 1.2;
  const double w = std::sqrt(k / m);
  for (const double force : {2.0, 3.0, 10.0}) {
    const auto found =
        bang_bang([&](double x) { return k * x * x / 2 - force * x; }, [&](double x) { return k * x * x / 2; }, m, 0, c);
    ASSERT_TRUE(found) << force;
    const double at = k * c * c / (2 * force);
    constexpr double quadrature = 1e-10;
    EXPECT_NEAR(found->switching_position, at, quadrature) << force;
    EXPECT_NEAR(found->driven_time, std::acos(1 - k * at / force) / w, quadrature) << force;
    EXPECT_NEAR(found->coasting_time, std::acos(at / c) / w, quadrature) << force;
  }
}

TEST(BangBang, OfAPlateSwitchesWhereTheWorkBendsTheSpringToTheContact) {
  // Closed form: eps A V^2 / 2 (1 / (d - x_s) - 1 / d) = k c^2 / 2.
  constexpr double k = 20, area = 1e-8, d = 3e-6, c = 2e-6, volts = 60;
  const double strength = vacuum_permittivity * area * volts * volts;
  const auto found = switching_position([&](double x) { return k * x * x / 2 - strength / 2 / (d - x); },
                                        [&](double x) { return k * x * x / 2; }, 0, c);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, d - 1 / (1 / d + k * c * c / strength), 1e-12 * d);
}

TEST(BangBang, HasNoSolutionWhereTheDriveDoesNotReachTheContactOrTheSwitchClosesByItself) {
  const Potential spring = [](double x) { return x * x / 2; };
  EXPECT_FALSE(bang_bang([](double x) { return x * x / 2 - 0.4 * x; }, spring, 1, 0, 1)) << "too weak";
  EXPECT_FALSE(bang_bang([](double x) { return -x; }, [](double x) { return -0.1 * x; }, 1, 0, 1)) << "falls";
  EXPECT_TRUE(bang_bang([](double x) { return x * x / 2 - 0.6 * x; }, spring, 1, 0, 1));
}

TEST(BangBang, LandsASimulatedSwitchOfOneModeWithoutSpeed) {
  for (const std::string name : {"mem-gold.toml", "gap-closing-actuator.toml"}) {
    const PreparedScene p = prepare(undamped_with_one_mode(name), true);
    std::vector<double> full(p.model.drives(), 0.0), none = full;
    full[0] = p.drives.at(p.scene.device.electrodes[0].name).limits.value().max_voltage;
    const auto plan = bang_bang(p.model, full, none);
    ASSERT_TRUE(plan) << name;
    std::vector<Signal> signals(p.model.drives());
    signals[0] = signal(Pulse{.levels = {full[0], 0}, .times = {plan->driven_time}});
    const double arrival = plan->driven_time + plan->coasting_time;
    const Trajectory t = simulate_closing(p.model, signals, {.duration = 1.2 * arrival, .tolerance = 1e-10});
    // The turning point lies beside the highest knot, where the acceleration is nearly that of the turn.
    const TrajectoryPoint& knot =
        *std::max_element(t.points.begin(), t.points.end(), [](const auto& a, const auto& b) { return a.position < b.position; });
    const double back = std::abs(knot.acceleration), contact = p.scene.device.gap.contact;
    EXPECT_NEAR(knot.position + knot.velocity * knot.velocity / (2 * back), contact, 1e-4 * contact) << name;
    EXPECT_NEAR(knot.time + knot.velocity / back, arrival, 1e-2 * arrival) << name;
  }
}

}  // namespace
}  // namespace softland
