// The quickest single swing onto the contact.
#include "studies/swing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "model/closing.h"
#include "model/constants.h"
#include "objectives/metrics.h"
#include "scenes.h"
#include "studies/bang_bang.h"
#include "studies/prepared.h"

namespace softland {
namespace {

double longest(const Prepared& p) { return 3 * 2 * pi / p.model.angular_frequencies()[0]; }

std::vector<double> full_pull(const Prepared& p) {
  std::vector<double> values(p.model.drives(), 0.0);
  values[0] = p.drives.limits.at(p.scene.device.electrodes[0].name).max_voltage;
  return values;
}

TEST(Swing, OfOneUndampedModeIsTheBangBangLanding) {
  for (const std::string name : {"mem-gold.toml", "gap-closing-actuator.toml"}) {
    const Prepared p = prepare(undamped_with_one_mode(name), true);
    const std::vector<double> none(p.model.drives(), 0.0);
    const auto closed_form = bang_bang(p.model, full_pull(p), none);
    const auto swing = quickest_swing(p.model, full_pull(p), none, longest(p));
    ASSERT_TRUE(closed_form && swing) << name;
    EXPECT_NEAR(swing->driven_time, closed_form->driven_time, 5e-4 * closed_form->driven_time) << name;
    EXPECT_NEAR(swing->releasing_time, closed_form->coasting_time, 2 * swing->step) << name;
  }
}

TEST(Swing, BringsEveryModeOfTheGoldSwitchThroughItsFilmToASlowTouch) {
  const Prepared p = prepare(gold(), true);
  const std::vector<double> pull = full_pull(p), none(p.model.drives(), 0.0);
  const auto swing = quickest_swing(p.model, pull, none, longest(p));
  ASSERT_TRUE(swing);
  const auto touch = [&](double driven) {
    const std::vector<Signal> signals{signal(Pulse{.levels = {pull[0], 0}, .times = {driven}})};
    return metrics(simulate_closing(p.model, signals, {.duration = 100e-6, .tolerance = 1e-10, .after_contact = 0}));
  };
  // It arrives as it turns back: longer driven it touches, shorter it does not.
  EXPECT_LT(touch(swing->driven_time * (1 + 1e-4)).impact_velocity, 5e-3);
  EXPECT_TRUE(std::isnan(touch(swing->driven_time * (1 - 1e-4)).impact_velocity));
  EXPECT_NEAR(touch(swing->driven_time * (1 + 1e-4)).initial_contact_time, swing->driven_time + swing->releasing_time, 1e-6);
}

TEST(Swing, IsNoneWhereThePullDoesNotReachTheContact) {
  const Prepared p = prepare(gold(), true);
  std::vector<double> weak = full_pull(p);
  weak[0] /= 4;
  EXPECT_FALSE(quickest_swing(p.model, weak, std::vector<double>(p.model.drives(), 0.0), longest(p)));
}

TEST(Swing, IsRefusedWhereTheGasFilmHasStatesOfItsOwn) {
  const Prepared p = prepare(gold({"gas.model=reynolds"}), true);
  EXPECT_EQ(refusal([&] { static_cast<void>(quickest_swing(p.model, full_pull(p), full_pull(p), longest(p))); }),
            "the quickest swing is not known where the gas film is compressible");
}

}  // namespace
}  // namespace softland
