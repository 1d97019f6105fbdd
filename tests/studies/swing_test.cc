// The fastest single swing onto the contact.
#include "studies/search/swing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "model/closing.h"
#include "model/constants.h"
#include "objectives/metrics.h"
#include "scenes.h"
#include "studies/closing/prepared.h"
#include "studies/search/bang_bang.h"
#include "studies/search/searched_families.h"

namespace softland {
namespace {

double longest(const PreparedScene& p) { return 3 * 2 * pi / p.model.basis().angular_frequencies()[0]; }

std::vector<double> full_pull(const PreparedScene& p) {
  std::vector<double> values(p.model.drives(), 0.0);
  values[0] = p.drives.at(p.scene.device.electrodes[0].name).limits.value().max_voltage;
  return values;
}

TEST(Swing, OfOneUndampedModeIsTheBangBangLanding) {
  for (const std::string name : {"mem-gold.toml", "gap-closing-actuator.toml"}) {
    const PreparedScene p = prepare(undamped_with_one_mode(name), true);
    const std::vector<double> none(p.model.drives(), 0.0);
    const auto closed_form = bang_bang(p.model, full_pull(p), none);
    const auto swing = quickest_swing(p.model, full_pull(p), none, longest(p));
    ASSERT_TRUE(closed_form && swing) << name;
    EXPECT_NEAR(swing->driven_time, closed_form->driven_time, 5e-4 * closed_form->driven_time) << name;
    EXPECT_NEAR(swing->releasing_time, closed_form->coasting_time, 2 * swing->step) << name;
  }
}

TEST(Swing, BringsEveryModeOfTheGoldSwitchThroughItsFilmToASlowTouch) {
  const PreparedScene p = prepare(gold(), true);
  const std::vector<double> pull = full_pull(p), none(p.model.drives(), 0.0);
  const auto swing = quickest_swing(p.model, pull, none, longest(p));
  ASSERT_TRUE(swing);
  const auto touch = [&](double driven) {
    const std::vector<Signal> signals{signal(Pulse{.levels = {pull[0], 0}, .times = {driven}})};
    return metrics(simulate_closing(p.model, signals, {.duration = 100e-6, .tolerance = 1e-10, .after_contact = 0}));
  };
  // The switch touches at its turning point: with a longer pull it touches, with a shorter one it does not.
  EXPECT_LT(touch(swing->driven_time * (1 + 1e-4)).impact_velocity, 5e-3);
  EXPECT_TRUE(std::isnan(touch(swing->driven_time * (1 - 1e-4)).impact_velocity));
  EXPECT_NEAR(touch(swing->driven_time * (1 + 1e-4)).initial_contact_time, swing->driven_time + swing->releasing_time, 1e-6);
}

// Returns the waveform with jumps, and with a pull that is longer by a thousandth, so that the switch touches.
DriveWaveforms without_edges(DriveWaveforms swing) {
  for (auto& [drive, waveform] : swing) {
    auto& pulse = std::get<Pulse>(waveform);
    const double longer = 1e-3 * pulse.times.front();
    for (double& time : pulse.times) time += longer;
    pulse.edge = 0;
  }
  return swing;
}

// Expects each waveform to touch far more slowly than the step to the same hold levels.
void expect_soft_touches(const PreparedScene& p, const SearchSpace& space, std::size_t least) {
  const auto landing = [&](DriveWaveforms searched) {
    searched.merge(p.drives.waveforms());
    return metrics(simulate_closing(p.model, signals_of(p.in_drive_order(searched)),
                                    {.duration = p.duration, .tolerance = 1e-6, .after_contact = 0}));
  };
  DriveWaveforms steps;
  for (const DriveSearch& s : space.drives()) steps.emplace(s.drive, Step{.level = s.hold});
  const double of_step = landing(steps).impact_velocity;
  const auto swings = joint_rest_to_rest_starts(p, space);
  std::size_t soft = 0;
  for (const auto& swing : swings) {
    EXPECT_EQ(space.misfit(swing), "");
    EXPECT_TRUE(space.parameters(swing).has_value()) << "a catch describes it";
    if (landing(without_edges(swing)).impact_velocity < of_step / 3) ++soft;
  }
  EXPECT_GE(soft, least) << "of " << swings.size();
}

TEST(JointSwings, OfAnElectrodeAndAPiezoTouchSoftly) {
  const PreparedScene p = prepare(gold_pzt(), true);
  expect_soft_touches(p, SearchSpace(p, Actuator::both, "catch", 23.2e-6), 8);
}

TEST(JointSwings, OfElectrodesOnBothSidesTouchSoftly) {
  const PreparedScene p = prepare(scene("two-electrodes.toml"), true);
  expect_soft_touches(p, SearchSpace(p, Actuator::electrostatic, "catch", 29.6e-6), 8);
}

TEST(JointSwings, AreNoneOfAnElectrodeAlone) {
  const PreparedScene p = prepare(gold(), true);
  EXPECT_TRUE(joint_rest_to_rest_starts(p, SearchSpace(p, Actuator::electrostatic, "catch", 34.3e-6)).empty());
}

// The film of a bridge over nitride is a million times thicker at the face than at rest.
TEST(Swing, OfABridgeOverNitrideIsAPullUntilTheTouch) {
  const PreparedScene p = prepare(scene("capacitive-bridge.toml", {"structure.modes=2"}), true);
  const std::vector<double> pull = full_pull(p), none(p.model.drives(), 0.0);
  const auto swing = quickest_swing(p.model, pull, none, longest(p));
  ASSERT_TRUE(swing);
  EXPECT_TRUE(swing->is_overdamped);
  EXPECT_EQ(swing->releasing_time, 0);
  const auto touches = [&](double driven) {
    const std::vector<Signal> signals{signal(Pulse{.levels = {pull[0], 0}, .times = {driven}})};
    return !simulate_closing(p.model, signals, {.duration = longest(p), .after_contact = 0}).touches.empty();
  };
  EXPECT_TRUE(touches(swing->driven_time * (1 + 1e-4)));
  EXPECT_FALSE(touches(swing->driven_time * (1 - 1e-3)));
}

TEST(Swing, IsNoneWhereThePullDoesNotReachTheContact) {
  const PreparedScene p = prepare(gold(), true);
  std::vector<double> weak = full_pull(p);
  weak[0] /= 4;
  EXPECT_FALSE(quickest_swing(p.model, weak, std::vector<double>(p.model.drives(), 0.0), longest(p)));
}

TEST(Swing, IsRefusedWhereTheGasFilmHasStatesOfItsOwn) {
  const PreparedScene p = prepare(gold({"gas.model=reynolds"}), true);
  EXPECT_EQ(refusal([&] { static_cast<void>(quickest_swing(p.model, full_pull(p), full_pull(p), longest(p))); }),
            "the quickest swing is not known where the gas film is compressible");
}

}  // namespace
}  // namespace softland
