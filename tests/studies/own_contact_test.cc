// A contact law of a user's program in the functions of the library on scenes.
#include "tests/support/own_contact.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scenes.h"
#include "studies/devices/derivatives.h"
#include "studies/devices/robustness.h"
#include "studies/search/optimize.h"

namespace softland {
namespace {

constexpr double same_formula = 1e-9;  // relative error after a spread, a search and hundreds of integrator steps

SceneFile own_gold() {
  SceneFile file = gold_at_17_volts();
  file.erase("contact");
  file.add_contact(test::own_contact());
  return file;
}

TEST(OwnContactOfAScene, IsJudgedOnDevicesLikeTheLawOfTheSameFormula) {
  const RobustnessOptions options{.samples = 6, .vectors = Vectors::none};
  const Robustness own = robustness(prepare(own_gold()), {}, options),
                   usual = robustness(prepare(gold_at_17_volts()), {}, options);
  for (std::size_t k = 0; k < own.devices; ++k) {
    const Metrics &a = own.drives[0].outcomes[k].metrics, &b = usual.drives[0].outcomes[k].metrics;
    EXPECT_NEAR(a.initial_contact_time, b.initial_contact_time, same_formula * b.initial_contact_time);
    EXPECT_NEAR(a.impact_velocity, b.impact_velocity, same_formula * b.impact_velocity);
    EXPECT_NEAR(a.major_bounce_height, b.major_bounce_height, same_formula * b.major_bounce_height);
  }
  EXPECT_EQ(own.devices, 6U);
}

TEST(OwnContactOfAScene, IsSearchedForLikeTheLawOfTheSameFormula) {
  const OptimizeOptions options{.max_evaluations = 40};
  const OptimizeResult own = optimize(own_gold(), options), usual = optimize(gold_at_17_volts(), options);
  ASSERT_TRUE(own.best && usual.best);
  EXPECT_NEAR(own.best->metrics.initial_contact_time, usual.best->metrics.initial_contact_time,
              same_formula * usual.best->metrics.initial_contact_time);
}

TEST(OwnContactOfAScene, IsRefusedByNameWhereAFileWouldHaveToSayIt) {
  const PreparedScene own = prepare(own_gold());
  for (const SceneFile& file : {own.scene.file, own.resolved()}) {
    try {
      (void)file.text();
      ADD_FAILURE() << "written";
    } catch (const InvalidInput& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("contact law 'own asperities'"));
    }
    EXPECT_THROW((void)file.json(), InvalidInput);
  }
  SceneFile both = gold_at_17_volts();
  both.add_contact(test::own_contact());
  EXPECT_THROW((void)prepare(both), InvalidInput);
}

TEST(OwnContactOfAScene, HasNoExactDerivatives) {
  const PreparedScene own = prepare(own_gold());
  const Derivatives none = derivatives(own, {.waveforms = own.waveforms()});
  EXPECT_THAT(none.why_none, testing::HasSubstr("contact law of one's own"));
}

}  // namespace
}  // namespace softland
