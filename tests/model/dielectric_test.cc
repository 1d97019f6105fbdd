// A dielectric on the electrode: a plate that lands on it, by closed forms, and a beam over it beside one over a deeper
// electrode.
#include <gtest/gtest.h>

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

// Values of ../shared by closed forms and quadrature: the plate under sqrt(8 K D^3 / (27 eps0 A)), D = 4 um + t / eps.
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

// Where the beam does not land on it, a dielectric is a metal that lies deeper by t / eps.
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

// A beam that is pulled onto it ends its run, and says so.
TEST(Dielectric, ABeamThatReachesItEndsItsRun) {
  Device coated = test::gold_cantilever();
  coated.electrodes[0].dielectric = Dielectric{.thickness = 0.2_um, .permittivity = 7.6};
  const Switch model(coated);
  MetricsObserver figures(model.contact_gap());
  const Trajectory run = observe_closing(model, std::vector<Signal>{Signal::constant(80)}, {.duration = 60e-6}, figures);
  EXPECT_EQ(run.status, Status::collapsed_onto_electrode);
  EXPECT_TRUE(run.message.ends_with("the beam came within 35 nm of the dielectric on the electrode")) << run.message;
}

// A contact that is too soft for the field at the face lets the plate sink in.
TEST(Dielectric, APlateOnASoftContactSinksIn) {
  Device soft = plate_over_nitride();
  soft.contacts = {Contact{.model = LinearSpring{.stiffness = 100}}};
  const Switch model(soft);
  MetricsObserver figures(model.contact_gap());
  const Trajectory run = observe_closing(model, std::vector<Signal>{Signal::constant(56)}, {.duration = 40e-6}, figures);
  EXPECT_EQ(run.status, Status::collapsed_onto_electrode);
  EXPECT_TRUE(run.message.ends_with("the plate sank 13.16 nm into the dielectric on the electrode")) << run.message;
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
