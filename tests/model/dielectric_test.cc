// A dielectric on the electrode: a plate that lands on it, by closed forms, and a beam above it, compared with a beam above a
// deeper electrode. A charge on its face shifts the voltage by V0 = -charge t / (eps_r eps0).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "model/closing.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "objectives/metrics.h"
#include "tests/model/expect_refused.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

// K = 10 N/m, M = 1e-10 kg, A = 1e-8 m^2; 0.2 um of nitride under 4 um of air.
Device plate_over_nitride() {
  return {.structure = {.length = 100_um, .width = 100_um, .kind = Plate{.mass = 1e-10, .stiffness = 10}},
          .gap = {.electrode = 4_um, .contact = 4_um},
          .electrodes = {{.name = "main",
                          .begin = 0,
                          .end = 100_um,
                          .fringing = Fringing::none,
                          .dielectric = Dielectric{.thickness = 0.2_um, .permittivity = 7.6}}},
          .contacts = {Contact{.model = RigidStop{.restitution = 0.3}}}};
}

void expect_within(double value, double kept, double relative, const char* what) {
  EXPECT_NEAR(value, kept, relative * std::abs(kept)) << what;
}

// The plate has closed forms at sqrt(8 K D^3 / (27 eps0 A)), D = 4 um + t / eps; other values come from quadrature in an
// independent program.
TEST(Dielectric, APlateLandsOnItAsClosedFormsSay) {
  const Switch model(plate_over_nitride());
  const StaticPullIn fold = static_pull_in(model, 0);
  ASSERT_EQ(fold.kind, StaticKind::fold);
  expect_within(fold.voltage, 46.73588788239068, 1e-8, "static pull-in");
  expect_within(dynamic_pull_in(model, 0, fold).voltage, 42.92965424541772, 1e-7, "dynamic pull-in");
  expect_within(release_voltage(model, 0), 0.7910192125773502, 1e-8, "release");
  Switch::Workspace work = model.workspace();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(1), down = Eigen::VectorXd::Constant(1, 4_um / model.contact_shape()[0]);
  expect_within(model.capacitance(0, rest.data(), work), 2.1990793260549024e-14, 1e-8, "capacitance of the open state");
  expect_within(model.capacitance(0, down.data(), work), 3.364591368864e-12, 1e-8, "capacitance on the dielectric");

  MetricsObserver figures(model.contact_gap());
  const Trajectory run = observe_closing(model, std::vector<Signal>{Signal::constant(1.2 * 46.73588788239068)},
                                         {.duration = 40e-6, .tolerance = 1e-10}, figures);
  ASSERT_EQ(run.status, Status::done) << run.message;
  const Metrics m = figures.metrics(run);
  expect_within(m.initial_contact_time, 9.364403257595555e-06, 1e-7, "first touch");
  expect_within(m.impact_velocity, 10.175222744232038, 1e-7, "speed of the first touch");
  EXPECT_GE(run.smallest_gap, -1e-15) << "the wall lets nothing through";
}

TEST(Dielectric, RoughnessIsAirThatIsLeft) {
  Device rough = plate_over_nitride();
  rough.electrodes[0].dielectric->roughness = 20_nm;
  const double depth = 0.2e-6 / 7.6 + 20e-9;
  // The springs hold the plate at its rest gap against eps0 A V^2 / (2 depth^2).
  expect_within(release_voltage(Switch(rough), 0), std::sqrt(2 * 10 * 4e-6 * depth * depth / (vacuum_permittivity * 1e-8)), 1e-8,
                "release");
}

// A dielectric that the beam does not reach acts as if the electrode were deeper by t / eps.
TEST(Dielectric, ABeamFeelsADeeperElectrode) {
  Device coated = test::gold_cantilever(), bare = coated;
  for (Device* d : {&coated, &bare}) {
    d->gas.reset();
    d->structure.modes = 4;
  }
  coated.electrodes[0].dielectric = Dielectric{.thickness = 0.2_um, .permittivity = 7.6};
  bare.gap.electrode += 0.2_um / 7.6;
  const Switch through(coated), deeper(bare);
  expect_within(static_pull_in(through, 0).voltage, static_pull_in(deeper, 0).voltage, 1e-10, "static pull-in");
  expect_within(release_voltage(through, 0), release_voltage(deeper, 0), 1e-9, "release");
  const auto figures = [](const Switch& model) {
    MetricsObserver observer(model.contact_gap());
    const Trajectory run =
        observe_closing(model, std::vector<Signal>{Signal::constant(20)}, {.duration = 60e-6, .tolerance = 1e-10}, observer);
    EXPECT_EQ(run.status, Status::done) << run.message;
    EXPECT_LT(run.energy_error, 1e-6 * model.bending_energy());
    return observer.metrics(run);
  };
  const Metrics own = figures(through), other = figures(deeper);
  expect_within(own.initial_contact_time, other.initial_contact_time, 1e-9, "first touch");
  expect_within(own.impact_velocity, other.impact_velocity, 1e-8, "speed of the first touch");
  expect_within(own.major_bounce_height, other.major_bounce_height, 1e-6, "highest rebound");
  EXPECT_GT(std::abs(static_pull_in(Switch(test::gold_cantilever()), 0).voltage / static_pull_in(through, 0).voltage - 1), 1e-3)
      << "it does something";
}

// A run ends with a message if the beam collapses onto the dielectric.
TEST(Dielectric, ABeamThatReachesItEndsItsRun) {
  Device coated = test::gold_cantilever();
  coated.electrodes[0].dielectric = Dielectric{.thickness = 0.2_um, .permittivity = 7.6};
  const Switch model(coated);
  MetricsObserver figures(model.contact_gap());
  const Trajectory run = observe_closing(model, std::vector<Signal>{Signal::constant(80)}, {.duration = 60e-6}, figures);
  EXPECT_EQ(run.status, Status::collapsed_onto_electrode);
  EXPECT_TRUE(run.message.ends_with("the beam came within 35 nm of the dielectric on the electrode")) << run.message;
}

// A contact that is too soft for the field at the face does not hold the plate.
TEST(Dielectric, APlateOnASoftContactSinksIn) {
  Device soft = plate_over_nitride();
  soft.contacts = {Contact{.model = LinearSpring{.stiffness = 100}}};
  const Switch model(soft);
  MetricsObserver figures(model.contact_gap());
  const Trajectory run = observe_closing(model, std::vector<Signal>{Signal::constant(56)}, {.duration = 40e-6}, figures);
  EXPECT_EQ(run.status, Status::collapsed_onto_electrode);
  EXPECT_TRUE(run.message.ends_with("the plate sank 13.16 nm into the dielectric on the electrode")) << run.message;
}

// The plate over nitride with a charge on the face.
struct ChargedPlate {
  static constexpr double stiffness = 10, gap = 4e-6, area = 1e-8, thickness = 0.2e-6, permittivity = 7.6;
  static constexpr double depth = thickness / permittivity, field_gap = gap + depth;

  explicit ChargedPlate(double charge) : neutral(-charge * thickness / (permittivity * vacuum_permittivity)) {
    device.electrodes[0].dielectric->charge = charge;
  }
  // Returns the (V - V0)^2 at which the plate is in equilibrium at a deflection [V^2].
  [[nodiscard]] static double balance(double x) {
    return 2 * stiffness * x * std::pow(field_gap - x, 2) / (vacuum_permittivity * area);
  }
  [[nodiscard]] static double capacitance(double x) { return vacuum_permittivity * area / (field_gap - x); }
  // Returns the deflection at 0 V, under the charge alone: the smaller root of the cubic, by bisection up to the fold.
  [[nodiscard]] double rest() const {
    double low = 0, high = field_gap / 3;
    for (int i = 0; i < 100; ++i) {
      const double middle = (low + high) / 2;
      (balance(middle) < neutral * neutral ? low : high) = middle;
    }
    return low;
  }
  // Returns the least (V - V0)^2 under which a step from rest passes the fold: the speed vanishes at the maximum of the
  // potential.
  [[nodiscard]] double dynamic_balance() const {
    const double x0 = rest();
    const auto passes = [&](double square) {
      double highest = -std::numeric_limits<double>::infinity();
      const auto potential = [&](double x) { return stiffness * x * x / 2 - capacitance(x) * square / 2; };
      constexpr int places = 200000;
      for (int k = 1; k <= places; ++k) highest = std::max(highest, potential(x0 + (gap - x0) * k / places));
      return highest <= potential(x0) * (1 - 1e-14);
    };
    double low = neutral * neutral, high = 8 * stiffness * std::pow(field_gap, 3) / (27 * vacuum_permittivity * area);
    for (int i = 0; i < 50; ++i) {
      const double middle = (low + high) / 2;
      (passes(middle) ? high : low) = middle;
    }
    return high;
  }

  Device device = plate_over_nitride();
  double neutral;
};

constexpr double much_charge = 2e-3;  // C/m^2: 5.9 V

TEST(DielectricCharge, ShiftsThePullInAndReleaseOfAPlate) {
  const double pull_in = 46.73588788239068, release = 0.7910192125773502;  // values without charge
  for (const double charge : {much_charge, -much_charge}) {
    SCOPED_TRACE(charge);
    const ChargedPlate plate(charge);
    const Switch model(plate.device);
    EXPECT_NEAR(model.neutral_voltage(0), plate.neutral, 1e-12);
    const StaticPullIn fold = static_pull_in(model, 0);
    ASSERT_EQ(fold.status, Status::done);
    ASSERT_EQ(fold.kind, StaticKind::fold);
    expect_within(fold.voltage, plate.neutral + pull_in, 1e-8, "static pull-in");
    expect_within(release_voltage(model, 0), plate.neutral + release, 1e-7, "release");
    const double dynamically = plate.neutral + std::sqrt(plate.dynamic_balance());
    expect_within(dynamic_pull_in(model, 0, fold).voltage, dynamically, 3e-7, "dynamic pull-in");
    EXPECT_TRUE(step_closes(model, 0, 1.001 * dynamically));
    EXPECT_FALSE(step_closes(model, 0, 0.999 * dynamically));
  }
  EXPECT_LT(release_voltage(Switch(ChargedPlate(much_charge).device), 0), 0) << "it stays closed at 0 V";
}

TEST(DielectricCharge, BendsThePlateAtRest) {
  for (const double charge : {1e-2, -1e-2}) {
    const ChargedPlate plate(charge);
    const Switch model(plate.device);
    ASSERT_TRUE(model.rest());
    expect_within(model.contact_deflection(model.rest()->data()), plate.rest(), 1e-9, "rest deflection");
    const std::optional<Eigen::VectorXd> neutral = model.open_equilibrium(std::vector<double>{plate.neutral});
    ASSERT_TRUE(neutral);
    EXPECT_NEAR(model.contact_deflection(neutral->data()), 0, 1e-18) << "no field is left at V0";
  }
}

TEST(DielectricCharge, ClosesTheSwitchByItselfWhereItIsTooMuch) {
  for (const double charge : {1.6e-2, -1.6e-2}) {  // 47.5 V, beyond 46.7 V
    const Switch model(ChargedPlate(charge).device);
    EXPECT_FALSE(model.rest());
    EXPECT_EQ(static_pull_in(model, 0).status, Status::collapsed_at_rest);
    const Trajectory run = simulate_closing(model, std::vector<Signal>{Signal::constant(60)}, {.duration = 40e-6});
    EXPECT_EQ(run.status, Status::collapsed_at_rest);
    EXPECT_TRUE(run.message.ends_with("the charge on a dielectric closes it by itself")) << run.message;
  }
}

TEST(DielectricCharge, ActsAsAShiftOfTheVoltageInAllStatics) {
  Device bare = plate_over_nitride();
  bare.contacts = {Contact{.model = LinearSpring{.stiffness = 100}}};
  bare.gap.contact = 1_um;  // a gap before the fold
  Device charged = bare;
  charged.electrodes[0].dielectric->charge = -much_charge;
  const Switch plain(bare), shifted(charged);
  const double neutral = shifted.neutral_voltage(0);
  ASSERT_GT(neutral, 5);
  expect_within(static_pull_in(shifted, 0).voltage, neutral + std::sqrt(ChargedPlate::balance(1e-6)), 1e-9, "touch");
  const std::optional<StablePath> path = stable_path(shifted, 0);
  ASSERT_TRUE(path);
  expect_within(path->reaches(), neutral + std::sqrt(ChargedPlate::balance(1e-6)), 1e-9, "stable path");
  expect_within(release_voltage(shifted, 0), neutral + release_voltage(plain, 0), 1e-9, "release");
  for (const double level : {50.0, -50.0}) {  // these hold the switch without charge
    const std::vector<double> volts{neutral + level}, without{level};
    const auto closed = closed_equilibrium(shifted, volts), other = closed_equilibrium(plain, without);
    ASSERT_TRUE(closed && other);
    expect_within(closed->contact_force, other->contact_force, 1e-9, "contact force");
    expect_within(pull_through_voltage(shifted, 0, volts), neutral + pull_through_voltage(plain, 0, without), 3e-6,
                  "pull-through");
  }
}

// At a jump a capacitor takes C0 V^2 / 2, and V dQ as the plate moves at constant voltage.
TEST(DielectricCharge, KeepsTheEnergyBalance) {
  for (const double charge : {much_charge, -much_charge}) {
    SCOPED_TRACE(charge);
    const ChargedPlate plate(charge);
    const Switch model(plate.device);
    const double volts = 60, acting = volts - plate.neutral, open = ChargedPlate::capacitance(plate.rest());
    const Trajectory run =
        simulate_closing(model, std::vector<Signal>{Signal::constant(volts)}, {.duration = 40e-6, .tolerance = 1e-10});
    ASSERT_EQ(run.status, Status::done) << run.message;
    ASSERT_FALSE(run.touches.empty());
    EXPECT_LT(run.energy_error, 1e-7 * model.bending_energy());
    ASSERT_EQ(run.points.back().position, plate.device.gap.contact) << "the plate rests on the face";
    const double closed = ChargedPlate::capacitance(ChargedPlate::gap);
    expect_within(run.energy.source_work, open * volts * volts / 2 + volts * acting * (closed - open), 1e-8, "source work");
    // Ramps, jumps, and voltage changes while the plate rests, down to an opening at V0.
    const Signal course = Signal::piecewise_linear(
        {{0, 3}, {2e-6, 70}, {5e-6, 70}, {5e-6, 50}, {35e-6, 50}, {40e-6, 30}, {42e-6, plate.neutral}, {60e-6, plate.neutral}});
    const Trajectory whole = simulate_closing(model, std::vector<Signal>{course}, {.duration = 60e-6, .tolerance = 1e-10});
    ASSERT_EQ(whole.status, Status::done) << whole.message;
    ASSERT_FALSE(whole.touches.empty());
    EXPECT_LT(whole.points.back().position, 0.9 * plate.device.gap.contact) << "it has opened";
    EXPECT_LT(whole.energy_error, 1e-6 * model.bending_energy());
  }
}

// The motion is that of a switch without charge whose voltage is lower by V0 at all times.
TEST(DielectricCharge, MovesABeamAsAShiftedVoltageDoes) {
  Device bare = test::gold_cantilever();
  bare.electrodes[0].dielectric = Dielectric{.thickness = 0.2_um, .permittivity = 7.6};
  Device charged = bare;
  charged.electrodes[0].dielectric->charge = 1e-3;
  const Switch plain(bare), shifted(charged);
  const double neutral = shifted.neutral_voltage(0);
  const auto figures = [](const Switch& model, const Signal& signal) {
    MetricsObserver observer(model.contact_gap());
    const Trajectory run = observe_closing(model, std::vector<Signal>{signal}, {.duration = 60e-6, .tolerance = 1e-10}, observer);
    EXPECT_EQ(run.status, Status::done) << run.message;
    EXPECT_LT(run.energy_error, 1e-6 * model.bending_energy());
    return observer.metrics(run);
  };
  const Metrics own = figures(shifted, Signal::constant(20)), other = figures(plain, Signal::constant(20 - neutral, -neutral));
  expect_within(own.initial_contact_time, other.initial_contact_time, 1e-9, "first touch");
  expect_within(own.impact_velocity, other.impact_velocity, 1e-8, "speed of the first touch");
  expect_within(own.major_bounce_height, other.major_bounce_height, 1e-6, "highest rebound");
  EXPECT_LT(own.initial_contact_time, 0.99 * figures(plain, Signal::constant(20)).initial_contact_time) << "it does something";
}

// Charge and forces are derivatives of the potential.
TEST(DielectricCharge, HasAPotential) {
  Device device = test::gold_cantilever();
  device.gas.reset();
  device.electrodes[0].dielectric = Dielectric{.thickness = 0.2_um, .permittivity = 7.6, .charge = -3e-3};
  const Switch model(device);
  Switch::Workspace work = model.workspace();
  const Eigen::VectorXd at = model.basis().contact_shape().cwiseQuotient(model.basis().squares());
  const Eigen::VectorXd q = at * (1e-6 / model.basis().contact_shape().dot(at)), still = Eigen::VectorXd::Zero(4);
  constexpr double agreement = 1e-7;
  for (const double volts : {0.0, 12.0, -30.0}) {
    const auto potential = [&](double v, const Eigen::VectorXd& where) {
      return model.potential(where.data(), std::vector<double>{v}, false, work);
    };
    constexpr double step = 1e-3;
    expect_within(model.charge(0, volts, q.data(), work), -(potential(volts + step, q) - potential(volts - step, q)) / (2 * step),
                  agreement, "charge");
    Eigen::VectorXd force(4);
    model.accelerations(q.data(), still.data(), std::vector<double>{volts}, false, work, force.data());
    const double largest = force.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < 4; ++i) {
      Eigen::VectorXd above = q, below = q;
      const double moved = 1e-4 * q.cwiseAbs().maxCoeff();
      above[i] += moved, below[i] -= moved;
      EXPECT_NEAR(force[i], -(potential(volts, above) - potential(volts, below)) / (2 * moved), 1e-6 * largest) << i;
    }
  }
}

TEST(Dielectric, RefusesWhatItCannotMean) {
  const auto refused = [](auto change, const std::string& message) {
    Device device = plate_over_nitride();
    change(device);
    test::expect_refused([&] { validate(device); }, message);
  };
  refused([](Device& d) { d.electrodes[0].dielectric->thickness = 0; },
          "electrode.main.dielectric.thickness = 0 m: must be greater than 0 and below 1e30");
  refused([](Device& d) { d.electrodes[0].dielectric->permittivity = 0.5; },
          "electrode.main.dielectric.permittivity = 0.5: must be from 1 to 1000000");
  refused([](Device& d) { d.electrodes[0].dielectric->roughness = -1e-9; },
          "electrode.main.dielectric.roughness = -1 nm: must not be negative");
  refused([](Device& d) { d.electrodes[0].dielectric->charge = -2e6; },
          "electrode.main.dielectric.charge = -2 MC/m^2: must be between -1 and 1 MC/m^2");
  refused([](Device& d) { d.electrodes[0].dielectric->charge = std::numeric_limits<double>::quiet_NaN(); },
          "electrode.main.dielectric.charge = nan C/m^2: must be between -1 and 1 MC/m^2");
  refused([](Device& d) { d.electrodes[0].dielectric.reset(); },
          "gap.contact = 4 um: must be less than 0.99 times gap.electrode, unless every near electrode has a dielectric");
  refused([](Device& d) { d.gap.contact = 4.1e-6; }, "gap.contact = 4.1 um: must be positive and below gap.electrode = 4 um");
  refused(
      [](Device& d) {
        d.electrodes[0].side = Side::both;
        d.electrodes[0].gap = 4e-6;
      },
      "electrode.main.dielectric: belongs to an electrode on the near side alone");
  Device beam = test::gold_cantilever();
  beam.electrodes[0].dielectric = Dielectric{.thickness = 0.2_um, .permittivity = 7.6};
  beam.gap.contact = beam.gap.electrode;
  test::expect_refused(
      [&] { validate(beam); },
      "gap.contact = 3.5 um: must be less than 0.99 times gap.electrode, unless the dielectric of the electrodes has a "
      "landing");
}

}  // namespace
}  // namespace softland
