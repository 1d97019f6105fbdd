// Tests the voltages of drives before a run, under which the run starts at rest.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "biased.h"
#include "model/pull_in.h"
#include "scenes.h"
#include "studies/closing/prepared.h"
#include "studies/closing/simulate.h"
#include "studies/devices/ensemble.h"

namespace softland::before_test {
namespace {

TEST(Before, IsTheEquilibriumThatARunStartsAndStaysIn) {
  for (const char* volts : {"-2 V", "3 V"}) {
    const SceneFile file = small_beam({fmt::format(R"(waveform.piezo={{family="step", level="{0}", before="{0}"}})", volts),
                                       "waveform.main={family=\"step\", level=\"8 V\", before=\"8 V\"}"});
    const PreparedScene p = prepare(file);
    const Trajectory t = simulate_closing(p.model, p.signals(), {.duration = p.duration, .tolerance = 1e-9});
    ASSERT_EQ(t.status, Status::done);
    ASSERT_TRUE(p.rest().has_value());
    const double rest = p.model.contact_deflection(p.rest()->data());
    EXPECT_GT(std::abs(rest), 1e-9);
    for (const TrajectoryPoint& point : t.points) EXPECT_NEAR(point.position, rest, 1e-6 * std::abs(rest));
    EXPECT_LT(t.energy_error, 1e-9 * p.model.bending_energy());
  }
}

TEST(Before, BalancesTheEnergyOfARunFromIt) {
  const SceneFile file =
      small_beam({R"(waveform.piezo={family="pulse", levels=["-2 V", "1 V"], times=["2 us"], edge="1 us", before="3 V"})",
                  R"(waveform.main={family="step", level="1.2 Vdp", before="9 V"})"});
  const PreparedScene p = prepare(file);
  const Trajectory t = simulate_closing(p.model, p.signals(), {.duration = p.duration, .tolerance = 1e-9, .after_contact = 0});
  ASSERT_FALSE(t.touches.empty());
  EXPECT_LT(t.energy_error, 1e-6 * p.model.bending_energy());
  EXPECT_GT(t.energy.source_work, 0.01 * p.model.bending_energy());
}

TEST(Before, WithoutAStableEquilibriumCollapsesAtRest) {
  const Closing c = simulate(prepare(two_area_plate({R"(waveform.bias={family="step", level="0 V", before="500 V"})"})), true);
  EXPECT_EQ(c.metrics.status, Status::collapsed_at_rest);
  EXPECT_THAT(c.trajectory.message, testing::HasSubstr("before t = 0"));
}

TEST(Before, OfAStretchingBeamIsFoundAsTheLoadGrows) {
  // The bending stiffness is far below that of stretching, so that Newton's method from the straight beam overshoots the gap.
  const SceneFile file =
      scene("hung-senturia.toml", {"structure.stretching=true", "structure.residual_stress=0 MPa", "structure.thickness=0.3 um"});
  const PreparedScene p = prepare(file);
  const double fold = static_pull_in(p.model, 0).voltage;
  const std::vector<double> volts{0.99 * fold};
  const auto rest = p.model.open_equilibrium(volts);
  ASSERT_TRUE(rest.has_value());
  EXPECT_GT(open_tangent_eigenvalue(p.model, *rest, volts), 0);
  EXPECT_FALSE(p.model.open_equilibrium(std::vector<double>{1.01 * fold}).has_value());
}

TEST(Before, IsTheSameInLanes) {
  const SceneFile file = gold_pzt({R"(waveform.piezo={family="step", level="0.5 V", before="0.5 V"})", "waveform.main.before=3 V",
                                   "simulate.duration=100 us"});
  const PreparedScene p = prepare(file);
  const Ensemble ensemble(p, 8);
  DeviceBuilder builder(ensemble);
  std::vector<SampledDevice> devices;
  for (std::uint64_t k = 0; k < ensemble.size(); ++k) devices.push_back(builder.device(k));
  const std::vector<Signal> signals = p.signals();
  std::vector<DeviceClosing> closings;
  for (const SampledDevice& device : devices)
    closings.push_back({.device = &device, .signals = &signals, .run = {.duration = p.duration, .tolerance = 1e-7}});
  const auto alone = close_devices(closings, p.scene.metrics, Vectors::none);
  const auto together = close_devices(closings, p.scene.metrics, vectors_in_use());
  const double from_zero = simulate(prepare(gold_pzt({"simulate.duration=100 us"})), false).metrics.initial_contact_time;
  for (std::size_t k = 0; k < alone.size(); ++k) {
    ASSERT_TRUE(alone[k].closed());
    EXPECT_NEAR(together[k].metrics.initial_contact_time, alone[k].metrics.initial_contact_time, 1e-6 * from_zero) << k;
    EXPECT_GT(std::abs(alone[k].metrics.initial_contact_time / from_zero - 1), 1e-3) << k;
  }
}

TEST(Before, OfTheResolvedSceneGivesTheSameDigits) {
  const SceneFile file = small_beam({R"(waveform.piezo={family="s-curve", levels=["-1 V"], edge="3 us", before="2 V"})",
                                     R"(waveform.main={family="step", level="1.2 Vdp", before="0.3 Vdp", rise_time="1 us"})"});
  const PreparedScene p = prepare(file);
  EXPECT_EQ(p.drives.at("main").before, 0.3 * p.pull_in.at("main").dynamically.voltage);
  const SceneFile written = p.resolved();
  const PreparedScene again = prepare(SceneFile::parse(written.text(), "again.toml"));
  EXPECT_TRUE(again.pull_in.empty());
  EXPECT_EQ(again.values_before(), p.values_before());
  EXPECT_EQ(simulate(again, false).metrics.initial_contact_time, simulate(p, false).metrics.initial_contact_time);
  EXPECT_EQ(read_scene(canonical(file, "c.toml")).file.written("waveform.main.before"), "0.3 Vdp");
}

}  // namespace
}  // namespace softland::before_test
