// Openings: against the closed form of an undamped plate, and by searches on the shipped scenes.
#include "studies/search/opening.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/gauss.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "studies/closing/simulate.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

// The plate on its spring, released at t = 0: it leaves its contact, oscillates on its spring, and is pulled from x_1 on to
// rest at 0.
struct ExactOpening {
  double leaves = 0, brakes = 0, rests = 0;  // [s]
  double swing = 0;                          // turning point without the pull [m]
};

ExactOpening exact_opening(const Structure& s, const Gap& gap, double contact_stiffness, double volts) {
  const double force = vacuum_permittivity * s.width * s.length * volts * volts / 2, m = part_of<Plate>(s).mass,
               k = part_of<Plate>(s).stiffness;
  const double g = gap.contact, d = gap.electrode, both = k + contact_stiffness;
  double x0 = g;  // k x + k_c (x - g) = F / (d - x)^2
  for (int i = 0; i < 100; ++i) x0 = (force / ((d - x0) * (d - x0)) + contact_stiffness * g) / both;
  // The motion is about x_c in contact, and about 0 in flight.
  const double x_c = contact_stiffness * g / both, fast = std::sqrt(both / m), omega = std::sqrt(k / m);
  ExactOpening o{.leaves = std::acos((g - x_c) / (x0 - x_c)) / fast};
  const double speed = (x0 - x_c) * fast * std::sin(fast * o.leaves);
  o.swing = std::hypot(g, speed / omega);
  const double energy = k * o.swing * o.swing / 2;
  const double x1 = d - 1 / (energy / force + 1 / d);  // from here on the pull takes up all of the energy
  o.brakes = o.leaves + (std::acos(x1 / o.swing) - std::acos(g / o.swing)) / omega;
  const GaussRule rule = gauss_rule(60);
  o.rests = o.brakes;
  for (std::size_t i = 0; i < rule.points.size(); ++i) {
    const double end = std::sqrt(x1), y = end * (1 + rule.points[i]) / 2, x = y * y;  // the root at rest is smooth in y
    const double work = force * (1 / (d - x) - 1 / d);
    o.rests += rule.weights[i] * end / 2 * 2 * y / std::sqrt((2 * work - k * x * x) / m);
  }
  return o;
}

TEST(OpeningResult, OfAnUndampedPlateIsThatOfItsClosedForm) {
  const PreparedScene p = prepare(spring_plate({"driver.main.max_voltage=100 V"}));
  const ExactOpening exact = exact_opening(p.scene.device.structure, p.scene.device.gap, 1e5, 100);
  const std::vector<double> holds{100};
  const auto closed = closed_equilibrium(p.model, holds);
  ASSERT_TRUE(closed);
  const auto open = [&](const Signal& signal, double drives_end, double window) {
    const Trajectory t = simulate_closing(p.model, std::vector{signal},
                                          {.duration = window, .tolerance = 1e-10, .begins_closed = closed->coordinates()});
    EXPECT_LT(t.energy_error, 1e-8 * p.model.bending_energy());
    return release_figures(t, {.open_position = 0, .width = 0.05 * 2.6e-6, .drives_end = drives_end});
  };
  const OpeningFigures let_go = open(Signal(), 0, 40e-6);  // ends before its next touch
  EXPECT_EQ(let_go.status, Status::not_settled);
  EXPECT_NEAR(let_go.release_time, exact.leaves, 1e-6 * exact.leaves);
  EXPECT_NEAR(let_go.overshoot, exact.swing, 1e-6 * exact.swing);

  const Signal pulse =
      Signal::piecewise_linear({{0, 0}, {exact.brakes, 0}, {exact.brakes, 100}, {exact.rests, 100}, {exact.rests, 0}});
  const OpeningFigures braked = open(pulse, exact.rests, 300e-6);
  EXPECT_EQ(braked.status, Status::done);
  EXPECT_LT(braked.residual_vibration, 1e-6 * 2.6e-6);
  EXPECT_LT(braked.settling_time, exact.rests);

  // The fastest waveform to rest jumps once between the bounds. The search comes as close to it as the edges allow.
  const OpeningResult found = search_opening(spring_plate({"driver.main.max_voltage=100 V"}), {});
  ASSERT_TRUE(found.best);
  EXPECT_TRUE(found.confirmed);
  EXPECT_LT(found.best->figures.settling_time, 1.03 * exact.rests);
  EXPECT_GT(found.best->figures.settling_time, 0.8 * exact.rests);
  EXPECT_LT(found.best->figures.residual_vibration, 0.01 * 2.6e-6);
}

TEST(Gains, NeedAtLeastFivePercent) {
  const double never = OpeningFigures::unset;
  const auto figures = [](double release, double settling, double vibration) {
    return OpeningFigures{
        .status = Status::done, .release_time = release, .settling_time = settling, .residual_vibration = vibration};
  };
  const OpeningFigures plain = figures(1e-6, 20e-6, 1e-6), vibrates = figures(1e-6, never, 1e-6),
                       stays = figures(never, never, never);
  EXPECT_TRUE(gains(figures(1e-6, 18.9e-6, 1e-6), plain));
  EXPECT_FALSE(gains(figures(1e-6, 19.1e-6, 1e-9), plain)) << "the settling time counts";
  EXPECT_TRUE(gains(figures(1e-6, never, 0.94e-6), vibrates));
  EXPECT_FALSE(gains(figures(1e-6, never, 0.96e-6), vibrates));
  EXPECT_TRUE(gains(plain, vibrates));
  EXPECT_FALSE(gains(vibrates, plain));
  EXPECT_TRUE(gains(vibrates, stays));
  EXPECT_FALSE(gains(stays, plain));
}

TEST(OpeningResult, StopsTheShippedSwitchesInTheirBand_slow) {
  for (const char* name : {"mem-gold.toml", "mem-gold-pzt.toml", "nem-tin.toml", "two-electrodes.toml"}) {
    const OpeningResult r = search_opening(scene(name), {.jobs = 2});
    ASSERT_TRUE(r.best) << name;
    EXPECT_TRUE(r.confirmed) << name;
    EXPECT_TRUE(r.better) << name;
    EXPECT_LT(r.best->figures.residual_vibration, 0.1 * r.plain.figures.residual_vibration) << name;
    EXPECT_EQ(r.best->figures.touches, 0) << name;
    const auto& limits = r.given.drives.at("main").limits.value();
    EXPECT_LE(r.best->signals[0].maximum(), limits.max_voltage * (1 + 1e-12)) << name;
    EXPECT_EQ(r.best->signals[0].hold_level(), 0) << name;
  }
}

TEST(OpeningResult, IsTheSameForAnyNumberOfJobs_slow) {
  const OpeningResult one = search_opening(gold(), {.max_evaluations = 1000, .seed = 5, .jobs = 1});
  const OpeningResult two = search_opening(gold(), {.max_evaluations = 1000, .seed = 5, .jobs = 2});
  EXPECT_EQ(one.search.x, two.search.x);
  EXPECT_EQ(one.best->figures.settling_time, two.best->figures.settling_time);
  const SceneFile other = scene("gap-closing-actuator.toml");
  EXPECT_NE(search_opening(other, {.seed = 1, .jobs = 2}).search.x, search_opening(other, {.seed = 2, .jobs = 2}).search.x);
}

TEST(OpeningResult, OnDevicesThatHardlyDifferIsThatOfTheNominalOne) {
  const auto alike = [](const std::string& cov) {
    const std::string normal = "distribution = \"normal\", cov = \"" + cov + "\" }";
    return gold({"spread.gaps={ keys = [\"gap.electrode\", \"gap.contact\"], " + normal,
                 "spread.\"structure.thickness\"={ " + normal, "spread.\"structure.youngs_modulus\"={ " + normal});
  };
  const auto opened = [](const SceneFile& file, int jobs) {
    return search_opening(file, {.max_evaluations = 1000, .jobs = jobs, .devices = 24});
  };
  const OpeningResult close = opened(alike("0.0001 %"), 1);
  ASSERT_TRUE(close.on_devices && close.goal_met);
  const DeviceOpenings &plain = close.on_devices->plain, &best = close.on_devices->best;
  EXPECT_EQ(close.on_devices->devices, 24U);
  EXPECT_FALSE(close.on_devices->spread_assumed);
  EXPECT_EQ(best.in_band, 1);
  EXPECT_EQ(plain.in_band, 0);
  EXPECT_NEAR(best.settling_time, close.best->figures.settling_time, 1e-3 * best.settling_time);
  EXPECT_NEAR(best.residual_vibration, close.best->figures.residual_vibration, 0.02 * best.residual_vibration);
  EXPECT_NEAR(plain.residual_vibration, close.plain.figures.residual_vibration, 1e-3 * plain.residual_vibration);
  const OpeningResult apart = opened(alike("2 %"), 1), again = opened(alike("2 %"), 2);
  EXPECT_GT(apart.on_devices->best.residual_vibration, 2 * best.residual_vibration);
  EXPECT_EQ(again.on_devices->best.residual_vibration, apart.on_devices->best.residual_vibration);
  EXPECT_FALSE(search_opening(gold(), {.max_evaluations = 100, .devices = 0}).on_devices);
}

TEST(OpeningResult, LeavesASceneOfWhatItsDrivesAreTold) {
  const OpeningResult r = search_opening(gold(), {.max_evaluations = 300, .devices = 0});
  const PreparedScene told = prepare(r.scene.value());
  const Signal signal = told.signals().front();
  for (const SignalPiece& piece : r.best->signals[0].pieces()) {
    for (const double part : {0.0, 0.5}) {
      const double t = piece.begin + part * 1e-9;
      EXPECT_NEAR(signal.voltage(t), r.best->signals[0].voltage(t), 1e-9 * r.holds[0]) << t;
    }
  }
  EXPECT_EQ(signal.hold_level(), 0);
}

TEST(OpeningResult, KeepsToWhatTheSourceCanDo) {
  const OpeningResult r =
      search_opening(gold({"driver.main.max_voltage=20 V", "driver.main.max_slew=10 V/us", "waveform.main.rise_time=2 us",
                           "driver.main.sample_rate=10 MHz", "driver.main.min_voltage=0 V", "driver.main.bits=8",
                           "driver.main.bandwidth=1 MHz"}),
                     {.max_evaluations = 1000});
  ASSERT_TRUE(r.best);
  const Signal& signal = r.best->signals[0];
  EXPECT_NEAR(signal.voltage(0), r.holds[0], 1e-9);
  EXPECT_NEAR(std::remainder(r.holds[0], 20.0 / 255), 0, 1e-9);  // a level of the converter
  EXPECT_LE(signal.maximum(), 20 * (1 + 1e-12));
  double fastest = 0;
  for (std::size_t k = 1; k < signal.pieces().size(); ++k) {
    EXPECT_NEAR(signal.voltage_before(signal.pieces()[k].begin), signal.voltage(signal.pieces()[k].begin), 1e-6);
    fastest = std::max(fastest, std::abs(signal.pieces()[k].rate(signal.pieces()[k].begin)));
  }
  EXPECT_LE(fastest, 10e6 * (1 + 1e-9));
  EXPECT_NEAR(signal.hold_level(), 0, 1e-12);
  EXPECT_TRUE(r.confirmed);
}

TEST(OpeningResult, HoldsWithTheForceThatAClosingEndsOn) {
  const OpeningResult r = search_opening(gold(), {.max_evaluations = 50});
  EXPECT_NEAR(r.contact_force, simulate(r.given, false).metrics.hold_force, 1e-9 * r.contact_force);
}

TEST(OpeningResult, RefusesWhatCannotBeOpenedOrBraked) {
  const auto why = [](const SceneFile& file, const OpeningOptions& options = {}) {
    return refusal([&] { (void)search_opening(file, options); });
  };
  EXPECT_NE(why(without(gold(), "contact")).find("needs a [contact]"), std::string::npos);
  EXPECT_NE(why(gold({"waveform.main.level=1 V"})).find("do not keep the switch closed"), std::string::npos);
  EXPECT_NE(why(gold(), {.actuator = Actuator::pzt}).find("needs a [piezo]"), std::string::npos);
  EXPECT_NE(why(scene("nem-casimir.toml")).find("needs an electrode"), std::string::npos);
  EXPECT_NE(why(without(gold_pzt(), "driver.piezo"), {.actuator = Actuator::both}).find("[driver.piezo]"), std::string::npos);
  EXPECT_NE(why(gold(), {.band = 1}).find("band"), std::string::npos);
}

}  // namespace
}  // namespace softland
