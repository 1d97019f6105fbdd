// Oracles: the force of the uniform law from its share of touching summits, and the counts of the shipped scenes.
#include "studies/closing/summits_at_hold.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scenes.h"
#include "studies/closing/simulate.h"

namespace softland::summits_at_hold_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::optional<SummitsAtHold> summits_of(const SceneFile& file) {
  const PreparedScene p = prepare(file);
  const Hold hold = hold_of(p.model, p.signals());
  return hold.closed ? summits_at_hold(p.model, *hold.closed) : std::nullopt;
}

TEST(SummitsAtHold, AreThoseWhoseForceHoldsTheSwitch) {
  const PreparedScene p = prepare(gold());
  const auto closed = closed_equilibrium(p.model, hold_levels(p.signals()));
  ASSERT_TRUE(closed.has_value());
  const auto summits = summits_at_hold(p.model, *closed);
  ASSERT_TRUE(summits.has_value());
  EXPECT_NEAR(summits->all, 10, 1e-12);  // 1e11 1/m^2 on 20 x 5 um
  // Of N summits with heights uniform on Hm, N d / Hm touch. They carry 2/5 of the force of as many summits at the full depth
  // d.
  const double d = p.model.contact_deflection(closed->q.data()) - p.scene.device.gap.contact;
  const double force = summits->touching * (4.0 / 3) * 48e9 * std::sqrt(100e-9) * std::pow(d, 1.5) * 2 / 5;
  EXPECT_NEAR(closed->contact_force, force, 1e-6 * force);
  EXPECT_NEAR(summits->touching, 0.22, 0.005);
}

TEST(SummitsAtHold, GrowWithTheirDensityForEveryLawOfSummits) {
  SceneFile gaussian = gold({"contact.model=asperity-gaussian", "contact.asperity_deviation=30 nm"});
  gaussian.erase("contact.asperity_height");
  for (SceneFile file : {gold(), gaussian, gold({"contact.model=adhesive", "contact.adhesion_energy=1 mJ/m^2"}),
                         gold({"contact.model=elastic-plastic", "contact.hardness=1 GPa"})}) {
    const std::string law = *file.written("contact.model");
    const auto few = summits_of(file);
    file.set("contact.asperity_density=1e14 1/m^2");
    const auto many = summits_of(file);
    ASSERT_TRUE(few && many) << law;
    EXPECT_NEAR(few->all, 10, 1e-12) << law;
    EXPECT_NEAR(many->all, 1e4, 1e-8) << law;
    EXPECT_GT(many->touching, few->touching) << law;
    EXPECT_LT(many->touching / many->all, few->touching / few->all) << law << ": each carries less";
  }
}

TEST(SummitsAtHold, AreWarnedOfWhereAClosingTellsAContactForce) {
  for (const SceneFile& file : {gold(), gold_pzt()})
    EXPECT_THAT(simulate(prepare(file), false).warnings, Contains(HasSubstr("fewer than one"))) << file.name();
  const Closing many = simulate(prepare(gold({"contact.asperity_density=1e14 1/m^2"})), false);
  EXPECT_THAT(many.warnings, Not(Contains(HasSubstr("summits"))));
  EXPECT_FALSE(summits_of(spring_plate()).has_value());
  EXPECT_TRUE(is_few_summits_warning(few_summits_warning(prepare(gold()).model, prepare(gold()).signals())));
  EXPECT_FALSE(is_few_summits_warning(not_held));
}

}  // namespace
}  // namespace softland::summits_at_hold_test
