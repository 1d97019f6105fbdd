// Properties of random scenes: bench/soak.cc asks the same of thousands.
#include "tests/support/random_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "studies/prepared.h"
#include "tests/support/invariants.h"

namespace softland {
namespace {

constexpr std::uint64_t seed = 7;

/// A prepared random scene without a compressible film, whose closings take a hundred times longer.
Prepared random_closing() {
  while (true) {
    Prepared p = prepare(test::random_scene(seed, *rc::gen::inRange<std::uint64_t>(0, 1'000'000)));
    if (p.device.film_states() == 0) return p;
  }
}

test::CheckedRun closing(const Prepared& p, Integrator integrator, double tolerance) {
  return test::checked_run(p.device, p.signals(),
                           {.duration = p.duration, .tolerance = tolerance, .integrator = integrator, .max_steps = 10'000}, 1e-3,
                           p.scene.metrics);
}

TEST(EveryScene, KeepsTheInvariants) {
  EXPECT_TRUE(rc::check([] {
    const Prepared p = random_closing();
    const test::CheckedRun run = closing(p, Integrator::automatic, 1e-8);
    RC_LOG() << p.scene.file.text();
    RC_ASSERT(run.violations == std::vector<std::string>{});
  }));
}

// Scenes that soaks have found wanting.
TEST(EveryScene, ThatOnceBrokeAnInvariantKeepsItNow) {
  struct Found {
    std::uint64_t seed, index;
    double tolerance;
  };
  for (const Found& f : {Found{3, 50, 1e-5}}) {  // a step that began beyond its edge, by rounding, ended before it began
    const Prepared p = prepare(test::random_scene(f.seed, f.index));
    EXPECT_EQ(closing(p, Integrator::automatic, f.tolerance).violations, std::vector<std::string>{}) << f.seed << " " << f.index;
  }
}

TEST(EveryScene, LandsAlikeFromTwoIntegrators) {
  EXPECT_TRUE(rc::check([] {
    const Prepared p = random_closing();
    const test::CheckedRun one = closing(p, Integrator::lawson, 1e-9), other = closing(p, Integrator::bdf, 1e-8);
    if (one.trajectory.status != Status::done || other.trajectory.status != Status::done) return;
    const test::Landing a = test::landing(one.trajectory), b = test::landing(other.trajectory);
    RC_LOG() << p.scene.file.text() << fmt::format("{} s, {} m/s and {} s, {} m/s", a.time, a.velocity, b.time, b.velocity);
    // Slow first touches and those just above pull-in are less certain than the tolerance.
    const double scale = p.device.device().gap.contact * p.device.angular_frequencies()[0];
    RC_ASSERT(std::abs(a.time - b.time) <= 1e-4 * a.time);
    RC_ASSERT(std::abs(a.velocity - b.velocity) <= 1e-3 * std::max(a.velocity, scale));
  }));
}

}  // namespace
}  // namespace softland
