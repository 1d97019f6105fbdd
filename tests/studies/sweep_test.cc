// A voltage that is swept quasi-statically up and down again.
#include "studies/closing/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string_view>
#include <vector>

#include "biased.h"
#include "scenes.h"
#include "studies/closing/prepared.h"

namespace softland::sweep_test {
namespace {

std::vector<SweepPoint> branch(const std::vector<SweepPoint>& points, bool is_up) {
  std::vector<SweepPoint> own;
  std::copy_if(points.begin(), points.end(), std::back_inserter(own), [&](const SweepPoint& p) { return p.is_up == is_up; });
  return own;
}

/// Returns the first voltage of a branch, in its order, with the switch in this state; NaN if there is none.
double first(const std::vector<SweepPoint>& points, SweepState state) {
  const auto found = std::find_if(points.begin(), points.end(), [&](const SweepPoint& p) { return p.state == state; });
  return found == points.end() ? std::nan("") : found->voltage;
}

TEST(StaticSweep, ClosesAtThePullInVoltageAndOpensAtTheReleaseVoltage) {
  for (const std::string& name : shipped_scenes()) {
    const Switch model(read_scene(scene(name.c_str())).device);
    if (model.device().electrodes.empty() || !model.has_contact()) continue;
    const double pull_in = static_pull_in(model, 0).voltage, release = release_voltage(model, 0);
    if (!(pull_in > 0) || !std::isfinite(release)) continue;
    const double most = 1.02 * std::max(pull_in, release), step = most / 400;
    const auto points = static_sweep(model, 0, {}, {.first = 0, .last = most, .points = 401});
    ASSERT_EQ(points.size(), 802U);
    const auto up = branch(points, true), down = branch(points, false);
    EXPECT_NEAR(first(up, SweepState::closed), std::max(pull_in, release), 1.01 * step) << name;
    EXPECT_NEAR(first(down, SweepState::open), std::min(pull_in, release), 1.01 * step) << name;
    for (const SweepPoint& p : points) {
      const bool is_above = p.deflection < model.device().gap.contact;
      // A beam may touch the face of a dielectric beside its middle, which is then above the face.
      if (p.state == SweepState::open || !model.device().closes_along_face()) {
        EXPECT_EQ(p.state == SweepState::open, is_above) << name << p.voltage;
      }
      EXPECT_GT(p.capacitance, 0) << name;
    }
    for (std::size_t k = 1; k < up.size(); ++k) EXPECT_GT(up[k].capacitance, up[k - 1].capacitance * (1 - 1e-12)) << name;
  }
}

TEST(StaticSweep, IsThatOfAPlate) {
  // k y = eps0 A V^2 / (2 (d - y)^2), and C = eps0 A / (d - y).
  const Switch model(read_scene(spring_plate()).device);
  constexpr double stiffness = 42, area = 1e-8, gap = 3.8e-6, eps0 = 8.8541878128e-12;
  for (const SweepPoint& p : static_sweep(model, 0, {}, {.first = -80, .last = 80, .points = 33})) {
    ASSERT_EQ(p.state, SweepState::open);
    const double left = gap - p.deflection;
    EXPECT_NEAR(stiffness * p.deflection, eps0 * area * p.voltage * p.voltage / (2 * left * left), 1e-12 * stiffness * gap);
    EXPECT_NEAR(p.capacitance, eps0 * area / left, 1e-12 * p.capacitance);
  }
}

TEST(StaticSweep, KnowsTheBiasOfTheOtherDrives) {
  const PreparedScene p = prepare(small_beam({R"(waveform.piezo={family="step", level="-1 V"})"}));
  const auto points = static_sweep(p.model, 0, bias_of(p.scene, 0), {.first = 0, .last = 5, .points = 2});
  EXPECT_NEAR(points.front().deflection, p.model.contact_deflection(p.model.open_equilibrium(std::vector<double>{0, -1})->data()),
              1e-15);
  EXPECT_GT(points.front().deflection, 1e-9);
}

TEST(StaticSweep, HasNoStateWhereASceneDescribesNone) {
  SceneFile file = spring_plate();
  file.erase("contact");
  const Switch model(read_scene(file).device);
  const auto points = static_sweep(model, 0, {}, {.first = 0, .last = 120, .points = 13});
  EXPECT_EQ(points[12].state, SweepState::none);
  EXPECT_TRUE(std::isnan(points[12].deflection));
  EXPECT_EQ(points.back().state, SweepState::none) << "how it comes off is not described";
  EXPECT_EQ(to_string(points.back().state), "collapsed_onto_electrode");
  const auto falling = static_sweep(model, 0, {}, {.first = 50, .last = 0, .points = 6});
  EXPECT_FALSE(falling.front().is_up);
  EXPECT_TRUE(falling.back().is_up);
  EXPECT_THROW((void)static_sweep(model, 0, {}, {.first = 0, .last = 1, .points = 1}), InvalidInput);
}

TEST(StaticSweep, GivesThePointsUntilItIsAskedToStop) {
  const Switch model(read_scene(spring_plate()).device);
  std::atomic<bool> stop = false;
  std::vector<double> parts;
  const Progress progress{.stop = &stop, .report = [&](std::string_view, double part) {
                            parts.push_back(part);
                            stop = part > 0.25;
                          }};
  const SweepRange range{.first = 0, .last = 80, .points = 33};
  const auto cut = static_sweep(model, 0, {}, range, progress);
  EXPECT_EQ(cut.size(), parts.size());
  EXPECT_LT(cut.size(), 66U);
  const auto whole = static_sweep(model, 0, {}, range);
  for (std::size_t k = 0; k < cut.size(); ++k) EXPECT_EQ(cut[k].deflection, whole[k].deflection);
}

}  // namespace
}  // namespace softland::sweep_test
