// Cycles of closing and opening. Oracles: three cycles of a plate by another program, the closed form of an undamped closing
// from a vibration, and the same closing without cycles.
#include "studies/devices/cycling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>

#include "studies/closing/simulate.h"

namespace softland::cycling_test {
namespace {

SceneFile plate(std::string_view rest = "") {
  return SceneFile::parse(std::string(R"(
structure = { kind = "plate", mass = "1e-10 kg", stiffness = "10 N/m", area = "1e-8 m^2", damping_ratio = 0.02 }
gap = { electrode = "4 um", contact = "3 um" }
electrode.main.fringing = "none"
contact = { model = "linear", stiffness = "5 kN/m", damping = "0.5 s/m" }
waveform.main = { family = "step", level = "45 V", rise_time = "0.1 us" }
)") + std::string(rest),
                          "plate.toml");
}

CycleWaveforms ramps() {
  return {.name = "ramps",
          .closing = {Signal::piecewise_linear({{0, 0}, {1e-7, 45}})},
          .opening = {Signal::piecewise_linear({{0, 45}, {1e-7, 0}}, 45)}};
}

TEST(Cycling, GivesThePlateItsThreeCycles) {
  const PreparedScene p = prepare(plate("simulate = { duration = \"40 us\", tolerance = 1e-9 }\n"));
  const CycleWaveforms waveforms = ramps();
  const Cycles found = CycledSwitch(p, p.model, waveforms).run({.period = 80e-6, .on_time = 40e-6, .cycles = 3}, true);
  ASSERT_EQ(found.status, Status::done) << found.message;
  ASSERT_EQ(found.cycles.size(), 3u);
  struct Expected {
    double touch, speed, rebound, opening;
  };
  const Expected expected[] = {{1.526184238258687e-05, 0.6528581540006132, 2.0284313352336818e-07, 2.0664073214554716e-07},
                               {5.83246163370329e-06, 0.6095811175408938, 1.7638705007769854e-07, 2.0949113033556912e-07},
                               {5.808495132464186e-06, 0.6094489426046731, 1.763098023123785e-07, 2.0944193685302966e-07}};
  for (std::size_t n = 0; n < 3; ++n) {
    const Metrics& m = found.cycles[n].metrics;
    EXPECT_TRUE(found.cycles[n].closes && found.cycles[n].opens);
    EXPECT_NEAR(m.initial_contact_time, expected[n].touch, 1e-6 * expected[n].touch);
    EXPECT_NEAR(m.impact_velocity, expected[n].speed, 1e-6 * expected[n].speed);
    EXPECT_NEAR(m.major_bounce_height, expected[n].rebound, 1e-5 * expected[n].rebound);
    EXPECT_NEAR(m.opening_time, expected[n].opening, 1e-6 * expected[n].opening);
    EXPECT_NEAR(m.open_command, 40e-6, 1e-16);
  }
  EXPECT_FALSE(found.gap.empty());
}

// The first cycle equals the closing alone, and the energies of all cycles add up to that of the whole run.
TEST(Cycling, BeginsLikeTheClosingAloneAndSharesTheEnergyOfTheRun) {
  const PreparedScene p = prepare(plate("simulate.duration = \"40 us\"\n"));
  const Metrics alone = simulate(p, false).metrics;
  const CycleWaveforms waveforms = ramps();
  const CycledSwitch cycled(p, p.model, waveforms);
  const Cycles found = cycled.run({.period = 80e-6, .on_time = 40e-6, .cycles = 4}, false);
  ASSERT_EQ(found.cycles.size(), 4u);
  EXPECT_EQ(found.cycles[0].metrics.initial_contact_time, alone.initial_contact_time);
  EXPECT_EQ(found.cycles[0].metrics.impact_velocity, alone.impact_velocity);
  double sum = 0;
  for (const CycleFigures& one : found.cycles) sum += one.metrics.drive_energy;
  // At the end the plate still vibrates: the stored energy is in the plate, the rest was dissipated.
  const Cycles first = cycled.run({.period = 80e-6, .on_time = 40e-6, .cycles = 1}, false);
  EXPECT_NEAR(found.cycles[0].metrics.drive_energy, first.cycles[0].metrics.drive_energy,
              1e-6 * first.cycles[0].metrics.drive_energy);
  EXPECT_GT(sum, found.cycles[0].metrics.drive_energy);
  for (const CycleFigures& one : found.cycles) {
    const Metrics& m = one.metrics;
    EXPECT_NEAR(m.closed_time, m.open_command + m.opening_time - m.initial_contact_time - m.separated, 1e-12);
    EXPECT_GT(m.separated, 0);
  }
}

// Without an electrical rule the switch is electrically closed while in touch.
TEST(Cycling, IsElectricallyClosedWhileItIsInTouch) {
  const PreparedScene p = prepare(plate("simulate = { duration = \"40 us\", tolerance = 1e-9 }\n"));
  const CycleWaveforms waveforms = ramps();
  const Cycles found = CycledSwitch(p, p.model, waveforms).run({.period = 80e-6, .on_time = 40e-6, .cycles = 3}, true);
  ASSERT_EQ(found.cycles.size(), 3u);
  for (const CycleFigures& cycle : found.cycles) {
    EXPECT_GT(cycle.metrics.bounce_count, 0);
    EXPECT_NEAR(cycle.on_time, cycle.metrics.closed_time, 1e-9 * cycle.on_time);
  }
}

TEST(Cycling, IsClosedThroughoutWhereItsDrivesNeverRelease) {
  const PreparedScene p = prepare(plate("simulate.duration = \"40 us\"\n"));
  const CycleWaveforms held{.name = "held",
                            .closing = {Signal::piecewise_linear({{0, 0}, {1e-7, 45}})},
                            .opening = {Signal::piecewise_linear({{0, 45}, {1e-7, 44}}, 45)}};
  const Cycles found = CycledSwitch(p, p.model, held).run({.period = 80e-6, .on_time = 40e-6, .cycles = 3}, true);
  ASSERT_EQ(found.cycles.size(), 3u);
  EXPECT_NEAR(found.cycles[1].on_time, 80e-6, 1e-18);
  EXPECT_NEAR(found.cycles[2].on_time, 80e-6, 1e-18) << "the run ends closed";
}

TEST(Cycling, KeepsTheWaveformOfEveryCycle) {
  CycleWaveforms waveforms;
  waveforms.closing = {Signal(
      {{.begin = 0, .value = 10, .amplitude = 2, .angular_frequency = 3e6, .phase = 0.4}, {.begin = 2e-6, .value = 20}}, 1.5)};
  waveforms.opening = {Signal({{.begin = 0, .value = 20, .slope = -1e7}, {.begin = 1e-6, .value = 0}}, 20)};
  const CycleTimes times{.period = 10e-6, .on_time = 6e-6, .cycles = 3};
  const Signal all = cycled(waveforms, times).front();
  EXPECT_EQ(all.before(), 1.5);
  for (std::size_t n = 0; n < 3; ++n) {
    for (const double t : {0.3e-6, 1.7e-6, 2.5e-6, 5.9e-6})
      EXPECT_NEAR(all.voltage(times.begin(n) + t), waveforms.closing[0].voltage(t), 1e-9);
    for (const double t : {0.3e-6, 1.7e-6, 3.9e-6})
      EXPECT_NEAR(all.voltage(times.command(n) + t), waveforms.opening[0].voltage(t), 1e-9);
  }
  EXPECT_EQ(all.hold_level(), 0);
}

// A plate with slow decay is steady up to the rate at which it no longer comes to rest; the duty is 0.5.
TEST(Cycling, FindsTheLargestRateThatIsSteady) {
  const PreparedScene p = prepare(plate("simulate.duration = \"60 us\"\n"));
  const CycleWaveforms waveforms = ramps();
  const CycledSwitch cycled(p, p.model, waveforms);
  const ScanOptions options{.cycles = 4};
  const RateScan scan = scan_rates(cycled, options);
  ASSERT_TRUE(scan.largest > 0);
  ASSERT_FALSE(scan.rates.empty());
  EXPECT_TRUE(scan.rates.front().is_steady) << "it comes to rest there";
  bool below = true;
  for (const RateScan::Rate& one : scan.rates) {
    // The verdict follows from the figures of all cycles, independent of the scan.
    const Cycles all = cycled.run({.period = 1 / one.rate, .on_time = 0.5 / one.rate, .cycles = 4}, false);
    bool steady = all.cycles.size() == 4;
    for (const CycleFigures& c : all.cycles) {
      const Metrics &own = c.metrics, &first = all.cycles.front().metrics;
      steady = steady && c.closes && c.opens &&
               std::abs(own.largest_impact_velocity - first.largest_impact_velocity) <= 0.05 * first.largest_impact_velocity &&
               std::abs(own.major_bounce_height - first.major_bounce_height) <= std::max(0.05 * first.major_bounce_height, 1e-9);
    }
    EXPECT_EQ(one.is_steady, steady) << one.rate;
    if (below && steady) {
      EXPECT_LE(one.rate, scan.largest);
    } else {
      below = false;
      EXPECT_GT(one.rate, scan.largest);
    }
  }
  const bool has_windows = std::ranges::any_of(scan.rates, [&](const auto& r) { return r.rate > scan.largest && r.is_steady; });
  EXPECT_EQ(has_windows, !scan.windows.empty());
}

TEST(Cycling, RefusesWhatDoesNotFitIntoACycle) {
  const PreparedScene p = prepare(plate("simulate.duration = \"60 us\"\n"));
  const auto message = [&](const CycleWaveforms& waveforms, double rate) -> std::string {
    try {
      static_cast<void>(cycling(p, waveforms, {.rate = rate, .cycles = 2, .devices = 0}));
    } catch (const InvalidInput& wrong) {
      return wrong.what();
    }
    return {};
  };
  EXPECT_THAT(message(ramps(), 6e6), testing::HasSubstr("the closing has 83.33 ns of a cycle"));
  CycleWaveforms other = ramps();
  other.opening = {Signal::piecewise_linear({{0, 40}, {1e-7, 0}}, 40)};
  EXPECT_THAT(message(other, 1e4), testing::HasSubstr("the closing ends with main at 45 V, and the opening begins at 40 V"));
}

}  // namespace
}  // namespace softland::cycling_test
