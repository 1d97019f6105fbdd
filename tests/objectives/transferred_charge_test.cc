// The charge that flows through a contact under a small force. Oracles: closed forms for a constant and for a rising force.
#include "objectives/transferred_charge.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softland::transferred_charge_test {
namespace {

constexpr double gap = 1e-6, voltage = 5, series = 50, light = 1e-5;
constexpr SwitchedLoad load{.voltage = voltage, .resistance = series};

// Returns a knot at rest with this depth in the contact.
TrajectoryPoint knot(double time, double depth, double force) {
  return {.time = time, .position = gap + depth, .velocity = 0, .acceleration = 0, .contact_force = force};
}

TEST(TransferredCharge, IsThatOfTheLoadWhileTheForceIsLight) {
  TransferredCharge charge({.load = load, .light_below = light}, gap);
  charge.follow(knot(0, 1e-9, 0.2 * light), knot(2e-6, 1e-9, 0.2 * light));
  EXPECT_NEAR(charge.charge(), voltage / series * 2e-6, 1e-20);
  charge.follow(knot(2e-6, 1e-9, 2 * light), knot(5e-6, 1e-9, 3 * light));
  EXPECT_NEAR(charge.charge(), voltage / series * 2e-6, 1e-20) << "a contact that is pressed together is made";
  charge.follow(knot(5e-6, -1e-9, 0), knot(7e-6, -1e-9, 0));
  EXPECT_NEAR(charge.charge(), voltage / series * 2e-6, 1e-20) << "nothing flows through a gap";
}

TEST(TransferredCharge, EndsWhereARisingForceIsSteadyAndBeginsWhereAFallingOneIsNot) {
  TransferredCharge rising({.load = load, .light_below = light}, gap), falling({.load = load, .light_below = light}, gap);
  rising.follow(knot(0, 1e-9, 0), knot(4e-6, 1e-9, 4 * light));
  falling.follow(knot(0, 1e-9, 4 * light), knot(4e-6, 1e-9, 0));
  EXPECT_NEAR(rising.charge(), voltage / series * 1e-6, 1e-20);
  EXPECT_NEAR(falling.charge(), voltage / series * 1e-6, 1e-20);
}

// One plastic spot of radius sqrt(F / (pi H)) between metals with a negligible mean free path: R = rho / (2 a).
TEST(TransferredCharge, CountsTheResistanceOfTheContact) {
  constexpr double hardness = 1e9, resistivity = 1e-5, force = 0.5 * light;
  Contact contact{.model = LinearSpring{.stiffness = 5e3}};
  contact.conduction = {.resistivity = resistivity, .hardness = hardness};
  TransferredCharge charge({.load = load, .light_below = light, .contact = ContactResistance(contact, 1e-5)}, gap);
  charge.follow(knot(0, 1e-9, force), knot(3e-6, 1e-9, force));
  const double radius = std::sqrt(force / (3.14159265358979323846 * hardness));
  const double expected = voltage / (series + resistivity / (2 * radius)) * 3e-6;
  EXPECT_GT(resistivity / (2 * radius), series) << "else the test would not see it";
  EXPECT_NEAR(charge.charge(), expected, 1e-9 * expected);
}

TEST(TransferredCharge, IsNotKnownWithoutASteadyForceOrALoad) {
  TransferredCharge no_hold({.load = load}, gap), no_load({}, gap);
  for (TransferredCharge* charge : {&no_hold, &no_load}) {
    charge->follow(knot(0, 1e-9, 0), knot(1e-6, 1e-9, 0));
    EXPECT_TRUE(std::isnan(charge->charge()));
  }
}

}  // namespace
}  // namespace softland::transferred_charge_test
