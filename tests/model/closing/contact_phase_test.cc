#include "model/closing/contact_phase.h"

#include <gtest/gtest.h>

#include <vector>

#include "model/contact/contact_law.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

Switch gold_with(const ContactModel& model) {
  Device device = test::gold_cantilever();
  device.contacts.front().model = model;
  return Switch(device);
}

constexpr double plane = 2_um;

void expect_edge(const Edge& edge, double level, double side, Phase next) {
  EXPECT_DOUBLE_EQ(edge.level, level);
  EXPECT_EQ(edge.side, side);
  EXPECT_EQ(edge.next, next);
}

TEST(ContactPhase, WithoutMemoryIsFlightOrLoading) {
  const Switch model = gold_with(LinearSpring::example());
  ContactPhase phase(model);
  EXPECT_FALSE(phase.in_contact());
  EXPECT_FALSE(phase.law().active);
  ASSERT_EQ(phase.edges().size(), 1u);
  expect_edge(phase.edges()[0], plane, -1, Phase::loading);
  phase.enter(Phase::loading);
  EXPECT_TRUE(phase.in_contact());
  EXPECT_TRUE(phase.law().active);
  EXPECT_FALSE(phase.ends_at_turn());
  ASSERT_EQ(phase.edges().size(), 1u);
  expect_edge(phase.edges()[0], plane, 1, Phase::flight);
  EXPECT_EQ(phase.lost(plane + 10_nm), 0);
  EXPECT_TRUE(phase.law_at(plane + 1_nm).active);
  EXPECT_FALSE(phase.law_at(plane - 1_nm).active);
}

TEST(ContactPhase, ThatRemembersTurnsUnloadsAndHeals) {
  const Switch model = gold_with(HystereticSpring{.stiffness = 1e4_N_m, .unloading_stiffness = 4e4_N_m});
  ContactPhase phase(model);
  phase.enter(Phase::loading);
  EXPECT_TRUE(phase.ends_at_turn());
  constexpr double deepest = 20_nm;
  // Loading takes k_l d^2 / 2, of which k_l / k_u is returned; the unloading line starts at s = d (1 - k_l / k_u).
  constexpr double lost = 1e4 * deepest * deepest / 2 * (1 - 0.25), shift = 0.75 * deepest;
  EXPECT_NEAR(phase.lost(plane + deepest), lost, 1e-6 * lost);
  phase.turn(deepest);
  EXPECT_EQ(phase.phase(), Phase::unloading);
  EXPECT_TRUE(phase.law().unloading);
  EXPECT_NEAR(phase.law().shift, shift, 1e-9 * shift);
  EXPECT_NEAR(phase.lost(plane + 17_nm), lost, 1e-6 * lost);
  ASSERT_EQ(phase.edges().size(), 2u);
  expect_edge(phase.edges()[0], plane + phase.law().shift, 1, Phase::dent);
  expect_edge(phase.edges()[1], plane + deepest, -1, Phase::loading);
  phase.enter(Phase::dent);
  EXPECT_TRUE(phase.in_contact()) << "below the plane, though nothing is carried";
  EXPECT_FALSE(phase.law().active);
  phase.enter(Phase::flight);
  expect_edge(phase.edges()[0], plane, -1, Phase::loading);  // the dent has healed
  EXPECT_NEAR(phase.lost(0), lost, 1e-6 * lost);
  phase.enter(Phase::loading);
  phase.turn(deepest);
  EXPECT_NEAR(phase.lost(plane + deepest), 2 * lost, 1e-6 * lost) << "every touch loses the same";
}

TEST(ContactPhase, KeepsTheDentOfAPlasticContact) {
  const Switch model = gold_with(PlasticAsperities::example());
  ContactPhase phase(model);
  phase.enter(Phase::loading);
  phase.turn(40_nm);
  const double lost = phase.lost(plane);
  EXPECT_GT(lost, 0);
  phase.enter(Phase::dent);
  phase.enter(Phase::flight);
  expect_edge(phase.edges()[0], plane, -1, Phase::dent);
  EXPECT_EQ(phase.lost(0), lost);
}

TEST(ContactPhase, GoesThroughTheReachAndTheKinksOfALaw) {
  const Switch model = gold_with(AdhesiveRepulsiveSurfaces());
  const std::vector<double> kinks = contact_kinks(model.contact());
  ASSERT_FALSE(kinks.empty());
  ContactPhase phase(model);
  expect_edge(phase.edges()[0], plane - model.contact_reach(), -1, Phase::near);
  phase.enter(Phase::near);
  EXPECT_FALSE(phase.in_contact());
  EXPECT_TRUE(phase.law().active);
  EXPECT_EQ(phase.above(), Phase::near);
  expect_edge(phase.edges()[1], plane, -1, Phase::loading);
  for (std::size_t zone = 0; zone <= kinks.size(); ++zone) {
    phase.enter(Phase::loading, zone);
    const auto edges = phase.edges();
    ASSERT_EQ(edges.size(), zone < kinks.size() ? 2u : 1u);
    expect_edge(edges[0], zone == 0 ? plane : plane + kinks[zone - 1], 1, zone == 0 ? Phase::near : Phase::loading);
    if (zone > 0) {
      EXPECT_EQ(edges[0].zone, zone - 1);
    }
    if (zone == kinks.size()) break;
    expect_edge(edges[1], plane + kinks[zone], -1, Phase::loading);
    EXPECT_EQ(edges[1].zone, zone + 1);
  }
}

TEST(ContactPhase, OfAPadActsAlways) {
  Device device = test::gold_cantilever();
  device.contacts = {test::pad_contacts().front()};
  const Switch model(device);
  ContactPhase phase(model);
  for (const Phase one : {Phase::flight, Phase::loading}) {
    phase.enter(one);
    EXPECT_TRUE(phase.law().active);
  }
  EXPECT_TRUE(phase.law_at(0).active);
}

TEST(ContactPhase, AtRestHasNoEdge) {
  const Switch model = gold_with(LinearSpring::example());
  ContactPhase phase(model);
  phase.enter(Phase::rest);
  EXPECT_TRUE(phase.in_contact());
  EXPECT_TRUE(phase.edges().empty());
}

}  // namespace
}  // namespace softland
