#include "model/pull_in.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/contact/contact_law.h"
#include "tests/model/gold.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;
using test::gold;

/// A switch with an electrode near the root, whose contact point reaches the contact plane before the fold.
Switch contact_first() {
  Device d = test::gold_cantilever();
  d.electrodes[0].begin = 0;
  d.electrodes[0].end = d.structure.length / 2;
  return Switch(d);
}

/// True if the contact point reaches the plane within a hundred periods of a step: the definition of dynamic pull-in, without
/// the shortcuts of the implementation.
bool reaches(const Switch& model, double volts) {
  const std::vector<Signal> drives{Signal::constant(volts)};
  const double window = 100 * 2 * pi / model.basis().angular_frequencies()[0];
  return !simulate_closing(model, drives, {.duration = window, .tolerance = 1e-9, .after_contact = 0}).touches.empty();
}

TEST(StaticPullIn, AtTheFoldLeavesNoEquilibriumForASlowerRamp) {
  // An independent method: a damped step comes to rest below the fold, and closes the switch above it.
  Device d = test::gold_cantilever();
  d.structure.damping_ratio = 0.7;
  const Switch model(d);
  const StaticPullIn found = static_pull_in(model, 0);
  EXPECT_EQ(found.kind, StaticKind::fold);
  EXPECT_LT(found.deflection, d.gap.contact);
  EXPECT_FALSE(reaches(model, 0.999 * found.voltage));
  EXPECT_TRUE(reaches(model, 1.001 * found.voltage));
}

TEST(StablePath, OfAPiezoIsItsVoltsTimesTheDeflectionPerVolt) {
  // At 0 V on the electrode the beam under its layer is linear.
  Device d = test::gold_cantilever();
  d.piezo = Piezo{.begin = 5_um, .end = 240_um, .thickness = 1_um, .youngs_modulus = 61e9, .density = 7750, .d31 = -171e-12};
  const Switch model(d);
  const std::optional<StablePath> path = stable_path(model, 1);
  ASSERT_TRUE(path);
  const double per_volt = model.basis().piezo_deflection();
  EXPECT_NEAR(path->reaches(), d.gap.contact / per_volt, 1e-9 * std::abs(path->reaches()));
  EXPECT_NEAR(path->slope(), per_volt, 1e-9 * std::abs(per_volt));
  for (std::size_t k = 0; k < path->values.size(); ++k)
    EXPECT_NEAR(path->deflections[k], per_volt * path->values[k], 1e-9 * d.gap.contact);
  // A low voltage on an electrode softens the beam, so that the piezo needs less voltage.
  EXPECT_LT(std::abs(stable_path(model, 1, std::vector<double>{5.0, 0.0})->reaches()), std::abs(path->reaches()));
}

TEST(StablePath, OfAnElectrodeEndsWhereTheContactComesBeforeTheFold) {
  const Switch model = contact_first();
  const std::optional<StablePath> path = stable_path(model, 0);
  ASSERT_TRUE(path);
  EXPECT_NEAR(path->reaches(), static_pull_in(model, 0).voltage, 1e-6 * path->reaches());
  EXPECT_FALSE(stable_path(gold(), 0)) << "its contact lies beyond the fold";
  // An independent method: a damped step at a voltage of the path comes to rest at the deflection of the path.
  Device damped = model.device();
  damped.structure.damping_ratio = 0.7;
  const std::size_t middle = path->values.size() / 2;
  const std::vector<Signal> drives{Signal::constant(path->values[middle])};
  const double rest = simulate_closing(Switch(damped), drives, {.duration = 5'000_us, .tolerance = 1e-8}).points.back().position;
  EXPECT_NEAR(rest, path->deflections[middle], 1e-5 * path->deflections[middle]);
}

TEST(StablePath, OfAnElectrodeOnTheFarSideIsNone) {
  Device d = contact_first().device();
  d.electrodes[0].side = Side::far;
  d.electrodes[0].gap = d.gap.electrode;
  EXPECT_FALSE(stable_path(Switch(d), 0));
}

TEST(StaticPullIn, SettledBeamStandsOnTheBranch) {
  // An independent method: a damped step just below pull-in comes to rest near the deflection of the fold.
  Device d = test::gold_cantilever();
  d.structure.damping_ratio = 0.7;
  const Switch model(d);
  const StaticPullIn found = static_pull_in(model, 0);
  const std::vector<Signal> drives{Signal::constant(0.9999 * found.voltage)};
  const double rest = simulate_closing(model, drives, {.duration = 20'000_us, .tolerance = 1e-8}).points.back().position;
  EXPECT_LT(rest, found.deflection);
  EXPECT_GT(rest, 0.97 * found.deflection);  // the branch is a parabola there: one per cent of deflection for 1e-4 of voltage
}

TEST(StaticPullIn, IsTheContactWhereThatComesFirst) {
  const Switch model = contact_first();
  const StaticPullIn found = static_pull_in(model, 0);
  ASSERT_EQ(found.status, Status::done);
  EXPECT_EQ(found.kind, StaticKind::contact);
  EXPECT_EQ(to_string(found.kind), "contact");
  EXPECT_EQ(to_string(StaticKind::fold), "fold");
  EXPECT_DOUBLE_EQ(found.deflection, model.device().gap.contact);
  // Without a fold the switch opens at the voltage at which it closes.
  EXPECT_NEAR(release_voltage(model, 0), found.voltage, 1e-9 * found.voltage);
}

TEST(StaticPullIn, AtTheContactIsWhatABiasLeavesOfTheBalance) {
  // At touch, k x = eps0 (A V^2 + B U^2) / (2 (g - x)^2).
  Device d = test::full_plate();
  d.gap.contact = 1_um;  // a gap before the fold
  for (Electrode& e : d.electrodes) e.fringing = Fringing::none;
  const double bias = 3, x = d.gap.contact, A = 70_um * 100_um, B = 30_um * 100_um;
  const double both = 2 * part_of<Plate>(d.structure).stiffness * x * std::pow(d.gap.electrode - x, 2) / vacuum_permittivity;
  const StaticPullIn found = static_pull_in(Switch(d), 0, std::vector<double>{0, bias});
  EXPECT_EQ(found.kind, StaticKind::contact);
  EXPECT_NEAR(found.voltage, std::sqrt((both - B * bias * bias) / A), 1e-9 * found.voltage);
}

TEST(StaticPullIn, DoesNotDependOnGasDampingOrDensity) {
  Device d = test::gold_cantilever();
  d.gas.reset();
  d.structure.damping_ratio = 0.3;
  part_of<Beam>(d.structure).density *= 2;
  const double reference = static_pull_in(gold(), 0).voltage;
  EXPECT_NEAR(static_pull_in(Switch(d), 0).voltage, reference, 1e-9 * reference);
}

TEST(StaticPullIn, ScalesWithTheRootOfTheModulus) {
  Device d = test::gold_cantilever();
  part_of<Beam>(d.structure).youngs_modulus *= 4;
  const double reference = static_pull_in(gold(), 0).voltage;
  EXPECT_NEAR(static_pull_in(Switch(d), 0).voltage, 2 * reference, 1e-9 * reference);
}

TEST(StaticPullIn, OfEachElectrodeKeepsTheOthersAtZero) {
  Device d = test::gold_cantilever();
  d.electrodes = {{.name = "root", .begin = 20_um, .end = 100_um}, {.name = "tip", .begin = 150_um, .end = 240_um}};
  const Switch both(d);
  for (const std::size_t k : {0u, 1u}) {
    Device one = d;
    one.electrodes = {d.electrodes[k]};
    const double alone = static_pull_in(Switch(one), 0).voltage;
    EXPECT_NEAR(static_pull_in(both, k).voltage, alone, 1e-7 * alone) << k;
  }
}

TEST(DynamicPullIn, SeparatesTheStepsThatTouchFromThoseThatDoNot) {
  constexpr double margin = 1e-6;  // relative; the search stops at 1e-7
  Device undamped = test::gold_cantilever();
  undamped.gas.reset();
  undamped.structure.modes = 2;
  for (const Switch& model : {gold(), contact_first(), Switch(undamped)}) {
    const DynamicPullIn found = dynamic_pull_in(model, 0, static_pull_in(model, 0));
    ASSERT_EQ(found.status, Status::done);
    EXPECT_FALSE(reaches(model, (1 - margin) * found.voltage));
    EXPECT_TRUE(reaches(model, (1 + margin) * found.voltage));
  }
}

TEST(DynamicPullIn, LiesBetweenTheUndampedOneAndTheStaticOne) {
  Device d = test::gold_cantilever();
  d.gas.reset();
  const Switch undamped(d);
  const double statically = static_pull_in(gold(), 0).voltage;
  const double with_gas = dynamic_pull_in(gold(), 0, static_pull_in(gold(), 0)).voltage;
  const double without = dynamic_pull_in(undamped, 0, static_pull_in(undamped, 0)).voltage;
  EXPECT_LT(without, with_gas);
  EXPECT_LT(with_gas, statically);
  EXPECT_GT(without, 0.85 * statically);
}

TEST(DynamicPullIn, PassesOnTheStatusOfStaticPullIn) {
  const DynamicPullIn found = dynamic_pull_in(gold(), 0, {.status = Status::numerical_failure});
  EXPECT_EQ(found.status, Status::numerical_failure);
  EXPECT_TRUE(std::isnan(found.voltage));
}

TEST(DynamicPullIn, ReportsProgressThatNeverDecreases) {
  // A switch in a viscous film creeps, an undamped one closes at the first trial: tests brackets of both kinds.
  for (const double viscosity : {0.0, 1.86e-5, 1e-2}) {
    Device device = test::gold_cantilever();
    if (viscosity == 0) device.gas.reset();
    if (viscosity > 0) device.gas = StripGas{.film = {.viscosity = viscosity}};
    const Switch model(device);
    double last = 0;
    int told = 0;
    const Progress progress{.report = [&](std::string_view what, double part) {
      EXPECT_EQ(what, "dynamic pull-in voltage");
      EXPECT_TRUE(part >= last && part <= 1) << part << " after " << last;
      last = part;
      ++told;
    }};
    const DynamicPullIn found = dynamic_pull_in(model, 0, static_pull_in(model, 0), {}, progress);
    EXPECT_EQ(found.status, Status::done);
    EXPECT_GT(told, 10);
    EXPECT_GT(last, 0.9);
  }
}

TEST(PullIn, IsNotForAnElectrodeOnTheFarSide) {
  const Switch model(test::plate_between_electrodes());
  EXPECT_TRUE(pulls_in(model.device(), 0));
  EXPECT_FALSE(pulls_in(model.device(), 1));
  const StaticPullIn none = static_pull_in(model, 1);
  EXPECT_EQ(none.status, Status::no_contact);
  EXPECT_EQ(dynamic_pull_in(model, 1, none).status, Status::no_contact);
  EXPECT_TRUE(std::isnan(release_voltage(model, 1)));
  EXPECT_EQ(static_pull_in(model, 0).status, Status::done);
}

TEST(StaticPullIn, OfFacesOnBothSidesIsTheMaximumOfTheBalance) {
  // k x = eps0 A V^2 / 2 [1/(g - x)^2 - 1/(G + x)^2]: the largest V^2 over x, by a fine scan.
  Device d = test::full_plate();
  d.gas.reset();
  d.electrodes = {{.name = "main", .begin = 0, .end = 70_um, .fringing = Fringing::none, .side = Side::both, .gap = 5_um}};
  const double g = d.gap.electrode, G = 5_um, factor = vacuum_permittivity * 7e-9 / (2 * part_of<Plate>(d.structure).stiffness);
  double most = 0;
  for (int i = 1; i < 100000; ++i) {
    const double x = 0.6 * g * i / 100000;
    most = std::max(most, x / factor / (1 / ((g - x) * (g - x)) - 1 / ((G + x) * (G + x))));
  }
  EXPECT_NEAR(static_pull_in(Switch(d), 0).voltage, std::sqrt(most), 1e-8 * std::sqrt(most));
  d.electrodes[0].gap = 1;  // so far away that it has no effect
  const double alone = std::sqrt(8 * std::pow(g, 3) / (27 * 2 * factor));
  EXPECT_NEAR(static_pull_in(Switch(d), 0).voltage, alone, 1e-9 * alone);
}

TEST(ReleaseVoltage, IsWhereTheClosedEquilibriumVanishes) {
  constexpr double margin = 1e-5;
  Device spring = test::gold_cantilever();
  spring.contacts.front().model = LinearSpring{.stiffness = 1e3_N_m};
  for (const Switch& model : {gold(), Switch(spring), contact_first()}) {
    const double release = release_voltage(model, 0);
    EXPECT_FALSE(closed_equilibrium(model, std::vector<double>{(1 - margin) * release}));
    EXPECT_TRUE(closed_equilibrium(model, std::vector<double>{(1 + margin) * release}));
    EXPECT_LE(release, static_pull_in(model, 0).voltage * (1 + margin));
  }
}

TEST(ReleaseVoltage, IsWhereAClosedSwitchOpens) {
  // An independent method: close by a step, then lower the voltage slowly with strong damping until the contact opens.
  Device gold_damped = test::gold_cantilever();
  gold_damped.structure.damping_ratio = 0.5;
  Device soft = gold_damped;
  test::rough(soft).summits.density =
      1e6;  // so soft that the voltage decreases well below the plane before the contact makes it increase
  for (const Device& d : {gold_damped, soft}) {
    const Switch model(d);
    const double release = release_voltage(model, 0), high = 1.2 * static_pull_in(model, 0).voltage;
    const auto opens = [&](double low) {
      const std::vector<Signal> drives{Signal::piecewise_linear({{0, high}, {500_us, high}, {1500_us, low}})};
      const Trajectory t = simulate_closing(model, drives, {.duration = 20'000_us});
      return std::isfinite(t.touches.back().end);
    };
    constexpr double margin = 2e-4;  // relative; closer to the fold, opening takes longer than the window
    EXPECT_TRUE(opens((1 - margin) * release));
    EXPECT_FALSE(opens((1 + margin) * release));
  }
}

/// Contacts from much softer than the beam (0.2 N/m) to much stiffer, with both laws.
std::vector<Device> contacts_of_every_stiffness() {
  std::vector<Device> all;
  std::mt19937_64 random(7);
  const auto log_uniform = [&](double low, double high) {
    return low * std::pow(high / low, std::uniform_real_distribution<double>()(random));
  };
  for (int k = 0; k < 30; ++k) {
    Device d = k % 3 == 0 ? contact_first().device() : test::gold_cantilever();
    d.contacts.front().model = LinearSpring{.stiffness = log_uniform(0.01_N_m, 1e8_N_m)};
    all.push_back(d);
    d.contacts.front().model = UniformAsperities::example();
    test::rough(d).summits.density = log_uniform(1e4, 1e14);
    test::rough(d).height = log_uniform(3_nm, 1_um);
    all.push_back(d);
  }
  return all;
}

TEST(ReleaseVoltage, IsWhereTheClosedEquilibriumVanishesForEveryContact_optimized) {
  constexpr double margin = 1e-5;
  int holding = 0, never = 0;
  for (const Device& d : contacts_of_every_stiffness()) {
    const Switch model(d);
    const double release = release_voltage(model, 0);
    const auto closed = [&](double volts) { return closed_equilibrium(model, std::vector<double>{volts}); };
    const std::string name =
        std::holds_alternative<LinearSpring>(d.contacts.front().model)
            ? fmt::format("linear, {} N/m", std::get<LinearSpring>(d.contacts.front().model).stiffness)
            : fmt::format("asperities, {} 1/m^2, {} m", number_of(d.contacts.front().model, "asperity_density", 0),
                          number_of(d.contacts.front().model, "asperity_height", 0));
    if (std::isnan(release)) {  // too soft to keep the beam off the electrode at any voltage
      ++never;
      for (double volts = 1; volts < 40; volts *= 1.05) EXPECT_FALSE(closed(volts)) << name << ", " << volts << " V";
      continue;
    }
    ++holding;
    for (const double share : {0.1, 0.5, 0.9, 0.99, 1 - margin}) EXPECT_FALSE(closed(share * release)) << name << ", " << share;
    ASSERT_TRUE(closed((1 + margin) * release)) << name << ", release at " << release << " V";
    double force = closed((1 + margin) * release)->contact_force;
    EXPECT_GT(force, 0);
    for (const double share : {1.001, 1.01, 1.1, 1.5}) {
      const auto harder = closed(share * release);
      if (!harder) break;  // the beam collapses onto the electrode
      EXPECT_GT(harder->contact_force, force) << name << ", " << share;
      force = harder->contact_force;
    }
  }
  EXPECT_GT(holding, 20);
  EXPECT_GT(never, 2);
}

TEST(ReleaseVoltage, NeedsAContact) {
  Device d = test::gold_cantilever();
  d.contacts.clear();
  EXPECT_TRUE(std::isnan(release_voltage(Switch(d), 0)));
  EXPECT_FALSE(closed_equilibrium(Switch(d), std::vector<double>{20}));
}

TEST(ClosedEquilibrium, IsAnEquilibrium) {
  const Switch pzt(test::gold_pzt_cantilever());
  struct Case {
    const Switch& model;
    std::vector<double> volts;
  };
  for (const auto& [model, volts] :
       {Case{gold(), {15.5}}, Case{gold(), {17.771}}, Case{pzt, {28, 0}}, Case{pzt, {28, -0.3}}, Case{pzt, {28, 0.1}}}) {
    const auto closed = closed_equilibrium(model, volts);
    ASSERT_TRUE(closed.has_value());
    Switch::Workspace work = model.workspace();
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.modes());
    Eigen::VectorXd a(model.modes());
    model.accelerations(closed->q.data(), rest.data(), volts, true, work, a.data());
    const double contact = closed->contact_force * model.basis().contact_shape().maxCoeff();
    EXPECT_LT(a.cwiseAbs().maxCoeff(), 1e-6 * contact);
    EXPECT_GT(closed->contact_force, 0);
    const double d = model.contact_deflection(closed->q.data()) - model.device().gap.contact;
    EXPECT_NEAR(contact_force(model.contact(), d), closed->contact_force, 1e-6 * closed->contact_force);
    EXPECT_DOUBLE_EQ(closed->potential, model.potential(closed->q.data(), volts, true, work));
  }
}

TEST(ClosedEquilibrium, IsFoundBetweenASoftContactAndTheElectrode) {
  // A spring that is softer than the beam is compressed by much of the distance between contact plane and electrode.
  Device d = test::gold_cantilever();
  d.contacts.front().model = LinearSpring{.stiffness = 0.15_N_m};
  d.electrodes[0].begin = 0;
  d.electrodes[0].end = d.structure.length / 2;
  const Switch model(d);
  const std::vector<double> volts{1.05 * release_voltage(model, 0)};
  const auto closed = closed_equilibrium(model, volts);
  ASSERT_TRUE(closed.has_value());
  Switch::Workspace work = model.workspace();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.modes());
  Eigen::VectorXd a(model.modes());
  model.accelerations(closed->q.data(), rest.data(), volts, true, work, a.data());
  EXPECT_LT(a.cwiseAbs().maxCoeff(), 1e-6 * closed->contact_force * model.basis().contact_shape().maxCoeff());
}

TEST(ClosedEquilibrium, IsWhereABouncingSwitchComesToRest) {
  Device d = test::gold_cantilever();
  d.structure.damping_ratio = 0.3;
  for (const ContactDistribution distribution : {ContactDistribution::centre, ContactDistribution::pad}) {
    d.contacts.front().distribution = distribution;
    const Switch model(d);
    const auto closed = closed_equilibrium(model, std::vector<double>{17.771});
    ASSERT_TRUE(closed.has_value());
    const std::vector<Signal> drives{Signal::constant(17.771)};
    const Trajectory t = simulate_closing(model, drives, {.duration = 1000_us, .tolerance = 1e-8});
    EXPECT_NEAR(t.points.back().contact_force, closed->contact_force, 1e-3 * closed->contact_force);
  }
}

TEST(ClosedEquilibrium, IsPressedHarderByAPiezoThatPullsDown) {
  const Switch model(test::gold_pzt_cantilever());
  const auto force = [&](double piezo_volts) {
    return closed_equilibrium(model, std::vector<double>{28, piezo_volts})->contact_force;
  };
  EXPECT_GT(force(-0.1), force(0));
  EXPECT_LT(force(0.1), force(0));
}

TEST(ClosedEquilibrium, IsOneForEveryContactLaw) {
  const std::vector<double> volts{17.771};
  std::vector<Contact> contacts = test::contacts();
  for (const Contact& along_pad : test::pad_contacts()) contacts.push_back(along_pad);
  for (const Contact& contact : contacts) {
    Device d = test::gold_cantilever();
    d.contacts = {contact};
    const Switch model(d);
    const auto closed = closed_equilibrium(model, volts);
    ASSERT_TRUE(closed.has_value()) << name_of(contact.model);
    EXPECT_GT(closed->contact_force, 0);
    Switch::Workspace work = model.workspace();
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.modes());
    Eigen::VectorXd left(model.modes());
    model.accelerations(closed->q.data(), rest.data(), volts, true, work, left.data());
    constexpr double digits = 1e-6;  // error as a share of the contact force
    EXPECT_LT(left.norm(), digits * closed->contact_force * model.basis().contact_shape().norm()) << name_of(contact.model);
    EXPECT_GT(release_voltage(model, 0), 0) << name_of(contact.model);
  }
}

}  // namespace
}  // namespace softland
