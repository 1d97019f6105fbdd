// Repeats the closing of a scene under every law.
#include "studies/closing/effects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "model/built_beam.h"
#include "model/gas/gas_law.h"
#include "scenes.h"
#include "studies/closing/simulate.h"

namespace softland {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> choices(const Effects& effects) {
  std::vector<std::string> names;
  for (const Effect& e : effects.list) names.push_back(e.choice);
  return names;
}

/// Returns "none" and every law that needs only the description of a film.
std::vector<std::string> compared_laws() {
  std::vector<std::string> names{"none"};
  for (const std::string_view law : names_of_laws<Gas>()) {
    if (law != "strip-slit" && law != "linear") names.emplace_back(law);
  }
  return names;
}

const Effect& find(const Effects& effects, const std::string& choice) {
  return *std::find_if(effects.list.begin(), effects.list.end(), [&](const Effect& e) { return e.choice == choice; });
}

TEST(Effects, CompareEveryGasLawWithTheScenesOwn) {
  const PreparedScene p = prepare(gold_at_17_volts());
  const Effects effects = compare_effects(p);
  EXPECT_EQ(choices(effects), compared_laws());
  const Effect& own = effects.own("gas");
  EXPECT_EQ(own.choice, "strip");
  const Metrics alone = simulate(p, false).metrics;
  EXPECT_EQ(own.metrics.initial_contact_time, alone.initial_contact_time) << "the very run of simulate";
  EXPECT_EQ(own.metrics.major_bounce_height, alone.major_bounce_height);
  for (const Effect& e : effects.list) {
    EXPECT_EQ(e.in_scene, &e == &own);
    EXPECT_GT(e.rhs_seconds, 0) << e.choice;
    EXPECT_GT(e.metrics.initial_contact_time, 0) << e.choice;
  }
  // Values at the closed gap of 1.5 um: mu (a/h)^3, and the Knudsen number from the mean free path for this viscosity.
  EXPECT_NEAR(own.magnitude.value, 1.86e-5 * std::pow(20 / 1.5, 3), 1e-12);
  EXPECT_NEAR(own.group.value, mean_free_path({.viscosity = 1.86e-5}) / 1.5e-6, 1e-12);
  EXPECT_EQ(find(effects, "none").magnitude.value, 0);
  // Less damping closes faster and harder.
  EXPECT_LT(find(effects, "none").metrics.initial_contact_time, own.metrics.initial_contact_time);
  EXPECT_GT(find(effects, "none").metrics.impact_velocity, own.metrics.impact_velocity);
  EXPECT_LT(find(effects, "veijola").metrics.initial_contact_time, own.metrics.initial_contact_time);
}

const Figure& impact_velocity = figure_of(&Metrics::impact_velocity);

TEST(Effects, SpreadIsOverTheGasLawsAndNotOverTheVacuum) {
  const Effects effects = compare_effects(prepare(gold_at_17_volts()));
  double least = 1, most = 0;
  for (const Effect& e : effects.list) {
    if (e.choice == "none") continue;
    least = std::min(least, e.metrics.impact_velocity);
    most = std::max(most, e.metrics.impact_velocity);
  }
  EXPECT_NEAR(effects.spread("gas", impact_velocity), (most - least) / effects.own("gas").metrics.impact_velocity, 1e-12);
  EXPECT_GT(effects.spread("gas", impact_velocity), 0.01);
}

TEST(Effects, OfASceneWithoutGasAreThoseOfAirAndOfALinearDamperItsOwn) {
  const Effects vacuum = compare_effects(prepare(without(gold_at_17_volts(), "gas")));
  EXPECT_EQ(vacuum.own("gas").choice, "none");
  EXPECT_NEAR(find(vacuum, "veijola").group.value, 67.00e-9 / 1.5e-6, 1e-5);

  const Effects damped = compare_effects(prepare(gold_at_17_volts({"gas={ model = \"linear\", quality_factor = 4 }"})));
  EXPECT_EQ(damped.own("gas").choice, "linear");
  EXPECT_TRUE(std::isnan(damped.own("gas").group.value));
}

// A law that needs keys which this scene lacks is named, and the other laws are compared.
TEST(Effects, OfEverySceneNameTheLawsThatItCannotHave) {
  const auto not_compared = [](const Effects& effects) {
    std::vector<std::string> names;
    for (const NotCompared& n : effects.not_compared) {
      names.push_back(n.choice);
      EXPECT_THAT(n.reason, Not(HasSubstr("nan")));
    }
    return names;
  };
  const Effects plate = compare_effects(prepare(scene("two-electrodes.toml")));
  EXPECT_THAT(not_compared(plate), ElementsAre("guo-alexeenko"));
  EXPECT_EQ(plate.not_compared[0].reason, "structure.thickness: must be given for this device");
  std::vector<std::string> left = compared_laws();
  std::erase(left, "guo-alexeenko");
  EXPECT_EQ(choices(plate), left);
  SceneFile hard = without(scene("two-electrodes.toml"), "contact");
  hard.set("contact={ model = \"rigid\", restitution = 0.5 }");
  const Effects rigid = compare_effects(prepare(hard));
  EXPECT_THAT(not_compared(rigid), ElementsAre("guo-alexeenko", "reynolds"));
}

// Each law is compared in a scene of its own, which the reader of scenes accepts with the same warnings.
TEST(Effects, GiveEveryLawWhatASceneMayGiveIt) {
  for (const std::string& name : shipped_scenes()) {
    const Device own = read_scene(scene(name.c_str())).device;
    const auto has_holes = [](const LocalSection& section) { return section.holes.exist(); };
    // Only one law describes a film under holes.
    if (own.structure.is_built() && std::ranges::any_of(local_sections(own.structure), has_holes)) continue;
    for (const std::string_view law : names_of_laws<Gas>()) {
      if (!own.gas || law == "strip-slit" || law == "linear") continue;
      const Gas bare = *law_named<Gas>(law);
      SceneFile file = scene(name.c_str());
      for (const std::string& key : file.keys("gas")) {
        if (key != "model" && !has_key(bare, key)) file.erase("gas." + key);
      }
      file.set("gas.model=" + std::string(law));
      const Device other = limits_of(bare).needs_thickness && std::isnan(own.structure.thickness) ? own : read_scene(file).device;
      const Gas compared = under(*own.gas, bare);
      EXPECT_EQ(std::isnan(film_length(compared)), std::isnan(film_length(*other.gas))) << name << " " << law;
      EXPECT_EQ(std::isnan(far_gap(compared)), std::isnan(far_gap(*other.gas))) << name << " " << law;
      const double gap = own.gap.electrode - own.gap.contact;
      EXPECT_EQ(damping_per_length(gas_law(compared, own.structure, 1), gap),
                damping_per_length(gas_law(*other.gas, other.structure, 1), gap))
          << name << " " << law;
    }
  }
}

// Open ends of the film, and a second film on the far side, are removed for the laws that do not have them.
TEST(Effects, OfFilmsWithOpenEndsDoNotWeakenLawsWithoutThem) {
  const PreparedScene p = prepare(scene("gap-closing-actuator.toml", {"simulate.accuracy=1e-3"}));
  const Effects effects = compare_effects(p);
  EXPECT_TRUE(effects.not_compared.empty()) << effects.not_compared.front().reason;
  const double kept = end_flow(40 / 76.1);
  Device ends_closed = p.scene.device;
  for (const char* law : {"veijola", "gallis-torczynski", "near-contact"}) {
    ends_closed.gas = under(*p.scene.device.gas, *law_named<Gas>(law));
    double* const length = number_of(*ends_closed.gas, "film_length");
    if (length != nullptr) *length = not_given;
    const double closed = damping_per_length(gas_law(*ends_closed.gas, ends_closed.structure, 1), 1e-6);
    EXPECT_NEAR(find(effects, law).magnitude.value, length != nullptr ? kept * closed : closed, 1e-9 * closed) << law;
  }
}

TEST(Effects, WithoutContactHaveNoSpreadOfWhatIsMissing) {
  const Effects effects = compare_effects(prepare(gold_at_17_volts({"waveform.main.level=3 V"})));
  EXPECT_TRUE(std::isnan(effects.spread("gas", impact_velocity)));
  EXPECT_EQ(effects.own("gas").metrics.status, Status::no_contact);
}

}  // namespace
}  // namespace softland
