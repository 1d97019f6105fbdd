// A contact law of a user's program, compared with softland's law of the same formula.
#include "tests/support/own_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/contact/contact_law.h"
#include "model/ensemble/ensemble_closings.h"
#include "model/linearized_closing.h"
#include "model/pull_in.h"
#include "tests/model/gold.h"

namespace softland {
namespace {

using namespace literals;

constexpr double same_formula = 1e-12;
constexpr double looked_for = 1e-11;  // error of the search for the largest damped force, which is before the deepest point

UniformAsperities asperities(double damping) {
  UniformAsperities law = UniformAsperities::example();
  law.damping = damping;
  return law;
}
Switch gold_under(const Contact& contact) {
  Device device = test::gold_cantilever();
  device.contacts = {contact};
  return Switch(device);
}

void expect_near(double a, double b) { EXPECT_NEAR(a, b, same_formula * std::abs(b)); }

TEST(OwnContactLaw, ClosesLikeTheLawOfTheSameFormula) {
  for (const double damping : {0.0, 0.5}) {
    SCOPED_TRACE(damping);
    const Switch own = gold_under(test::own_contact(asperities(damping))),
                 usual = gold_under(test::gold_contact(asperities(damping)));
    const auto run = [](const Switch& model) {
      return simulate_closing(model, std::vector{Signal::constant(test::step_level)}, {.duration = 60_us, .tolerance = 1e-8});
    };
    const Trajectory a = run(own), b = run(usual);
    ASSERT_EQ(a.status, Status::done) << a.message;
    ASSERT_EQ(a.touches.size(), b.touches.size());
    ASSERT_GE(a.touches.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      expect_near(a.touches[k].begin, b.touches[k].begin);
      expect_near(a.touches[k].impact_velocity, b.touches[k].impact_velocity);
      EXPECT_NEAR(a.touches[k].peak_force, b.touches[k].peak_force,
                  (damping > 0 ? looked_for : same_formula) * b.touches[k].peak_force);
      expect_near(a.touches[k].peak_energy, b.touches[k].peak_energy);
    }
    expect_near(a.deepest_penetration, b.deepest_penetration);
    EXPECT_LT(std::abs(a.energy.residual()), 1e-6 * a.energy.source_work);
    EXPECT_EQ(own.has_damped_contact(), damping > 0);
  }
}

TEST(OwnContactLaw, IsHeldWhereTheLawOfTheSameFormulaIs) {
  const Switch own = gold_under(test::own_contact()), usual = gold_under(test::gold_contact(UniformAsperities::example()));
  const std::vector<double> volts{test::step_level};
  const auto a = closed_equilibrium(own, volts), b = closed_equilibrium(usual, volts);
  ASSERT_TRUE(a && b);
  expect_near(a->contact_force, b->contact_force);
  expect_near(release_voltage(own, 0), release_voltage(usual, 0));
}

TEST(OwnContactLaw, StoresTheIntegralOfItsForce) {
  const UniformAsperities law = UniformAsperities::example();
  const auto built_in = contact_law(test::gold_contact(law), 20_um), own = contact_law(test::own_contact(law), 20_um);
  for (const double d : {-20_nm, 1_nm, 40_nm, 99_nm})
    EXPECT_NEAR(contact_energy(own, d), contact_energy(built_in, d), 1e-12 * contact_energy(built_in, d));
  EXPECT_EQ(contact_energy(own, 0), 0);
}

TEST(OwnContactLaw, HasTangentsByDifferences) {
  constexpr double differences = 1e-9;
  const UniformAsperities damped = asperities(0.5);
  const auto built_in = contact_law(test::gold_contact(damped), 20_um), own = contact_law(test::own_contact(damped), 20_um);
  const auto slope = [](const ContactLaw& law, Dual d, Dual rate) {
    return std::visit([&](const auto& l) { return force_of(l, d, true, [&] { return rate; }).slope; }, law);
  };
  for (const double d : {0.1_nm, 3_nm, 40_nm, 150_nm}) {
    for (const double rate : {-0.05, 0.0, 0.2}) {
      for (const auto& [by_depth, by_rate] : {std::pair{1.0, 0.0}, std::pair{0.0, 1.0}}) {
        const double exact = slope(built_in, Dual(d, by_depth), Dual(rate, by_rate));
        EXPECT_NEAR(slope(own, Dual(d, by_depth), Dual(rate, by_rate)), exact, differences * std::abs(exact)) << d << " " << rate;
      }
    }
  }
}

TEST(OwnContactLaw, IsRefusedWhereItsLawWouldHaveToBeKnown) {
  const Switch own = gold_under(test::own_contact());
  EXPECT_NE(LinearizedClosing::refusal(own).find("by differences"), std::string::npos);
  EXPECT_FALSE(why_not_in_lanes(own).empty());
  Device device = test::gold_cantilever();
  device.contacts.front().model = OwnContact{};
  EXPECT_THROW(validate(device), InvalidInput);
  device.contacts = {test::own_contact()};
  device.contacts.front().distribution = ContactDistribution::pad;
  EXPECT_THROW(validate(device), InvalidInput);
}

/// A contact that attracts within the first nanometre.
struct Glue final : OwnContactLaw {
  [[nodiscard]] std::string_view name() const override { return "glue"; }
  [[nodiscard]] double force(double d, double) const override { return 1e4 * (d - 1e-9 * std::tanh(d / 0.1e-9)); }
  [[nodiscard]] bool pulls() const override { return true; }
};

TEST(OwnContactLaw, MayStickWhereItPulls) {
  EXPECT_TRUE(may_stick(OwnContact{std::make_shared<const Glue>()}));
  EXPECT_FALSE(may_stick(test::own_contact().model));
}

}  // namespace
}  // namespace softland
