// Properties of random scenes: bench/soak.cc checks the same on thousands.
#include "tests/support/random_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "studies/closing/prepared.h"
#include "tests/support/invariants.h"

namespace softland {
namespace {

constexpr std::uint64_t seed = 7;

/// Returns a prepared random scene without a compressible film, whose closings take a hundred times longer.
PreparedScene random_closing() {
  while (true) {
    PreparedScene p = prepare(test::random_scene(seed, *rc::gen::inRange<std::uint64_t>(0, 1'000'000)));
    if (p.model.film_states() == 0) return p;
  }
}

test::CheckedRun closing(const PreparedScene& p, Integrator integrator, double tolerance) {
  return test::checked_run(p.model, p.signals(),
                           {.duration = p.duration, .tolerance = tolerance, .integrator = integrator, .max_steps = 20'000}, 1e-3,
                           p.scene.metrics);
}

TEST(EveryScene, KeepsTheInvariants) {
  EXPECT_TRUE(rc::check([] {
    const PreparedScene p = random_closing();
    const test::CheckedRun run = closing(p, Integrator::automatic, 1e-8);
    RC_LOG() << p.scene.file.text();
    RC_ASSERT(run.violations == std::vector<std::string>{});
  }));
}

// Scenes that once violated an invariant in bench/soak.cc.
TEST(EveryScene, ThatOnceBrokeAnInvariantKeepsItNow) {
  struct Found {
    std::uint64_t seed, index;
    double tolerance;
  };
  for (const Found& f : {
           Found{3, 50, 1e-5},      // a step that began after its end, by rounding
           Found{7, 165398, 1e-8},  // a drive far above pull-in gave more energy in contact than the bound of its depth allowed
       }) {
    const PreparedScene p = prepare(test::random_scene(f.seed, f.index));
    EXPECT_EQ(closing(p, Integrator::automatic, f.tolerance).violations, std::vector<std::string>{}) << f.seed << " " << f.index;
  }
}

// A film in a nearly closed gap, for which the explicit method took more than 100 000 steps. In the last scene it also creeps
// into a contact with memory, where rounding gave 47 000 reversals.
TEST(EveryScene, ThatCreepsInAThickFilmIsClosedInBoundedWork) {
  for (const std::uint64_t index : {844U, 3916U, 4490U}) {
    SCOPED_TRACE(index);
    const PreparedScene p = prepare(test::random_scene(2, index));
    const auto run = [&](Integrator integrator, double tolerance) {
      const test::CheckedRun c = closing(p, integrator, tolerance);  // at most 20 000 steps
      EXPECT_EQ(c.violations, std::vector<std::string>{});
      EXPECT_EQ(c.trajectory.status, Status::done) << c.trajectory.message;
      EXPECT_EQ(c.trajectory.work.integrator, Integrator::bdf);
      return c.trajectory;
    };
    const Trajectory t = run(Integrator::automatic, 1e-7), expected = run(Integrator::bdf, 1e-9);
    EXPECT_LT(t.energy_error, 1e-5 * p.model.bending_energy());  // observed: 5e-7
    const test::Landing a = test::landing(t), b = test::landing(expected);
    EXPECT_NEAR(a.time, b.time, 1e-6 * b.time);
    EXPECT_NEAR(a.velocity, b.velocity, 1e-6 * b.velocity);
    EXPECT_NEAR(t.points.back().position, expected.points.back().position, 1e-6 * t.contact_gap);
  }
}

// The motion is accurate although fast modes oscillate for long, or an implicit method takes long steps for a stiff film: the
// dissipation must be integrated with the same accuracy.
TEST(EveryScene, HasAnEnergyBalanceAsAccurateAsItsMotion) {
  const auto error = [](std::uint64_t index, Integrator integrator) {
    const PreparedScene p = prepare(test::random_scene(2, index));
    const Trajectory t =
        simulate_closing(p.model, p.signals(), {.duration = p.duration, .tolerance = 1e-7, .integrator = integrator});
    return t.energy_error / p.model.bending_energy();
  };
  EXPECT_LT(error(2160, Integrator::automatic), 4e-4);  // Simpson's rule alone leaves 1.2e-3, the refined rule 1.4e-4
  EXPECT_LT(error(3880, Integrator::automatic), 4e-4);  // likewise 8e-4 and 1.0e-4
  EXPECT_LT(error(1050, Integrator::esdirk), 1e-4);     // with a quintic through accelerations 0.47, with a cubic 7e-6
}

// These runs use the default integrator of other scenes, as a study of accuracy does.
TEST(EveryScene, HasAnEnergyBalanceWithACompressibleFilm) {
  for (const std::uint64_t index : {37U, 42U}) {
    SCOPED_TRACE(index);
    const PreparedScene p = prepare(test::random_film_scene(2, index).value());
    const Trajectory t = simulate_closing(
        p.model, p.signals(), {.duration = p.duration, .tolerance = 1e-3, .integrator = Integrator::lawson, .max_steps = 4000});
    EXPECT_EQ(t.status, Status::done) << t.message;
    EXPECT_LT(t.energy_error, 1e-2 * p.model.bending_energy());  // observed: 7e-4, 2e-3; another step's film: 0.26, 0.025
  }
}

TEST(EveryScene, LandsAlikeFromTwoIntegrators_slow) {
  EXPECT_TRUE(rc::check([] {
    const PreparedScene p = random_closing();
    const test::CheckedRun one = closing(p, Integrator::lawson, 1e-9), other = closing(p, Integrator::bdf, 1e-8);
    if (one.trajectory.status != Status::done || other.trajectory.status != Status::done) return;
    const test::Landing a = test::landing(one.trajectory), b = test::landing(other.trajectory);
    RC_LOG() << p.scene.file.text() << fmt::format("{} s, {} m/s and {} s, {} m/s", a.time, a.velocity, b.time, b.velocity);
    // Slow first touches, and those just above pull-in, have errors above the tolerance.
    const double scale = p.model.device().gap.contact * p.model.basis().angular_frequencies()[0];
    RC_ASSERT(std::abs(a.time - b.time) <= 1e-4 * a.time);
    RC_ASSERT(std::abs(a.velocity - b.velocity) <= 1e-3 * std::max(a.velocity, scale));
  }));
}

}  // namespace
}  // namespace softland
