// Runs that begin closed. Oracles: the balance of forces on a plate, its linear oscillator, and a run that is started from the
// closed equilibrium by ClosingOptions::begins_closed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "scenes.h"
#include "studies/closing/accuracy.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/certify.h"
#include "studies/closing/effects.h"
#include "studies/closing/prepared.h"
#include "studies/closing/simulate.h"
#include "studies/devices/derivatives.h"
#include "studies/devices/evaluator.h"
#include "studies/devices/robustness.h"
#include "studies/inverse/identification.h"
#include "studies/search/limit.h"
#include "studies/search/opening.h"
#include "studies/search/optimize.h"

namespace softland::closed_start_test {
namespace {

using testing::HasSubstr;

constexpr double eps0 = 8.8541878128e-12;

/// A plate that is closed at 90 V, above its pull-in voltage, and switched off.
SceneFile relay(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = SceneFile::parse(R"(
structure = { kind = "plate", mass = "1 ug", stiffness = "100 N/m", area = "0.04 mm^2" }
gap = { electrode = "4 um", contact = "3 um" }
electrode.main.fringing = "none"
gas = { model = "linear", quality_factor = 0.7 }
contact = { model = "linear", stiffness = "100 kN/m" }
waveform.main = { family = "step", before = "90 V", level = "0 V" }
)",
                                    "relay.toml");
  for (const std::string_view change : changes) file.set(change);
  return file;
}
SceneFile closed_relay(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = relay({"waveform.main.before_state=closed"});
  for (const std::string_view change : changes) file.set(change);
  return file;
}

/// Returns the position of a plate on a linear contact: k y + k_c (y - dt) = eps0 A V^2 / (2 (d - y)^2), by Newton's method.
double pressed_to(double volts) {
  constexpr double k = 100, kc = 1e5, area = 4e-8, d = 4e-6, dt = 3e-6;
  double y = dt;
  for (int i = 0; i < 50; ++i) {
    const double force = eps0 * area * volts * volts / (2 * (d - y) * (d - y));
    y += (force - k * y - kc * (y - dt)) / (k + kc - 2 * force / (d - y));
  }
  return y;
}

TEST(ClosedStart, NamesTheOtherStateAndTheKeyWhereTheOneAskedForDoesNotExist) {
  const Closing open = simulate(prepare(relay()), true);
  EXPECT_EQ(open.metrics.status, Status::collapsed_at_rest);
  EXPECT_THAT(open.trajectory.message, HasSubstr("no stable open state"));
  EXPECT_THAT(open.trajectory.message, HasSubstr("3.011673 um; waveform.main.before_state = \"closed\" begins there"));
  EXPECT_NEAR(open.trajectory.other_start, pressed_to(90), 1e-15);
  EXPECT_THAT(open.warnings, testing::Contains(open.trajectory.message));
  const Closing closed = simulate(prepare(closed_relay({"waveform.main.before=5 V"})), true);
  EXPECT_EQ(closed.metrics.status, Status::collapsed_at_rest);
  EXPECT_THAT(closed.trajectory.message, HasSubstr("no stable closed state"));
  EXPECT_THAT(closed.trajectory.message, HasSubstr("without waveform.main.before_state = \"closed\" a run begins there"));
  EXPECT_LT(closed.trajectory.other_start, 1e-7);
}

TEST(ClosedStart, ThatDoesNotExistIsNamedForSeveralContactsToo) {
  SceneFile file = closed_relay({"waveform.main.before=5 V"});
  for (const char* key : {"contact", "gap.contact"}) file.erase(key);
  file.set(R"(contact.stop={gap="3 um",model="linear",stiffness="100 kN/m"})");
  file.set(R"(contact.back={side="far",gap="0.5 um",model="linear",stiffness="2 kN/m"})");
  const Closing closed = simulate(prepare(file), true);
  EXPECT_EQ(closed.metrics.status, Status::collapsed_at_rest);
  EXPECT_THAT(closed.trajectory.message, HasSubstr("no stable closed state"));
}

TEST(ClosedStart, BeginsInTheClosedEquilibriumAndIsDoneWhereItEndsOpenAndAtRest) {
  const PreparedScene p = prepare(closed_relay());
  const Closing c = simulate(p, true);
  EXPECT_EQ(c.metrics.status, Status::done) << testing::PrintToString(c.warnings);
  EXPECT_NEAR(c.trajectory.points.front().position, pressed_to(90), 1e-13);
  EXPECT_NEAR(c.trajectory.points.front().position, 3.011673e-6, 5e-13);
  EXPECT_TRUE(c.trajectory.began_closed);
  for (const double none :
       {c.metrics.initial_contact_time, c.metrics.impact_velocity, c.metrics.permanent_contact_time, c.metrics.bounce_time,
        c.metrics.major_bounce_height, c.metrics.peak_contact_force, c.metrics.largest_impact_velocity})
    EXPECT_TRUE(std::isnan(none));
  EXPECT_TRUE(c.rebounds.empty());
  EXPECT_NEAR(c.metrics.static_deflection, 0, 1e-15);
  EXPECT_TRUE(std::isfinite(c.metrics.open_settling_time));
  EXPECT_TRUE(c.metrics.settled);
  // Released from the contact plane at rest the plate is a damped oscillator with Q = 0.7: it overshoots by exp(-pi zeta / root).
  const double zeta = 1 / (2 * 0.7), root = std::sqrt(1 - zeta * zeta);
  constexpr double pressed = 1e-3;  // depth of the contact, 11.7 nm, over the travel
  EXPECT_NEAR(c.metrics.overshoot, 3e-6 * std::exp(-3.14159265358979 * zeta / root), pressed * 3e-6);
}

TEST(ClosedStart, IsTheRunThatBeginsInThatEquilibriumByHand) {
  for (const SceneFile& file : {closed_relay(), closed_relay({"contact={model=\"rigid\", restitution=0.02}"}),
                                gold({"waveform.main={family=\"step\", before=\"17 V\", before_state=\"closed\", level=\"2 V\"}",
                                      "simulate.duration=60 us"})}) {
    const PreparedScene p = prepare(file);
    const std::vector<double> before = p.values_before();
    const auto closed = closed_equilibrium(p.model, before);
    ASSERT_TRUE(closed.has_value());
    const std::vector<Signal> signals = p.signals();
    const Trajectory by_hand =
        simulate_closing(p.model, signals, {.duration = p.duration, .tolerance = 1e-8, .begins_closed = closed->coordinates()});
    const Trajectory by_key =
        simulate_closing(p.model, signals, {.duration = p.duration, .tolerance = 1e-8, .start = StartState::closed});
    ASSERT_EQ(by_key.status, Status::done) << by_key.message;
    ASSERT_EQ(by_key.points.size(), by_hand.points.size());
    for (std::size_t i = 0; i < by_key.points.size(); ++i) EXPECT_EQ(by_key.points[i].position, by_hand.points[i].position);
    EXPECT_LT(by_key.energy_error, 1e-6 * p.model.bending_energy());
  }
}

TEST(ClosedStart, IsKeptByEveryWayInWhichASceneIsWrittenAgain) {
  const SceneFile file = closed_relay();
  const PreparedScene p = prepare(file);
  for (const SceneFile& again : {p.resolved(), canonical(file, "again.toml"), file.again("again.toml")}) {
    const Scene scene = read_scene(again);
    EXPECT_TRUE(scene.begins_closed);
    EXPECT_EQ(simulate(prepare(again), false).metrics.open_settling_time, simulate(p, false).metrics.open_settling_time);
  }
  SceneFile other = file;
  other.set_waveform("main", Step{.level = 1});
  EXPECT_TRUE(read_scene(other).begins_closed);
}

TEST(ClosedStart, SaysSoWhereItDoesNotEndOpenAndAtRest) {
  const Closing stays = simulate(prepare(closed_relay({"waveform.main.level=85 V"})), true);
  EXPECT_EQ(stays.metrics.status, Status::not_settled);
  EXPECT_THAT(stays.warnings, testing::Contains(HasSubstr("its contact is closed when the window ends")));
  const Closing swings = simulate(prepare(closed_relay({"gas.quality_factor=200", "simulate.duration=100 us"})), true);
  EXPECT_EQ(swings.metrics.status, Status::not_settled);
  EXPECT_THAT(swings.warnings, testing::Contains(HasSubstr("not at rest in its open state")));
  const Closing certified = certify(prepare(closed_relay()));
  EXPECT_EQ(certified.metrics.status, Status::done);
}

TEST(ClosedStart, HasRules) {
  EXPECT_THAT(refusal([] { (void)read_scene(relay({"waveform.main.before_state=shut"})); }), HasSubstr("before_state"));
  SceneFile without = closed_relay();
  without.erase("contact");
  EXPECT_THAT(refusal([&] { (void)read_scene(without); }), HasSubstr("before_state"));
  EXPECT_THAT(refusal([&] { (void)read_scene(without); }), HasSubstr("needs a [contact]"));
  const SceneFile two = closed_relay({"electrode.main.area=0.02 mm^2", "electrode.other={area=\"0.01 mm^2\", fringing=\"none\"}",
                                      "waveform.other={family=\"step\", level=\"0 V\", before_state=\"open\"}"});
  EXPECT_THAT(refusal([&] { (void)read_scene(two); }), HasSubstr("contradicts waveform.main.before_state"));
}

TEST(ClosedStart, IsRefusedByNameByEveryStudyThatClosesTheSwitch) {
  SceneFile file = gold({"waveform.main={family=\"step\", before=\"17 V\", before_state=\"closed\", level=\"17 V\"}",
                         "driver.main.max_voltage=25 V", "simulate.duration=60 us"});
  const PreparedScene p = prepare(file);
  const SceneFile automatic = [&] {
    SceneFile changed = file;
    changed.set("simulate.effects=auto");
    return changed;
  }();
  const std::vector<std::pair<std::string, std::function<void()>>> studies{
      {"optimize closes", [&] { (void)optimize(file, {}); }},
      {"limit closes", [&] { (void)limit(file, {}); }},
      {"calibrate closes", [&] { (void)identify(file, {}); }},
      {"robustness closes", [&] { (void)robustness(p, {}, {}); }},
      {"accuracy closes", [&] { (void)study_accuracy(p, {}); }},
      {"effects closes", [&] { (void)compare_effects(p); }},
      {"effects = \"auto\"", [&] { (void)prepare_and_choose(automatic); }},
      {"evaluator closes", [&] { (void)Evaluator(file, {"gap.contact"}, {figure_of(&Metrics::initial_contact_time)}, {}); }},
  };
  for (const auto& [name, study] : studies) {
    const std::string why = refusal(study);
    EXPECT_THAT(why, HasSubstr("waveform.main.before_state")) << name;
    EXPECT_THAT(why, HasSubstr(name));
    EXPECT_THAT(why, HasSubstr("from the open state")) << name;
  }
}

TEST(ClosedStart, MakesTheSceneOfAnOpeningRunAsTheOpeningDid) {
  const OpeningResult found = search_opening(gold_at_17_volts(), {.max_evaluations = 30, .devices = 0});
  ASSERT_TRUE(found.best && found.scene);
  const PreparedScene p = prepare(*found.scene);
  EXPECT_TRUE(p.scene.begins_closed);
  const Trajectory t =
      simulate_closing(p.model, p.signals(), {.duration = found.window, .tolerance = p.tolerance, .start = p.start()});
  ASSERT_FALSE(t.touches.empty());
  constexpr double of_tolerance = 1e-3;  // relative tolerance of both runs
  EXPECT_NEAR(t.touches.back().end, found.best->figures.release_time, of_tolerance * found.best->figures.release_time);
}

}  // namespace
}  // namespace softland::closed_start_test
