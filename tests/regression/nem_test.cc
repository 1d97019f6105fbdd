// The two nano-switches: their scenes, as far as published numbers allow a comparison.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "objectives/metrics.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

Trajectory step(const Switch& model, double value, double periods) {
  std::vector<Signal> drives(model.drives());
  drives[0] = Signal::constant(value);
  return simulate_closing(model, drives,
                          {.duration = periods * 2 * pi / model.basis().angular_frequencies()[0], .tolerance = 1e-8});
}

TEST(NemTin, PullsInNearTheClosedFormOfTheFullLengthElectrode) {
  // beta = 1.680841 without fringing and dispersion gives 13.6 V for these dimensions.
  Device d = test::nano_cantilever();
  d.dispersion.reset();
  d.electrodes[0].fringing = Fringing::none;
  const double ideal = static_pull_in(Switch(d), 0).voltage;
  EXPECT_NEAR(ideal, 13.6, 0.05);
  const Switch model(test::nano_cantilever());
  const StaticPullIn fold = static_pull_in(model, 0);
  EXPECT_EQ(fold.kind, StaticKind::fold);
  EXPECT_LT(fold.voltage, ideal);
  EXPECT_GT(fold.voltage, 0.9 * ideal);
}

TEST(NemTin, DispersionLowersBothPullInVoltagesAndTheirDeflection) {
  Device d = test::nano_cantilever();
  const Switch with(d);
  d.dispersion.reset();
  const Switch without(d);
  const StaticPullIn a = static_pull_in(with, 0), b = static_pull_in(without, 0);
  EXPECT_LT(a.voltage, b.voltage);
  EXPECT_LT(a.deflection, b.deflection);
  EXPECT_LT(dynamic_pull_in(with, 0, a).voltage, dynamic_pull_in(without, 0, b).voltage);
  EXPECT_LT(release_voltage(with, 0), release_voltage(without, 0));
}

TEST(NemTin, ClosesBouncesAndSettlesAtItsVoltage) {
  const Switch model(test::nano_cantilever());
  const DynamicPullIn dynamic = dynamic_pull_in(model, 0, static_pull_in(model, 0));
  ASSERT_EQ(dynamic.status, Status::done);
  const Trajectory t = step(model, 1.25 * dynamic.voltage, 40);
  ASSERT_EQ(t.status, Status::done) << t.message;
  const Metrics m = metrics(t, {.significant_rebound = 1e-11});
  EXPECT_LT(m.initial_contact_time, 2 * pi / model.basis().angular_frequencies()[0]);
  EXPECT_GT(m.bounce_count, 0);
  EXPECT_GT(t.smallest_gap, 2.5_nm) << "2.8 nm with four times the quadrature points, which then come nearest to the end";
}

TEST(NemCasimir, HangsFreeAndClosesWhenTheForceGrowsByAQuarter) {
  const Switch model(test::casimir_cantilever());
  ASSERT_TRUE(model.rest().has_value());
  const StaticPullIn fold = static_pull_in(model, 0);
  ASSERT_EQ(fold.status, Status::done);
  EXPECT_EQ(fold.kind, StaticKind::fold);
  const DynamicPullIn dynamic = dynamic_pull_in(model, 0, fold);
  ASSERT_EQ(dynamic.status, Status::done);
  // A step from rest overshoots, so that it needs less than the fold; both are between the nominal force and a quarter more.
  EXPECT_GT(dynamic.voltage, 0.02);
  EXPECT_LT(dynamic.voltage, fold.voltage);
  EXPECT_LT(fold.voltage, 0.22);
  for (const double part : {0.999, 1.001}) {
    EXPECT_EQ(step(model, part * dynamic.voltage, 100).touches.empty(), part < 1);
  }

  const Trajectory t = step(model, 0.25, 40);
  ASSERT_EQ(t.status, Status::done) << t.message;
  EXPECT_FALSE(t.touches.empty());
  EXPECT_GT(metrics(t, {.significant_rebound = 1e-10}).bounce_count, 0);
  // The closed switch stays closed if the force returns to its nominal value.
  EXPECT_TRUE(closed_equilibrium(model, std::vector<double>{0.0}).has_value());
}

}  // namespace
}  // namespace softland
