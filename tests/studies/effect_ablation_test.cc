// Tests the effects that a scene could do without, and effects = "auto".
#include "studies/closing/effect_ablation.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/simulate.h"

namespace softland {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::string_view weak_dispersion = R"(dispersion={ model = "van-der-waals", hamaker_constant = "4e-19 J" })";

std::vector<std::string> names(const std::vector<OmissibleEffect>& effects) {
  std::vector<std::string> list;
  for (const OmissibleEffect& e : effects) list.push_back(e.effect);
  return list;
}

std::vector<std::string> names(const std::vector<EffectAblation>& effects) {
  std::vector<std::string> list;
  for (const EffectAblation& e : effects) list.push_back(e.what.effect);
  return list;
}

Metrics own(const PreparedScene& p) { return simulate(p, false).metrics; }

TEST(OmissibleEffect, IsWhatTheSceneDescribes) {
  EXPECT_THAT(names(omissible_effects(prepare(gold()))), ElementsAre("structure.modes", "electrode.main.fringing", "gas"));
  EXPECT_THAT(names(omissible_effects(prepare(gold({"electrode.main.fringing=none", "structure.modes=1"})))), ElementsAre("gas"));
  EXPECT_THAT(names(omissible_effects(prepare(gold_at_17_volts(
                  {"structure.damping_ratio=0.01", "gas.far_gap=3 um", "gas.film_length=250 um", weak_dispersion})))),
              ElementsAre("structure.modes", "structure.damping_ratio", "electrode.main.fringing", "gas", "gas.far_gap",
                          "gas.film_length", "dispersion"));
  EXPECT_THAT(names(omissible_effects(prepare(scene("two-electrodes.toml")))),
              ElementsAre("structure.damping_ratio", "contact.damping"));
  EXPECT_THAT(names(omissible_effects(prepare(gold({"contact.distribution=pad"})))), testing::Contains("contact.distribution"));
  const PreparedScene charged =
      prepare(gold({R"(electrode.main.dielectric={thickness="0.2 um",permittivity=7.6,charge="1 mC/m^2"})"}));
  const std::vector<OmissibleEffect> all = omissible_effects(charged);
  EXPECT_THAT(names(all), testing::IsSupersetOf({"electrode.main.dielectric.charge", "electrode.main.dielectric"}));
  for (const OmissibleEffect& effect : all) {
    if (effect.effect != "electrode.main.dielectric.charge") continue;
    EXPECT_EQ(effect.choice, "1 mC/m^2");
    EXPECT_DOUBLE_EQ(effect.magnitude.value, charged.model.neutral_voltage(0));
    EXPECT_FALSE(copy_without(charged, {effect}).scene.device.is_charged());
  }
  EXPECT_THAT(names(omissible_effects(prepare(gold({"surface.elastic_modulus=5 N/m"})))), testing::Contains("surface"));
  EXPECT_THAT(names(omissible_effects(prepare(scene("nem-casimir.toml")))), testing::Not(testing::Contains("dispersion")))
      << "what a waveform drives is no effect to leave out";
}

TEST(OmissibleEffect, KnowsItsSize) {
  const std::vector<OmissibleEffect> all = omissible_effects(prepare(gold()));
  EXPECT_EQ(all[0].choice, "4");
  EXPECT_EQ(all[1].choice, "meijs-fokkema") << "the default, too";
  EXPECT_EQ(all[2].choice, "strip");
  EXPECT_EQ(omissible_effects(prepare(gold({"gas.far_gap=3 um"}))).back().choice, "3 um");
  EXPECT_EQ(all[0].instead, SceneValue(1));
  EXPECT_FALSE(all[0].automatic);
  // van der Meijs & Fokkema at h = 3.5 um, a = 20 um, b = 2 um.
  EXPECT_NEAR(all[1].magnitude.value, 0.265 * std::pow(3.5 / 20, 0.75) + 0.53 * 3.5 / 20 * std::sqrt(2 / 3.5), 1e-9);
  EXPECT_NEAR(all[1].group.value, 0.175, 1e-12);
  EXPECT_NEAR(all[2].magnitude.value, 1.86e-5 * std::pow(20 / 1.5, 3), 1e-12);
}

TEST(OmissibleEffect, ContactAlongThePadGoesBackToItsCentreWhenTold) {
  const PreparedScene p = prepare(gold_at_17_volts({"contact.distribution=pad"}));
  const OmissibleEffect along = omissible_effects(p).back();
  ASSERT_EQ(along.effect, "contact.distribution");
  EXPECT_EQ(along.choice, "pad");
  EXPECT_FALSE(along.automatic);
  // The free end is deeper than the inner end by the tilt 1.5 dt / L over 5 um.
  EXPECT_NEAR(along.magnitude.value, 60e-9, 1e-12);
  EXPECT_EQ(own(copy_without(p, {along})).initial_contact_time, own(prepare(gold_at_17_volts())).initial_contact_time);
}

TEST(Without, IsTheSceneWithoutTheSectionUnderTheSameVolts) {
  const PreparedScene p = prepare(gold_at_17_volts());
  const std::vector<OmissibleEffect> all = omissible_effects(p);
  const PreparedScene vacuum = copy_without(p, {all[2]});
  EXPECT_FALSE(vacuum.scene.device.gas);
  EXPECT_EQ(own(vacuum).initial_contact_time, own(prepare(without(gold_at_17_volts(), "gas"))).initial_contact_time);
  const PreparedScene bare = copy_without(p, all);
  EXPECT_EQ(bare.scene.device.electrodes[0].fringing, Fringing::none);
  EXPECT_EQ(bare.model.modes(), 1);
  EXPECT_EQ(bare.signals()[0].hold_level(), 17.771);
  // A level in Vdp keeps the voltage of the scene with all effects.
  const PreparedScene relative = prepare(gold());
  EXPECT_EQ(copy_without(relative, {omissible_effects(relative)[1]}).signals()[0].hold_level(),
            relative.signals()[0].hold_level());
}

constexpr std::string_view parts =
    "structure.sections=[{length=\"60 um\", width=\"15 um\"}, {length=\"190 um\", holes={pitch=\"10 um\", size=\"4 um\"}}]";
constexpr std::string_view two_layers =
    "structure.layers=[{face=\"far\", span=[\"0 um\", \"60 um\"], thickness=\"0.1 um\", youngs_modulus=\"250 GPa\", "
    "density=\"3100 kg/m^3\"}, {face=\"near\", span=[\"0 um\", \"60 um\"], thickness=\"0.1 um\", youngs_modulus=\"250 GPa\", "
    "density=\"3100 kg/m^3\", stress=\"2 MPa\"}]";
constexpr std::string_view turning = "structure.anchor={rotation=\"1e-6 N m/rad\"}";

TEST(OmissibleEffect, MayBeAPartOfABeam) {
  const SceneFile file = gold_at_17_volts({parts, two_layers, turning, "structure.stress_gradient=0.1 MPa/um"});
  const std::vector<OmissibleEffect> all = omissible_effects(prepare(file));
  EXPECT_THAT(names(all),
              ElementsAre("structure.modes", "structure.anchor", "structure.sections[2].holes", "structure.layers[2].stress",
                          "structure.stress_gradient", "electrode.main.fringing", "gas"));
  EXPECT_EQ(all[1].magnitude.value, 1e-6);
  EXPECT_LT(all[1].group.value, 0) << "it lowers the frequency";
  EXPECT_NEAR(all[2].group.value, 1 - 0.16, 1e-12);
  EXPECT_EQ(all[3].choice, "2 MPa");
  EXPECT_LT(all[3].magnitude.value, 0) << "tension on the near face pulls the beam down";
  EXPECT_GT(all[4].magnitude.value, 0);
  const char* const table = "structure.rest_shape={positions=[\"0 um\", \"tip\"], heights=[\"0 nm\", \"100 nm\"]}";
  const std::vector<OmissibleEffect> by_table = omissible_effects(prepare(gold_at_17_volts({table})));
  ASSERT_EQ(by_table[1].effect, "structure.rest_shape");
  EXPECT_NEAR(by_table[1].magnitude.value, 99e-9, 1e-15);
  EXPECT_NEAR(by_table[1].group.value, 99.0 / 2000, 1e-9);
  EXPECT_THAT(
      names(omissible_effects(prepare(gold_at_17_volts({"structure.anchor=clamped", "structure.stress_gradient=0 Pa/m"})))),
      ElementsAre("structure.modes", "electrode.main.fringing", "gas"));
}

TEST(Without, APartIsTheSceneThatDoesNotHaveIt) {
  const auto t_i = [](const PreparedScene& p) { return own(p).initial_contact_time; };
  const auto leave_out = [](const PreparedScene& p, const std::string& effect) {
    for (const OmissibleEffect& one : omissible_effects(p)) {
      if (one.effect == effect) return copy_without(p, {one});
    }
    throw std::logic_error(effect);
  };
  const PreparedScene plain = prepare(gold_at_17_volts());
  const PreparedScene bowed =
      prepare(gold_at_17_volts({"structure.rest_shape={positions=[\"0 um\", \"tip\"], heights=[\"0 nm\", \"100 nm\"]}"}));
  EXPECT_GT(t_i(bowed), 1.01 * t_i(plain));
  EXPECT_EQ(t_i(leave_out(bowed, "structure.rest_shape")), t_i(plain));
  const PreparedScene turns = prepare(gold_at_17_volts({turning}));
  EXPECT_GT(t_i(plain), 1.001 * t_i(turns));
  // An explicit clamp is handled by other code than an absent anchor.
  EXPECT_NEAR(t_i(leave_out(turns, "structure.anchor")) / t_i(plain), 1, 1e-6);
  const PreparedScene whole = prepare(gold_at_17_volts({parts, two_layers}));
  const PreparedScene relaxed = leave_out(whole, "structure.layers[2].stress"),
                      solid = leave_out(whole, "structure.sections[2].holes");
  EXPECT_EQ(part_of<Beam>(relaxed.scene.device.structure).layers[1].stress, 0);
  EXPECT_NE(t_i(relaxed), t_i(whole));
  EXPECT_FALSE(part_of<Beam>(solid.scene.device.structure).sections[1].holes.exist());
  EXPECT_EQ(part_of<Beam>(solid.scene.device.structure).sections.size(), 2u);
  EXPECT_NE(t_i(solid), t_i(whole));
}

TEST(OmissibleEffect, MayBeABackStopAndTheDampingOfEveryContact) {
  const PreparedScene p = prepare(scene("new/two-contacts.toml"));
  const std::vector<OmissibleEffect> all = omissible_effects(p);
  EXPECT_THAT(names(all), ElementsAre("structure.modes", "electrode.main.fringing", "gas", "contact.left.damping",
                                      "contact.right.damping", "contact.stop", "contact.stop.damping"));
  EXPECT_EQ(all[3].choice, "0.5 s/m");
  const OmissibleEffect& stop = all[5];
  EXPECT_EQ(stop.choice, "linear");
  EXPECT_DOUBLE_EQ(stop.magnitude.value, 1e-6);
  EXPECT_DOUBLE_EQ(stop.group.value, 1);
  const PreparedScene open = copy_without(p, {stop});
  ASSERT_EQ(open.scene.device.contacts.size(), 2u);
  EXPECT_EQ(open.scene.device.contacts[0].side, Side::near);
  EXPECT_EQ(open.scene.device.contacts[1].side, Side::near);
  // Of a dimple and a stop the dimple is left. It is then the connection, whatever [metrics] closed says.
  const PreparedScene one =
      prepare(without(without(scene("new/two-contacts.toml", {"metrics.closed=any"}), "spread"), "contact.right"));
  const std::vector<OmissibleEffect> of_one = omissible_effects(one);
  const auto back = std::ranges::find(of_one, "contact.stop", &OmissibleEffect::effect);
  ASSERT_NE(back, of_one.end());
  EXPECT_EQ(copy_without(one, {*back}).scene.device.contacts.size(), 1u);
}

TEST(OmissibleEffect, MayBeTheRoughnessOfADielectric) {
  constexpr std::string_view nitride = "electrode.main.dielectric={thickness=\"0.2 um\", permittivity=8, roughness=\"25 nm\"}";
  const PreparedScene p = prepare(gold_at_17_volts({nitride}));
  const std::vector<OmissibleEffect> all = omissible_effects(p);
  EXPECT_THAT(names(all), ElementsAre("structure.modes", "electrode.main.fringing", "electrode.main.dielectric.roughness",
                                      "electrode.main.dielectric", "gas"));
  EXPECT_EQ(all[2].choice, "25 nm");
  EXPECT_NEAR(all[2].group.value, 0.5, 1e-12) << "25 nm of the 50 nm that the dielectric adds to the gap";
  const PreparedScene smooth = copy_without(p, {all[2]});
  ASSERT_TRUE(smooth.scene.device.electrodes[0].dielectric);
  EXPECT_EQ(smooth.scene.device.electrodes[0].dielectric->roughness, 0);
  EXPECT_LT(own(smooth).initial_contact_time, own(p).initial_contact_time) << "the field is stronger";
  // The face on which the beam lands is not left out.
  const PreparedScene lands = prepare(scene("new/capacitive-bridge.toml", {"electrode.main.dielectric.roughness=10 nm"}));
  EXPECT_THAT(names(omissible_effects(lands)), testing::Contains("electrode.main.dielectric.roughness"));
  EXPECT_THAT(names(omissible_effects(lands)), testing::Not(testing::Contains("electrode.main.dielectric")));
}

TEST(OmissibleEffect, MayBeTheStretchingOfATableOfModes) {
  std::string positions, shape;
  for (int k = 0; k <= 20; ++k) {
    const double u = k / 20.0;
    positions += fmt::format("{}\"{:.12g} um\"", k == 0 ? "" : ",", 250 * u);
    shape += fmt::format("{}{:.12g}", k == 0 ? "" : ",", 2e6 * 16 * u * u * (1 - u) * (1 - u));
  }
  const std::string table = fmt::format(
      "structure={{kind=\"modes\",positions=[{}],frequencies=[\"60 kHz\"],shapes=[[{}]],width=\"20 um\",thickness=\"2 um\","
      "far_anchor=\"clamped\",axial_stiffness=\"12 kN/m\"}}",
      positions, shape);
  SceneFile file = without(gold_at_17_volts(), "spread");
  file.set(table);
  const PreparedScene p = prepare(file);
  const std::vector<OmissibleEffect> all = omissible_effects(p);
  ASSERT_THAT(names(all), testing::Contains("structure.axial_stiffness"));
  const OmissibleEffect& stretching = *std::ranges::find(all, "structure.axial_stiffness", &OmissibleEffect::effect);
  EXPECT_EQ(stretching.choice, "12 kN/m");
  EXPECT_NEAR(stretching.group.value, 1, 1e-12) << "a gap of 2 um over a thickness of 2 um";
  EXPECT_TRUE(p.model.stretching());
  EXPECT_FALSE(copy_without(p, {stretching}).model.stretching());
}

// The spread of a stress cannot stay when the stress is set to 0.
TEST(Without, ANumberThatVariesTakesItsSpreadAlong) {
  SceneFile file = without(scene("new/clamped-clamped.toml"), "spread");
  file.set(R"(spread."structure.residual_stress"={distribution="normal",cov="5 %"})");
  const PreparedScene varied = prepare(file);
  const std::vector<OmissibleEffect> all = omissible_effects(varied);
  const auto stress = std::ranges::find(all, "structure.residual_stress", &OmissibleEffect::effect);
  ASSERT_NE(stress, all.end());
  const PreparedScene relaxed = copy_without(varied, {*stress});
  EXPECT_EQ(part_of<Bridge>(relaxed.scene.device.structure).residual_stress, 0);
}

TEST(BoundedClosing, EndsWhereItCostsTooMuch) {
  const PreparedScene p = prepare(gold_at_17_volts());
  const BoundedClosing whole = bounded_closing(p, p.model, {}, {}, "");
  EXPECT_FALSE(whole.end);
  EXPECT_EQ(whole.metrics.major_bounce_height, own(p).major_bounce_height) << "that of simulate";
  ASSERT_GT(whole.steps, 100);
  const BoundedClosing same = bounded_closing(p, p.model, {.steps = whole.steps + 1}, {}, "");
  EXPECT_FALSE(same.end);
  EXPECT_EQ(same.metrics.major_bounce_height, whole.metrics.major_bounce_height);
  const BoundedClosing early = bounded_closing(p, p.model, {.steps = 10}, {}, "");
  EXPECT_EQ(early.steps, 10);
  ASSERT_TRUE(early.end);
  EXPECT_LT(*early.end, whole.metrics.initial_contact_time);
  EXPECT_EQ(early.metrics.status, Status::no_contact);
  const BoundedClosing late = bounded_closing(p, p.model, {.seconds = 0}, {}, "");
  EXPECT_LT(late.steps, 100) << "the clock is looked at now and then";
  EXPECT_TRUE(late.end);
  EXPECT_EQ(ClosingBound::after({.steps = 100, .seconds = 0.01}).steps, ClosingBound::fewest_steps);
  EXPECT_EQ(ClosingBound::after({.steps = 50'000, .seconds = 0.5}).steps, 500'000);
  EXPECT_EQ(ClosingBound::after({.steps = 100, .seconds = 0.01}).seconds, ClosingBound::least_seconds);
  EXPECT_EQ(ClosingBound::after({.steps = 100, .seconds = 0.5}).seconds, 50);
}

TEST(Influence, IsTheLargestRelativeChange) {
  Metrics a;
  a.initial_contact_time = 10e-6;
  a.impact_velocity = 0.1;
  a.major_bounce_height = 100e-9;
  Metrics b = a;
  EXPECT_EQ(influence(a, b, {}), 0);
  b.impact_velocity = 0.103;
  EXPECT_NEAR(influence(a, b, {}), 0.03, 1e-12);
  b.major_bounce_height = 90e-9;
  EXPECT_NEAR(influence(a, b, {}), 0.1, 1e-12);
  a.major_bounce_height = 0;
  b.major_bounce_height = 0.5e-9;
  EXPECT_NEAR(influence(a, b, {.significant_rebound = 1e-9}), 0.03, 1e-12) << "neither rebound counts";
  b.initial_contact_time = Metrics::unset;
  EXPECT_TRUE(std::isinf(influence(a, b, {})));
}

TEST(AutomaticEffects, LeaveOutWhatChangesNothing) {
  const SceneFile file = gold_at_17_volts({"structure.damping_ratio=1e-9", weak_dispersion, "simulate.effects=auto"});
  const PreparedScene p = prepare_and_choose(file);
  ASSERT_TRUE(p.effects);
  EXPECT_THAT(names(p.effects->choice.left_out), testing::UnorderedElementsAre("structure.damping_ratio", "dispersion"));
  EXPECT_LE(p.effects->choice.influence, 1e-3);
  EXPECT_FALSE(p.scene.device.dispersion);
  EXPECT_TRUE(p.scene.device.gas) << "the film matters here";
  EXPECT_TRUE(p.effects->described.device.dispersion);
  EXPECT_THAT(p.scene.warnings.back(), HasSubstr("effects = \"auto\" leaves out "));
  EXPECT_THAT(p.scene.warnings.back(), HasSubstr("dispersion ("));
  EXPECT_EQ(own(p).initial_contact_time, own(prepare(gold_at_17_volts())).initial_contact_time);
  // The written scene gives the same figures without another choice.
  const PreparedScene again = prepare(p.resolved());
  EXPECT_FALSE(again.effects);
  EXPECT_EQ(own(again).major_bounce_height, own(p).major_bounce_height);
}

TEST(AutomaticEffects, KeepWhatMattersByTheTolerance) {
  EXPECT_THAT(prepare_and_choose(gold_at_17_volts({"simulate.effects=auto"})).effects->choice.left_out, IsEmpty());
  const PreparedScene loose = prepare_and_choose(gold_at_17_volts({"simulate.effects=auto", "simulate.effects_tolerance=0.099"}));
  EXPECT_THAT(names(loose.effects->choice.left_out), IsEmpty()) << "B_H changes by a third without the film";
  EXPECT_THAT(loose.scene.warnings.back(), HasSubstr("nothing is left out"));
}

TEST(AutomaticEffects, CountTogether) {
  const SceneFile file = gold_at_17_volts({"structure.damping_ratio=1e-4", "gas={ model = \"linear\", quality_factor = 5000 }"});
  const PreparedScene p = prepare(file);
  std::vector<double> alone;
  for (const EffectAblation& o : ablate_effects(p, bounded_closing(p, p.model, {}, {}, ""), false)) {
    if (o.what.effect == "gas" || o.what.effect == "structure.damping_ratio") alone.push_back(o.influence);
  }
  ASSERT_EQ(alone.size(), 2u);
  const double most = *std::max_element(alone.begin(), alone.end());
  ASSERT_LT(most, 0.01);
  EXPECT_EQ(negligible_effects(p, 1.05 * most).left_out.size(), 1u) << alone[0] << " " << alone[1];
  EXPECT_EQ(negligible_effects(p, 1.2 * (alone[0] + alone[1])).left_out.size(), 2u);
}

TEST(AutomaticEffects, LeaveNothingOutWhereNothingTouches) {
  const PreparedScene p =
      prepare_and_choose(gold_at_17_volts({"waveform.main.level=3 V", weak_dispersion, "simulate.effects=auto"}));
  EXPECT_THAT(p.effects->choice.left_out, IsEmpty());
}

}  // namespace
}  // namespace softland
