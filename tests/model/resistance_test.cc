// Contact resistance, against values of an independent program (one spot, gold on gold), limits and identities.
#include "model/contact/resistance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/literals.h"
#include "model/contact/contact_law.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

constexpr Conduction gold_pair{.resistivity = 2.2e-8, .hardness = 1e9, .mean_free_path = 38e-9};
constexpr double kept_to = 1e-6;  // error as a share of the values of the independent program
constexpr double to_rounding = 1e-12;
constexpr double any_depth = 1e-9;  // [m]

Contact gold_spring(double count = 1) {
  return {.model = LinearSpring{.stiffness = 1e4}, .pad_length = 5_um, .count = count, .conduction = gold_pair};
}

ContactResistance resistance_law(const Contact& contact) { return {contact, 20_um}; }

void expect_ohm(double value, double right, double relative, const char* what = "") {
  EXPECT_NEAR(value, right, relative * std::abs(right)) << what;
}

TEST(ContactResistance, OfOnePlasticSpotAgreesWithAnIndependentProgram) {
  struct Row {
    double force, holm, sharvin, both;
  };
  for (const Row& row : {Row{1e-5, 0.19496992359960674, 0.11146666666666667, 0.2718024782164422},
                         Row{2e-5, 0.13786455510470502, 0.055733333333333336, 0.17349923442363227},
                         Row{5e-5, 0.08719320054733222, 0.022293333333333325, 0.10011074189778818},
                         Row{1e-4, 0.06165490338037721, 0.011146666666666668, 0.0676850344492638}}) {
    Contact contact = gold_spring();
    expect_ohm(resistance_law(contact).resistance(any_depth, row.force), row.both, kept_to, "Sharvin and Holm");
    contact.conduction.mean_free_path = 0;
    expect_ohm(resistance_law(contact).resistance(any_depth, row.force), row.holm, kept_to, "Holm");
    // For ballistic electrons G falls to 0.83 / 1.33, and Holm's part vanishes.
    const double radius = std::sqrt(row.force / (std::numbers::pi * gold_pair.hardness));
    constexpr double long_path = 1e-2;  // [m]
    expect_ohm(ContactResistance::of_spot(radius, gold_pair.resistivity, long_path) * gold_pair.mean_free_path / long_path,
               row.sharvin, 1e-4, "Sharvin");
  }
}

TEST(ContactResistance, OfAnElasticSpotAgreesWithAnIndependentProgram) {
  struct Row {
    double force, holm, sharvin;
  };
  for (const Row& row :
       {Row{1e-5, 0.4399999999999995, 0.56769507167925}, Row{2e-5, 0.3492282314330035, 0.35762548536513306},
        Row{5e-5, 0.257313560962732, 0.19414898352368426}, Row{1e-4, 0.20422990867896207, 0.12230619557859135}}) {
    // A single summit without hardness: the spot is elastic.
    Contact contact = test::gold_contact(UniformAsperities{
        .summits = {.radius = 100_nm, .density = 1 / (20_um * 5_um), .effective_modulus = 48_GPa}, .height = 100_nm});
    contact.conduction = {.resistivity = gold_pair.resistivity};
    expect_ohm(resistance_law(contact).resistance(any_depth, row.force), row.holm, kept_to, "Holm");
    const double radius = gold_pair.resistivity / (2 * row.holm);
    constexpr double long_path = 1e-2;  // [m]
    expect_ohm(ContactResistance::of_spot(radius, gold_pair.resistivity, long_path) * gold_pair.mean_free_path / long_path,
               row.sharvin, 1e-4, "Sharvin");
  }
}

TEST(ContactResistance, OfNineSpotsAgreesWithAnIndependentProgram) {
  for (const auto& [force, right] : {std::pair{1e-5, 0.1586502237014923}, std::pair{2e-5, 0.09036869139426915},
                                     std::pair{5e-5, 0.04539369387121459}, std::pair{1e-4, 0.028148821975657587}}) {
    expect_ohm(resistance_law(gold_spring(9)).resistance(any_depth, force), right, kept_to, "nine contacts side by side");
    // A rough pad with nine summits, all in touch. The spots are plastic: elastic ones would be smaller.
    Contact rough = test::gold_contact(UniformAsperities{
        .summits = {.radius = 100_nm, .density = 9 / (20_um * 5_um), .effective_modulus = 48_GPa}, .height = 100_nm});
    rough.conduction = gold_spring().conduction;
    expect_ohm(resistance_law(rough).resistance(100_nm, force), right, kept_to, "nine summits");
  }
}

// The bound is from the abstract of Nikolic and Allen, for the exact formula.
TEST(ContactResistance, StaysWithin11PercentOfThePlainSumOfItsLimits) {
  constexpr double path = 38e-9;  // [m]
  double most = 0;
  for (double radius = 1e-10; radius < 1e-5; radius *= 1.2) {
    const double sharvin = 4 * gold_pair.resistivity * path / (3 * std::numbers::pi * radius * radius);
    const double plain = sharvin + gold_pair.resistivity / (2 * radius);
    const double less = 1 - ContactResistance::of_spot(radius, gold_pair.resistivity, path) / plain;
    EXPECT_GE(less, 0) << radius;
    most = std::max(most, less);
  }
  EXPECT_GT(most, 0.1);
  EXPECT_LT(most, 0.125) << "11 % and what the approximation of the function errs by";
}

TEST(ContactResistance, OfManySpotsFallsByHolmAndStaysBySharvin) {
  constexpr double force = 1e-4, spots = 16;
  Contact contact = gold_spring(), many = gold_spring(spots);
  contact.conduction.mean_free_path = many.conduction.mean_free_path = 0;
  expect_ohm(resistance_law(many).resistance(any_depth, force),
             resistance_law(contact).resistance(any_depth, force) / std::sqrt(spots), to_rounding);
  // With ballistic electrons in every spot only the total area of the spots matters, which follows from the load.
  contact.conduction.mean_free_path = many.conduction.mean_free_path = 1e-2;
  expect_ohm(resistance_law(many).resistance(any_depth, force), resistance_law(contact).resistance(any_depth, force), 1e-4);
}

TEST(ContactResistance, CountsTheSummitsInTouch) {
  constexpr double force = 1e-5;
  const auto spots_alone = [&](double n) { return resistance_law(gold_spring(n)).resistance(any_depth, force); };
  Contact uniform = test::gold_contact(
      UniformAsperities{.summits = {.radius = 1_nm, .density = 1e12, .effective_modulus = 48_GPa}, .height = 100_nm});
  uniform.conduction = gold_spring().conduction;
  // 100 summits under the pad of 20 um by 5 um; their small radius keeps every spot plastic.
  expect_ohm(resistance_law(uniform).resistance(20_nm, force), spots_alone(20), to_rounding, "a fifth of the heights");
  expect_ohm(resistance_law(uniform).resistance(250_nm, force), spots_alone(100), to_rounding, "crushed");
  expect_ohm(resistance_law(uniform).resistance(0.1_nm, force), spots_alone(1), to_rounding, "one at least");

  Contact gaussian = test::gold_contact(
      GaussianAsperities{.summits = {.radius = 1_nm, .density = 1e12, .effective_modulus = 48_GPa}, .deviation = 10_nm});
  gaussian.conduction = gold_spring().conduction;
  expect_ohm(resistance_law(gaussian).resistance(40_nm, force), spots_alone(50), to_rounding,
             "the plane is at the mean of the summits");
  // 2.275 % of the summits are more than two standard deviations above the mean.
  expect_ohm(resistance_law(gaussian).resistance(20_nm, force), spots_alone(2.2750131948179), 1e-9);
}

TEST(ContactResistance, OfASpotIsElasticUntilItsPressureIsTheHardness) {
  const auto of_one = [](double force, double own_hardness) {
    Contact contact = test::gold_contact(UniformAsperities{
        .summits = {.radius = 100_nm, .density = 1 / (20_um * 5_um), .effective_modulus = 48_GPa}, .height = 100_nm});
    contact.conduction = {.resistivity = gold_pair.resistivity, .hardness = own_hardness};
    return resistance_law(contact).resistance(any_depth, force);
  };
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  // (3 R / (4 E*))^2 (pi H)^3: the load at which elastic and plastic radius are equal [N].
  const double at = std::pow(3 * 100e-9 / (4 * 48e9), 2) * std::pow(std::numbers::pi * gold_pair.hardness, 3);
  EXPECT_EQ(of_one(0.5 * at, gold_pair.hardness), of_one(0.5 * at, none)) << "elastic";
  expect_ohm(of_one(at, gold_pair.hardness), of_one(at, none), to_rounding, "continuous");
  EXPECT_LT(of_one(2 * at, gold_pair.hardness), of_one(2 * at, none)) << "plastic";
}

TEST(ContactResistance, OfAnOpenContactIsNoneAndNeverInfinite) {
  const ContactResistance contact = resistance_law(gold_spring());
  for (const double force : {0.0, -1e-6}) {
    EXPECT_TRUE(std::isnan(contact.resistance(-1e-9, force))) << force;
    EXPECT_EQ(contact.conductance(-1e-9, force), 0) << force;
  }
  EXPECT_TRUE(contact.is_known());
  EXPECT_FALSE(resistance_law(test::gold_contact(LinearSpring{.stiffness = 1e4})).is_known());
}

TEST(ContactResistance, TakesWhatAdhesionAddsToTheLoad) {
  const AdhesiveAsperities sticky{
      .summits = {.radius = 100_nm, .density = 1e11, .effective_modulus = 48_GPa}, .height = 100_nm, .adhesion_energy = 0.05};
  Contact adhesive = test::gold_contact(sticky);
  Contact lossless = test::gold_contact(UniformAsperities{.summits = sticky.summits, .height = sticky.height});
  adhesive.conduction = lossless.conduction = gold_spring().conduction;
  const ContactLaw with = contact_law(adhesive, 20_um), without = contact_law(lossless, 20_um);
  bool has_pulled = false;
  for (const double depth : {0.1e-9, 1e-9, 2e-9, 5e-9, 20e-9, 60e-9}) {
    const double net = contact_force(with, depth), load = contact_force(without, depth);
    has_pulled = has_pulled || net < 0;
    expect_ohm(resistance_law(adhesive).resistance(depth, net), resistance_law(lossless).resistance(depth, load), 1e-9,
               "the summits carry the same");
  }
  EXPECT_TRUE(has_pulled) << "a contact that pulls conducts too";
}

TEST(ContactResistance, HasAFilmInSeriesWithEachContact) {
  Contact film = gold_spring(4);
  film.conduction.film_resistance = 2;
  constexpr double force = 1e-4;
  expect_ohm(resistance_law(film).resistance(any_depth, force),
             resistance_law(gold_spring(4)).resistance(any_depth, force) + 2.0 / 4, to_rounding);
}

TEST(ContactResistance, OfAConnectionIsInSeriesWhereAllAreNeededAndElseSideBySide) {
  Device device = test::gold_cantilever();
  device.contacts = {gold_spring(), gold_spring(), gold_spring()};
  device.contacts[2].connects = false;
  const std::vector<double> conductances{0.5, 0.25, 100};
  EXPECT_EQ(resistance_of(connection_conductance(device, conductances)), 6) << "2 and 4 Ohm, one after the other";
  EXPECT_TRUE(std::isnan(resistance_of(connection_conductance(device, std::vector<double>{0.5, 0, 100})))) << "one is open";
  device.connection = Connection::any;
  EXPECT_EQ(connection_conductance(device, conductances), 0.75);
  EXPECT_EQ(connection_conductance(device, std::vector<double>{0.5, 0, 100}), 0.5) << "the other one conducts";
  EXPECT_TRUE(std::isnan(resistance_of(connection_conductance(device, std::vector<double>{0, 0, 100}))));
}

}  // namespace
}  // namespace softland
