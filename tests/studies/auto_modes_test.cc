// The choice of the number of modes by modes = "auto".
#include "studies/closing/auto_modes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/effect_ablation.h"
#include "studies/closing/simulate.h"

namespace softland {
namespace {

using testing::Contains;
using testing::HasSubstr;

SceneFile gold_with_modes(const char* modes) { return gold_at_17_volts({std::string("structure.modes=") + modes}); }

double rebound(const char* modes) {
  return simulate(prepare_and_choose(gold_with_modes(modes)), false).metrics.major_bounce_height;
}

TEST(AutoModes, AreNotMisledByModesThatAgreeByChance) {
  // Three to five modes agree with each other, and are wrong by a tenth.
  const double converged = rebound("14");
  EXPECT_NEAR(rebound("3"), rebound("4"), auto_modes_tolerance * rebound("4"));
  EXPECT_NEAR(rebound("4"), rebound("5"), auto_modes_tolerance * rebound("5"));
  EXPECT_GT(std::abs(rebound("4") - converged), 0.08 * converged);

  const AutoModes found = choose_modes(gold_with_modes("auto"));
  EXPECT_TRUE(found.settled());
  EXPECT_GE(found.modes, 8);
  EXPECT_LE(found.modes, 11);
  EXPECT_NEAR(rebound(std::to_string(found.modes).c_str()), converged, 2 * auto_modes_tolerance * converged);
}

TEST(AutoModes, SayWhenNoClosingCouldBeJudged) {
  SceneFile file = gold_with_modes("auto");
  file.set("simulate.duration=20 us");
  const AutoModes found = choose_modes(file);
  EXPECT_FALSE(found.touches);
  EXPECT_THAT(found.note(), HasSubstr("the static voltages, the only figures that are judged"));
  EXPECT_THAT(found.note(), testing::Not(HasSubstr("t_i, v_i, the highest rebound")));
}

TEST(AutoModes, StandInThePreparedSceneAndItsWarnings) {
  const PreparedScene p = prepare_and_choose(gold_with_modes("auto"));
  const int modes = p.scene.device.structure.modes;
  EXPECT_EQ(p.model.modes(), modes);
  EXPECT_FALSE(p.scene.auto_modes);
  const std::string note = R"(structure.modes = "auto": )" + std::to_string(modes) +
                           " modes; further ones move t_i, v_i, the highest rebound of the first period after contact and the "
                           "pull-in, release and pull-through voltages by at most ";
  EXPECT_THAT(p.scene.warnings, Contains(HasSubstr(note)));
  EXPECT_THAT(p.scene.warnings, Contains(HasSubstr("B_H, N_B and t_p, are not judged and may move more")));
  EXPECT_THAT(p.resolved().text(), HasSubstr("modes = " + std::to_string(modes) + "\n"));
}

TEST(AutoModes, AreChosenBeforeTheEffects) {
  SceneFile file = gold_with_modes("auto");
  file.set("structure.damping_ratio=1e-9");
  file.set("simulate.effects=auto");
  const PreparedScene p = prepare_and_choose(file);
  EXPECT_EQ(p.scene.device.structure.modes, choose_modes(gold_with_modes("auto")).modes);
  ASSERT_TRUE(p.effects);
  ASSERT_EQ(p.effects->choice.left_out.size(), 1u);
  EXPECT_EQ(p.effects->choice.left_out[0].what.effect, "structure.damping_ratio");
  EXPECT_THAT(p.scene.warnings, Contains(HasSubstr("structure.modes = \"auto\"")));
}

TEST(AutoModes, OfASwitchThatDoesNotCloseSettleItsPullInVoltage) {
  SceneFile file = gold_with_modes("auto");
  file.set("waveform.main.level=3 V");
  const AutoModes found = choose_modes(file);
  EXPECT_EQ(found.modes, 3) << "one mode gives Vsp within 0.1 %, but not the voltage at which the beam is pulled through";
  EXPECT_LT(found.moved, 0.02);
}

TEST(AutoModes, BetweenTwoClampsLookBeyondTheAntisymmetricModes) {
  const AutoModes found =
      choose_modes(scene("hung-senturia.toml", {"structure.modes=auto", "gas.model=veijola", "simulate.accuracy=1e-4"}));
  EXPECT_TRUE(found.settled());
  EXPECT_EQ(found.modes % 2, 1) << "an antisymmetric mode adds nothing";
}

}  // namespace
}  // namespace softland
