// The quadrature follows the requested accuracy and the smallest gap of a switch.
#include "studies/closing/quadrature.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "scenes.h"
#include "studies/closing/certify.h"
#include "studies/closing/prepared.h"
#include "studies/closing/simulate.h"
#include "studies/devices/ensemble.h"
#include "tests/support/random_scenes.h"

namespace softland {
namespace {

/// A beam whose contact is at this share of the distance to the electrode.
SceneFile near_electrode(double share = 0, double accuracy = 1e-6) {
  SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/tests/studies/near_electrode.toml");
  if (share > 0) file.set(fmt::format("gap.contact={} um", share * 3.0285714285714));
  file.set(fmt::format("simulate.accuracy={}", accuracy));
  return file;
}

/// Converged quadrature: the regions of large load are at least 12 um wide, the panels at most 100 um long.
constexpr SwitchOptions converged{.points_per_length = 300, .points_per_panel = 24};

struct FirstTouch {
  double time = 0, velocity = 0;
};

FirstTouch true_touch(const PreparedScene& p) {
  constexpr double tightest = 1e-13;
  const Trajectory t = simulate_closing(Switch(p.scene.device, converged), p.signals(),
                                        {.duration = p.duration, .tolerance = tightest, .after_contact = 0});
  if (t.touches.empty()) return {Metrics::unset, Metrics::unset};
  return {t.touches.front().begin, t.touches.front().impact_velocity};
}

double largest_error(const Metrics& m, const FirstTouch& right) {
  return std::max(std::abs(m.initial_contact_time / right.time - 1), std::abs(m.impact_velocity / right.velocity - 1));
}

constexpr double bridge_release = 6.59556, bridge_impact = 13.04662;  // values of another program, to its last digit [V], [m/s]

TEST(Quadrature, ReleaseNextToTheElectrodeIsThatOfAnotherProgram) {
  constexpr double digit = 3e-6;
  EXPECT_NEAR(release_voltage(prepare(near_electrode()).model, 0), bridge_release, digit * bridge_release);
  EXPECT_NEAR(simulate(prepare(near_electrode()), true).metrics.impact_velocity, bridge_impact, digit * bridge_impact);
}

TEST(Quadrature, StaticsNextToTheElectrodeHaveTheAccuracyAskedFor) {
  // Just above the release voltage the contact carries a small part of the load, and the tangent, which is steeper than the
  // load, has an eigenvalue near zero.
  constexpr double into_hold = 1.03, of_force = 100, of_eigenvalue = 1000;
  for (const double share : {0.89, 0.957, 0.98}) {
    const Switch fine(prepare(near_electrode(share)).scene.device, converged);
    const double release = release_voltage(fine, 0);
    const std::vector<double> held{into_hold * release};
    const std::optional<ClosedEquilibrium> right = closed_equilibrium(fine, held);
    ASSERT_TRUE(right);
    for (const double accuracy : {1e-3, 1e-6, 1e-8}) {
      SCOPED_TRACE(fmt::format("contact at {} of the distance, accuracy {}", share, accuracy));
      const Switch model = prepare(near_electrode(share, accuracy)).model;
      EXPECT_NEAR(release_voltage(model, 0), release, accuracy * release);
      const std::optional<ClosedEquilibrium> closed = closed_equilibrium(model, held);
      ASSERT_TRUE(closed);
      EXPECT_NEAR(closed->contact_force, right->contact_force, of_force * accuracy * right->contact_force);
      EXPECT_NEAR(closed->smallest_eigenvalue, right->smallest_eigenvalue, of_eigenvalue * accuracy * fine.basis().squares()[0]);
    }
  }
}

TEST(Quadrature, RunsThatEndOnTheElectrodeHaveErrorsThatCover) {
  for (const double share : {0.957, 0.98}) {
    for (const double accuracy : {1e-3, 1e-6}) {
      SCOPED_TRACE(fmt::format("contact at {} of the distance, accuracy {}", share, accuracy));
      const PreparedScene p = prepare(near_electrode(share, accuracy));
      const FirstTouch right = true_touch(p);
      const Closing certified = certify(p);
      EXPECT_TRUE(certified.certificate);
      for (const Closing& c : {simulate(p, true), certified}) {
        ASSERT_EQ(c.metrics.status, Status::collapsed_onto_electrode);
        EXPECT_TRUE(largest_error(c.metrics, right) <= accuracy) << largest_error(c.metrics, right);
        EXPECT_TRUE(std::abs(c.metrics.impact_velocity - right.velocity) <= c.errors[&Metrics::impact_velocity]);
        EXPECT_TRUE(std::abs(c.metrics.initial_contact_time - right.time) <= c.errors[&Metrics::initial_contact_time]);
      }
    }
  }
}

// The quadrature is chosen for touch. At the electrode the judge finds it too coarse, and finer ones replace it.
TEST(Quadrature, IsRefinedInRunsThatEndOnTheElectrode) {
  PreparedScene p = prepare(near_electrode());
  p.quadrature = quadrature_for(1e-6, 8);
  p.model = Switch(p.scene.device, p.quadrature);
  const Closing c = simulate(p, true);
  EXPECT_GT(c.quadrature.points_per_length, p.quadrature.points_per_length);
  EXPECT_TRUE(largest_error(c.metrics, true_touch(p)) <= 1e-6) << largest_error(c.metrics, true_touch(p));
}

TEST(Quadrature, OfSwitchesThatTouchFarFromTheElectrodeIsTheUsualOne) {
  for (const std::string& name : shipped_scenes()) {
    if (name == "hung-senturia.toml") continue;  // its contact plane is next to the electrode
    const PreparedScene p = prepare(scene(name.c_str(), {"simulate.accuracy=1e-6"}));
    EXPECT_EQ(p.quadrature.points_per_length, quadrature_for(1e-6, p.model.modes()).points_per_length) << name;
    EXPECT_EQ(p.quadrature.points_per_panel, SwitchOptions{}.points_per_panel) << name;
  }
}

TEST(Quadrature, OfADeviceThatTouchesNearerToTheElectrodeIsFiner) {
  constexpr double accuracy = 1e-6;
  SceneFile file = near_electrode(0.9, accuracy);
  file.set("spread.\"gap.contact\"={ distribution = \"uniform\", half_width = \"0.24 um\" }");
  const PreparedScene nominal = prepare(file);
  const Ensemble ensemble(nominal, 1);
  DeviceBuilder builder(ensemble);
  for (const double contact : {0.85 * 3.0285714285714e-6, 0.975 * 3.0285714285714e-6}) {
    const SampledDevice device = builder.device(std::vector<double>{contact});
    ASSERT_TRUE(device.model) << device.refusal;
    const double right = release_voltage(Switch(device.model->device(), converged), 0);
    EXPECT_NEAR(release_voltage(*device.model, 0), right, accuracy * right) << contact;
    const auto points = device.model->quadrature().points(), usual = nominal.model.quadrature().points();
    EXPECT_EQ(points > usual, contact > nominal.scene.device.gap.contact);
  }
}

// The panel beyond the electrode is a twenty-fifth of the beam, and the film becomes thin there.
TEST(Quadrature, IsRefinedWhereRoundingForbidsATighterIntegrator) {
  PreparedScene p = prepare(gold({"gap.contact=3.3 um", "waveform.main.level=17.771 V", "driver.main.max_voltage=25 V",
                                  "simulate.duration=53 us", "simulate.accuracy=1e-10"}));
  p.quadrature = {.points_per_length = 40, .points_per_panel = 3};
  p.model = Switch(p.scene.device, p.quadrature);
  const double coarse = largest_error(simulate(p, false).metrics, true_touch(p));
  const Closing c = simulate(p, true);
  EXPECT_GT(c.quadrature.points_per_panel, 6);
  constexpr double expected = 1e-3;
  EXPECT_TRUE(largest_error(c.metrics, true_touch(p)) <= expected * coarse) << largest_error(c.metrics, true_touch(p)) << coarse;
}

// Compares the true errors of t_i and v_i of a scene for accuracies from 1e-3 to 1e-11. Each must be at most three times that
// of a looser accuracy, until the requested accuracy or 1e-10 is reached.
void expect_tighter_is_no_worse(SceneFile file) {
  constexpr double grows = 3, lowest = 1e-10, beyond = 1.02;
  FirstTouch right;
  double duration = 0, least = Metrics::unset;
  for (int digits = 3; digits <= 11; ++digits) {
    const double accuracy = std::pow(10, -digits);
    file.set(fmt::format("simulate.accuracy={}", accuracy));
    PreparedScene p = prepare(file);
    if (duration == 0) right = true_touch(p), duration = std::min(p.duration, beyond * right.time);
    p.duration = duration;
    const double error = largest_error(simulate(p, true).metrics, right);
    EXPECT_TRUE(!(error > grows * std::fmax(least, std::max(accuracy, lowest))) && std::isfinite(error))
        << "accuracy " << accuracy << ": " << error << ", and " << least << " at a looser one";
    least = std::fmin(least, error);
  }
}

TEST(Accuracy, TighterIsNoWorseNextToTheElectrode) {
  expect_tighter_is_no_worse(gold({"gap.contact=3.3 um", "waveform.main.level=17.771 V", "driver.main.max_voltage=25 V"}));
  expect_tighter_is_no_worse(near_electrode());
}

TEST(Accuracy, TighterIsNoWorseOnRandomScenes_slow) {
  constexpr std::uint64_t seed = 20261128;
  int drawn = 0;
  for (std::uint64_t index = 0; drawn < 20; ++index) {
    SceneFile file = test::random_scene(seed, index);
    file.erase("simulate.tolerance");
    const Trajectory loose = simulate(prepare(file), false).trajectory;
    if (loose.touches.empty() || !(loose.touches.front().begin > 0)) continue;
    ++drawn;
    SCOPED_TRACE(fmt::format("scene {}", index));
    expect_tighter_is_no_worse(file);
  }
}

}  // namespace
}  // namespace softland
