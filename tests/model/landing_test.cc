// Landing of a beam along the face of the dielectric on its electrode.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "model/closing.h"
#include "model/constants.h"
#include "model/contact/face.h"
#include "model/linearized_closing.h"
#include "model/pull_in.h"
#include "objectives/metrics.h"
#include "tests/model/expect_refused.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

constexpr double depth_of_nitride = 0.2_um / 7;

// An aluminium bridge of 280 um under 20 MPa, over 3 um of air and 0.2 um of nitride.
Device capacitive_bridge(Landing landing = {.stiffness = 1e15, .from = 30_nm}) {
  return {.structure = {.length = 280_um,
                        .width = 120_um,
                        .thickness = 0.5_um,
                        .modes = 8,
                        .kind = Bridge{{.youngs_modulus = 70e9, .density = 2700}, 20e6}},
          .gap = {.electrode = 3_um, .contact = 3_um},
          .electrodes = {{.name = "main",
                          .begin = 90_um,
                          .end = 190_um,
                          .fringing = Fringing::none,
                          .dielectric = Dielectric{.thickness = 0.2_um, .permittivity = 7, .landing = landing}}}};
}

// Summits with a height equal to the layer of air that they keep between bridge and dielectric.
constexpr UniformAsperities summits_of_nitride{.summits = {.radius = 100_nm, .density = 1e12, .effective_modulus = 48e9},
                                               .height = 30_nm};
constexpr Landing rough{.asperities = summits_of_nitride};

// Returns their pressure as a sum over a thousand equally probable heights.
double pressure_of_summits(const UniformAsperities& face, double depth) {
  constexpr int heights = 1000;
  double sum = 0;
  for (int k = 0; k < heights; ++k) {
    const double lower = face.height * (k + 0.5) / heights;  // depth below the highest summit
    if (depth > lower) sum += std::pow(depth - lower, 1.5) / heights;
  }
  const Summits& all = face.summits;
  return all.density * 4.0 / 3 * all.effective_modulus * std::sqrt(all.radius) * sum;
}

Switch fine(const Device& device, int modes) { return Switch(device, {.points_per_length = 400, .modes = modes}); }

void expect_share(double value, double kept, double relative, const std::string& what) {
  EXPECT_NEAR(value, kept, relative * std::abs(kept)) << what;
}

// Values of an independent program with 168 and 336 finite elements. Twenty symmetric modes cannot describe the corner of the
// shear force at the edge of the contact, and differ by up to 0.8 % in capacitance and 1.3 % in force.
TEST(Landing, ABridgeClosesAsFiniteElementsDo) {
  const Switch model = fine(capacitive_bridge(), 40);
  expect_share(model.basis().angular_frequencies()[0] / (2 * pi), 164430.31735, 1e-6, "first frequency");
  const StaticPullIn fold = static_pull_in(model, 0);
  ASSERT_EQ(fold.kind, StaticKind::fold);
  expect_share(fold.voltage, 46.38412, 1e-4, "static pull-in");
  Switch::Workspace work = model.workspace();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.modes());
  expect_share(model.capacitance(0, rest.data(), work), 3.508263095637736e-14, 1e-8, "open capacitance");
  expect_share(release_voltage(model, 0), 7.23182, 1.5e-3, "release");
  struct Kept {
    double voltage, capacitance, force;
  };
  for (const Kept& kept :
       {Kept{12, 1.352477534297477e-12, 0.0013525775068787263}, Kept{15, 1.6666464763086419e-12, 0.002901418101712722},
        Kept{20, 1.7908186349795979e-12, 0.005885374488916186}, Kept{30, 1.8445286494032567e-12, 0.014219900311964365},
        Kept{40, 1.8833764017721314e-12, 0.026510471730391966}, Kept{50, 1.9344013724711613e-12, 0.043823411473898545}}) {
    const std::vector<double> volts{kept.voltage};
    const std::optional<ClosedEquilibrium> closed = closed_equilibrium(model, volts);
    ASSERT_TRUE(closed) << kept.voltage;
    const std::string at = " at " + std::to_string(kept.voltage);
    expect_share(model.capacitance(0, closed->q.data(), work), kept.capacitance, 8e-3, "capacitance" + at);
    expect_share(closed->contact_force, kept.force, 1.3e-2, "force" + at);
    EXPECT_GT(closed->smallest_eigenvalue, 0) << at;
  }
}

// Expected values have as many symmetric modes; half of the modes here are antisymmetric.
TEST(Landing, TouchesAndReleasesAsOtherModesDo) {
  struct Kept {
    int modes;
    double touch_voltage, time, velocity;
  };
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const Kept& kept :
       {Kept{8, 6.59556, 2.578983857659438e-06, 13.04662255402393}, Kept{16, 7.04596, 2.57452239539482e-06, 15.00120323311928},
        Kept{24, 7.1757, none, none}, Kept{40, 7.22587, none, none}}) {
    const Switch model = fine(capacitive_bridge(), kept.modes);
    expect_share(release_voltage(model, 0), kept.touch_voltage, 2e-5, std::to_string(kept.modes) + " modes: touch voltage");
    if (std::isnan(kept.time)) continue;
    MetricsObserver figures(model.contact_gap());
    const Trajectory run = observe_closing(model, std::vector<Signal>{Signal::constant(55)},
                                           {.duration = 4e-6, .tolerance = 1e-9, .after_contact = 0}, figures);
    ASSERT_EQ(run.status, Status::done) << run.message;
    const Metrics m = figures.metrics(run);
    expect_share(m.initial_contact_time, kept.time, 1e-5, std::to_string(kept.modes) + " modes: first touch");
    expect_share(m.impact_velocity, kept.velocity, 1e-4, std::to_string(kept.modes) + " modes: impact velocity");
    EXPECT_LT(run.energy_error, 1e-3 * model.bending_energy());
  }
}

// At any voltage the gap under a wall is at least a small part of the gap that the dielectric adds, and the capacitance of the
// part in contact is that of the dielectric.
TEST(Landing, AWallLetsNothingThrough) {
  const Device device = capacitive_bridge({});
  const Switch model = fine(device, 16);
  Switch::Workspace work = model.workspace();
  const double most = vacuum_permittivity * 120_um * 100_um / depth_of_nitride;
  double last = 0;
  for (const double voltage : {12.0, 20.0, 55.0, 90.0}) {
    const std::vector<double> volts{voltage};
    const std::optional<ClosedEquilibrium> closed = closed_equilibrium(model, volts);
    ASSERT_TRUE(closed) << voltage;
    const double capacitance = model.capacitance(0, closed->q.data(), work);
    EXPECT_GT(Switch::smallest_gap(work), -depth_of_nitride / 20) << voltage;
    EXPECT_GT(capacitance, last) << "more of it lies on the face";
    EXPECT_LT(capacitance, 1.05 * most);
    last = capacitance;
  }
  EXPECT_GT(last, 0.98 * most);
  EXPECT_GT(std::get<LinearSpring>(model.device().contacts.front().model).stiffness, least_face_stiffness(90, depth_of_nitride));
}

// A soft face collapses under the field at the voltage of plates on springs of the same length, or slightly below: a beam
// presses hardest at the edge of its contact.
TEST(Landing, AFieldPullsTheBeamThroughASoftFace) {
  for (const double from : {0.0, 30e-9}) {
    const Device device = capacitive_bridge({.stiffness = 1e15, .from = from});
    const Switch model = fine(device, 8);
    const double most = std::sqrt(1e15 / least_face_stiffness(1, depth_of_nitride + from));
    EXPECT_TRUE(closed_equilibrium(model, std::vector<double>{0.85 * most})) << from;
    EXPECT_FALSE(closed_equilibrium(model, std::vector<double>{1.05 * most})) << from;
  }
}

// Plates on asperities whose springs are unloaded at the highest summit: the highest voltage that holds them is also found by a
// scan over all depths.
TEST(Landing, AFieldPullsTheBeamThroughSoftAsperities) {
  for (const double depth : {10e-9, 40e-9, 400e-9}) {
    const double bed = most_face_voltage(LinearContact{.stiffness = 1e15}, depth);
    expect_share(least_face_stiffness(bed, depth), 1e15, 1e-9, "a linear bed");
    const double height = summits_of_nitride.height;
    const UniformAsperityContact pressure = uniform_contact(summits_of_nitride.summits, height, {.width = 1, .length = 1});
    double largest = 0;
    constexpr int looks = 2000;
    for (int k = 1; k < looks; ++k) {
      const double sunk = depth * k / looks;
      largest = std::max(largest, pressure_of_summits(summits_of_nitride, sunk) * std::pow(depth - sunk, 2));
    }
    expect_share(most_face_voltage(pressure, depth), std::sqrt(2 * largest / vacuum_permittivity), 1e-4, "asperities");
    if (depth * 5 / 9 > height) continue;
    const double sunk = depth * 5 / 9, square = 2 * pressure.force(sunk) * std::pow(depth - sunk, 2) / vacuum_permittivity;
    expect_share(most_face_voltage(pressure, depth), std::sqrt(square), 1e-12, "where not all of them touch");
  }
  const Switch model = fine(capacitive_bridge(rough), 8);
  const double most = most_face_voltage(uniform_contact(summits_of_nitride.summits, summits_of_nitride.height, {1, 1}),
                                        depth_of_nitride + summits_of_nitride.height);
  EXPECT_TRUE(closed_equilibrium(model, std::vector<double>{0.85 * most}));
  EXPECT_FALSE(closed_equilibrium(model, std::vector<double>{1.05 * most}));
}

// At every point of the beam the face carries the sum over its summits, and the beam touches it at the highest one.
TEST(Landing, AsperitiesPressAsTheirSummitsDo) {
  const Switch model = fine(capacitive_bridge(rough), 16);
  EXPECT_DOUBLE_EQ(model.contact_gap(), 2.97_um);
  const PointQuadrature& points = model.quadrature();
  for (const double voltage : {20.0, 60.0}) {
    const std::optional<ClosedEquilibrium> closed = closed_equilibrium(model, std::vector<double>{voltage});
    ASSERT_TRUE(closed) << voltage;
    double force = 0;
    for (Eigen::Index k = 0; k < points.points(); ++k) {
      const double depth = points.shapes().row(k).dot(closed->q) - 2.97_um;
      const bool is_over = points.positions()[k] > 90_um && points.positions()[k] < 190_um;
      if (is_over && depth > 0) force += points.weights()[k] * 120_um * pressure_of_summits(summits_of_nitride, depth);
    }
    EXPECT_GT(force, 0);
    expect_share(closed->contact_force, force, 1e-5, "force at " + std::to_string(voltage));
  }
}

// An undamped bridge lands on stiff asperities and rebounds: the work of the source is stored in the beam, its motion and the
// summits.
TEST(Landing, ABridgeOnAsperitiesKeepsItsEnergy) {
  Device device = capacitive_bridge(rough);
  Electrode& wide = device.electrodes.front();
  wide.begin = 2_um, wide.end = 278_um;
  wide.dielectric->landing->asperities->summits.density = 1e13;
  const Switch model = fine(device, 6);
  const std::vector<Signal> signals{Signal::constant(1.05 * static_pull_in(model, 0).voltage)};
  const auto run_until = [&](double after_contact) {
    MetricsObserver figures(model.contact_gap());
    const Trajectory run =
        observe_closing(model, signals, {.duration = 5e-6, .tolerance = 1e-9, .after_contact = after_contact}, figures);
    EXPECT_EQ(run.status, Status::done) << run.message;
    EXPECT_LT(run.energy_error, 1e-5 * model.bending_energy()) << after_contact;
    return figures.metrics(run);
  };
  run_until(5e-9);  // the bridge moves down
  EXPECT_GT(run_until(1).impact_energy, model.bending_energy()) << "the summits stored it";
}

// After a hard landing the bridge may move below the level of the face beside its electrode, where there is no face.
TEST(Landing, ABridgeMaySwingLowerBesideItsElectrode) {
  const Switch model = fine(capacitive_bridge({.stiffness = 1e18}), 6);
  const Trajectory run = simulate_closing(model, std::vector{Signal::constant(48)}, {.duration = 20e-6, .tolerance = 1e-9});
  EXPECT_EQ(run.status, Status::done) << run.message;
  EXPECT_LT(run.smallest_gap, model.gap_floor());
  EXPECT_LT(run.energy_error, 1e-4 * model.bending_energy());
}

// A plate lands with its whole area at once, as on a [contact] of that area.
TEST(Landing, APlateOnAsperitiesClosesAsOnAContactOfThem) {
  constexpr double height = 100_nm;
  const UniformAsperities asperities{.summits = {.radius = 100_nm, .density = 1e12, .effective_modulus = 48e9}, .height = height};
  Device face = {.structure = {.length = 100_um, .width = 100_um, .kind = Plate{.mass = 1e-10, .stiffness = 10}},
                 .gap = {.electrode = 4_um, .contact = 4_um - height},
                 .electrodes = {{.name = "main",
                                 .begin = 0,
                                 .end = 80_um,
                                 .fringing = Fringing::none,
                                 .dielectric = Dielectric{
                                     .thickness = 0.2_um, .permittivity = 7.6, .landing = Landing{.asperities = asperities}}}}};
  Device contact = face;
  contact.electrodes.front().dielectric->landing.reset();
  contact.contacts = {{.model = asperities, .pad_length = 40_um, .pad_width = 200_um}};
  const Switch on_face(face), on_contact(contact);
  expect_share(on_face.penetration_scale(), on_contact.penetration_scale(), 1e-9, "penetration");
  expect_share(static_pull_in(on_face, 0).voltage, static_pull_in(on_contact, 0).voltage, 1e-12, "static pull-in");
  expect_share(release_voltage(on_face, 0), release_voltage(on_contact, 0), 1e-7, "release");
  Switch::Workspace one = on_face.workspace(), other = on_contact.workspace();
  for (const double voltage : {15.0, 60.0, 90.0}) {
    const std::vector<double> volts{voltage};
    const auto down = closed_equilibrium(on_face, volts), expected = closed_equilibrium(on_contact, volts);
    ASSERT_TRUE(down && expected) << voltage;
    const std::string at = " at " + std::to_string(voltage);
    expect_share(down->q[0], expected->q[0], 1e-9, "deflection" + at);
    expect_share(down->contact_force, expected->contact_force, 1e-7, "force" + at);
    expect_share(down->potential, expected->potential, 1e-9, "potential" + at);
    expect_share(down->smallest_eigenvalue, expected->smallest_eigenvalue, 1e-7, "tangent" + at);
    expect_share(on_face.capacitance(0, down->q.data(), one), on_contact.capacitance(0, expected->q.data(), other), 1e-9,
                 "capacitance" + at);
  }
  const auto figures_of = [](const Switch& model) {
    MetricsObserver figures(model.contact_gap());
    const Trajectory run =
        observe_closing(model, std::vector<Signal>{Signal::constant(60)}, {.duration = 40e-6, .tolerance = 1e-10}, figures);
    EXPECT_EQ(run.status, Status::done) << run.message;
    EXPECT_LT(run.energy_error, 1e-6 * model.bending_energy());
    EXPECT_GT(run.smallest_gap, 40_nm) << "where the field of the contact's device is continued";
    return figures.metrics(run);
  };
  const Metrics landed = figures_of(on_face), expected = figures_of(on_contact);
  expect_share(landed.initial_contact_time, expected.initial_contact_time, 1e-9, "first touch");
  expect_share(landed.impact_velocity, expected.impact_velocity, 1e-9, "impact velocity");
  expect_share(landed.major_bounce_height, expected.major_bounce_height, 1e-7, "highest rebound");
  expect_share(landed.peak_contact_force, expected.peak_contact_force, 1e-6, "largest force, told from three points of a step");
}

// A plate lands with its whole area at once, so that a wall acts as a rigid stop.
TEST(Landing, APlateOnAWallClosesAsOnAStop) {
  Device device = {.structure = {.length = 100_um, .width = 100_um, .kind = Plate{.mass = 1e-10, .stiffness = 10}},
                   .gap = {.electrode = 4_um, .contact = 4_um},
                   .electrodes = {{.name = "main",
                                   .begin = 0,
                                   .end = 100_um,
                                   .fringing = Fringing::none,
                                   .dielectric = Dielectric{.thickness = 0.2_um, .permittivity = 7.6, .landing = Landing{}}}}};
  const Switch model(device);
  expect_share(static_pull_in(model, 0).voltage, 46.73588788239068, 1e-8, "static pull-in");
  expect_share(release_voltage(model, 0), 0.7910192125773502, 1e-8, "release");
  MetricsObserver figures(model.contact_gap());
  const Trajectory run = observe_closing(model, std::vector<Signal>{Signal::constant(1.2 * 46.73588788239068)},
                                         {.duration = 40e-6, .tolerance = 1e-10}, figures);
  ASSERT_EQ(run.status, Status::done) << run.message;
  const Metrics m = figures.metrics(run);
  expect_share(m.initial_contact_time, 9.364403257595555e-06, 1e-7, "first touch");
  expect_share(m.impact_velocity, 10.175222744232038, 1e-7, "impact velocity");
  EXPECT_GT(run.smallest_gap, -0.2_um / 7.6);
  EXPECT_LT(run.energy_error, 1e-4 * model.bending_energy());
}

// A dimple of the bridge, beside its electrode.
Device with_dimple(Device device, double gap, Place at = 70_um) {
  device.contacts = {{.model = LinearSpring{.stiffness = 1e3}, .pad_length = 2_um, .name = "dimple", .at = at, .gap = gap}};
  device.gap.contact = gap;
  return device;
}

// Forces are the derivative of the energy, and the Jacobian is that of the forces, also while a part of the beam is on the
// face.
TEST(Landing, ForcesAreTheSlopeOfTheEnergy) {
  const Landing wall, bed{.stiffness = 3e15, .from = 20_nm};
  for (const Device& device :
       {capacitive_bridge(wall), capacitive_bridge(bed), capacitive_bridge(rough), with_dimple(capacitive_bridge(bed), 1.5_um)}) {
    const Switch model = fine(device, 4);
    Switch::Workspace work = model.workspace();
    const std::vector<double> volts{25};
    const Eigen::Index n = model.modes();
    const std::optional<ClosedEquilibrium> closed = closed_equilibrium(model, volts);
    ASSERT_TRUE(closed);
    Eigen::VectorXd q = 1.002 * closed->q, force(n), above(n), below(n);
    q[2] += 1e-3 * q[0];
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd by_q(n, n), by_v(n, n);
    model.accelerations(q.data(), still.data(), volts, true, work, force.data());
    model.jacobian(q.data(), still.data(), volts, true, work, by_q, by_v);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::VectorXd step = 1e-8 * q.norm() * Eigen::VectorXd::Unit(n, i);
      const double up = model.potential((q + step).eval().data(), volts, true, work),
                   down = model.potential((q - step).eval().data(), volts, true, work);
      EXPECT_NEAR(-(up - down) / (2 * step[i]), force[i], 1e-5 * force.norm()) << i;
      model.accelerations((q + step).eval().data(), still.data(), volts, true, work, above.data());
      model.accelerations((q - step).eval().data(), still.data(), volts, true, work, below.data());
      EXPECT_LT(((above - below) / (2 * step[i]) - by_q.col(i)).norm(), 1e-4 * by_q.norm()) << i;
    }
    EXPECT_LT(by_v.norm(), 1e-9 * by_q.norm());
  }
}

// Records the first touch of the connection and of each contact, with the impact velocity.
class FirstTouches final : public ClosingObserver {
 public:
  void knot(const TrajectoryPoint&) override {}
  void touch(const Touch& touch) override {
    if (!first) first = touch;
  }
  ClosingObserver* contact(std::size_t c) override { return &of_contacts.at(c); }

  struct OfOne final : public ClosingObserver {
    void knot(const TrajectoryPoint&) override {}
    void touch(const Touch& touch) override {
      if (!first) first = touch;
    }
    std::optional<Touch> first;
  };
  std::optional<Touch> first;
  std::vector<OfOne> of_contacts{2};
};

constexpr double volts_of_bridge = 55;

Trajectory observed(const Device& device, ClosingObserver& observer, double duration) {
  return observe_closing(fine(device, 6), std::vector<Signal>{Signal::constant(volts_of_bridge)},
                         {.duration = duration, .tolerance = 1e-9}, observer);
}

// The dimple is the connection and holds the bridge high above the face: the closing is that of a bridge without a face.
TEST(LandingBesideContacts, AFaceOutOfReachDoesNothing) {
  const Device device = with_dimple(capacitive_bridge(), 0.5_um, 140_um);
  Device without = device;
  without.electrodes.front().dielectric->landing.reset();
  without.contacts.front().gap = std::numeric_limits<double>::quiet_NaN();
  FirstTouches one, other;
  const Trajectory landing = observed(device, one, 3e-6), straight = observed(without, other, 3e-6);
  ASSERT_EQ(landing.status, Status::done) << landing.message;
  ASSERT_TRUE(one.first && other.first && one.of_contacts[0].first);
  EXPECT_NEAR(one.first->begin, other.first->begin, 1e-9 * other.first->begin);
  EXPECT_NEAR(one.first->impact_velocity, other.first->impact_velocity, 1e-7 * other.first->impact_velocity);
  EXPECT_EQ(one.first->begin, one.of_contacts[0].first->begin);
  EXPECT_FALSE(one.of_contacts[1].first);
  ASSERT_EQ(landing.contacts.size(), 2U);
  EXPECT_EQ(landing.contacts[1].name, face_name);
}

// The bridge touches the face before its dimple: the face acts as without a dimple, and makes no connection.
TEST(LandingBesideContacts, TheFaceMakesNoConnection) {
  const Device alone = capacitive_bridge(Landing{}), device = with_dimple(alone, 2.96_um);
  FirstTouches one, other;
  const Trajectory landing = observed(device, one, 2.6e-6), straight = observed(alone, other, 2.6e-6);
  ASSERT_EQ(landing.status, Status::done) << landing.message;
  ASSERT_TRUE(other.first && one.of_contacts[1].first);
  EXPECT_FALSE(one.first);
  EXPECT_NEAR(one.of_contacts[1].first->begin, other.first->begin, 1e-7 * other.first->begin);
  EXPECT_NEAR(one.of_contacts[1].first->impact_velocity, other.first->impact_velocity, 1e-4 * other.first->impact_velocity);
}

// An undamped plate lands on a dimple and a face. At the face, the work of the source is in the springs and the motion.
TEST(LandingBesideContacts, APlateKeepsItsEnergy) {
  constexpr double mass = 1e-10, stiffness = 10, dimple = 200, gap = 4_um, dimple_gap = 3_um, volts = 60;
  constexpr double area = 100_um * 100_um, depth = 0.2_um / 7.6, bed = 1e17;
  const Device device = {
      .structure = {.length = 100_um, .width = 100_um, .kind = Plate{.mass = mass, .stiffness = stiffness}},
      .gap = {.electrode = gap, .contact = dimple_gap},
      .electrodes = {{.name = "main",
                      .begin = 0,
                      .end = 100_um,
                      .fringing = Fringing::none,
                      .dielectric = Dielectric{.thickness = 0.2_um, .permittivity = 7.6, .landing = Landing{.stiffness = bed}}}},
      .contacts = {{.model = LinearSpring{.stiffness = dimple}, .name = "dimple", .gap = dimple_gap}}};
  const Switch model(device);
  FirstTouches touches;
  const Trajectory run =
      observe_closing(model, std::vector<Signal>{Signal::constant(volts)}, {.duration = 12e-6, .tolerance = 1e-10}, touches);
  ASSERT_EQ(run.status, Status::done) << run.message;
  EXPECT_LT(run.energy_error, 1e-6 * model.bending_energy());
  const auto field = [&](double y) { return vacuum_permittivity * area * volts * volts / (2 * (gap - y + depth)); };
  const auto speed_at = [&](double y) {
    const double pressed = std::max(0.0, y - dimple_gap);
    return std::sqrt(2 / mass * (field(y) - field(0) - stiffness * y * y / 2 - dimple * pressed * pressed / 2));
  };
  ASSERT_TRUE(touches.of_contacts[0].first && touches.of_contacts[1].first);
  EXPECT_NEAR(touches.of_contacts[0].first->impact_velocity, speed_at(dimple_gap), 1e-7 * speed_at(dimple_gap));
  EXPECT_NEAR(touches.of_contacts[1].first->impact_velocity, speed_at(gap), 1e-7 * speed_at(gap));

  // In equilibrium the field balances all three springs.
  const std::optional<ClosedEquilibrium> closed = closed_equilibrium(model, std::vector<double>{volts});
  ASSERT_TRUE(closed);
  const double y = model.contact_deflection(closed->q.data());
  const double push = dimple * (y - dimple_gap), face = area * bed * (y - gap);
  ASSERT_GT(face, 0);
  EXPECT_NEAR(field(y) / (gap - y + depth), stiffness * y + push + face, 1e-9 * face);
  EXPECT_NEAR(closed->contact_force, push, 1e-9 * push);
}

TEST(Landing, HasNoDerivatives) {
  EXPECT_EQ(LinearizedClosing::refusal(fine(capacitive_bridge({}), 4)),
            "a landing along the face of a dielectric has no derivatives here");
}

TEST(Landing, TouchesFirstWhereItBendsMost) {
  const auto place = [](Device device) {
    set_face_contact(device);
    EXPECT_TRUE(device.closes_along_face());
    return device.contact_position();
  };
  EXPECT_DOUBLE_EQ(place(capacitive_bridge()), 140_um);
  Device aside = capacitive_bridge();
  aside.electrodes.front().end = 120_um;
  EXPECT_DOUBLE_EQ(place(aside), 120_um);
  Device cantilever = capacitive_bridge();
  cantilever.structure.kind = Cantilever{{.youngs_modulus = 70e9, .density = 2700}};
  EXPECT_DOUBLE_EQ(place(cantilever), 190_um);
}

TEST(Landing, RefusesWhatItCannotMean) {
  const auto refused = [](auto change, const std::string& message) {
    Device device = capacitive_bridge();
    change(device);
    expect_refused([&] { Switch{device}; }, message);
  };
  const auto landing = [](Device& d) -> Landing& { return *d.electrodes.front().dielectric->landing; };
  refused([&](Device& d) { landing(d).stiffness = -1; },
          "electrode.main.dielectric.landing.stiffness = -1 Pa/m: must be greater than 0 and below 1e30");
  refused([&](Device& d) { landing(d).from = -1e-9; },
          "electrode.main.dielectric.landing.from = -1 nm: must be from 0 m to below gap.electrode");
  refused([&](Device& d) { landing(d) = {.from = 1_nm}; },
          "electrode.main.dielectric.landing.from: must be 0 m without landing.stiffness: the face is then a wall");
  const auto asperities = [&](Device& d) -> UniformAsperities& { return *(landing(d) = rough).asperities; };
  refused([&](Device& d) { asperities(d).summits.radius = 0; },
          "electrode.main.dielectric.landing.asperity_radius = 0 m: must be greater than 0 and below 1e30");
  refused([&](Device& d) { asperities(d).height = 3_um; },
          "electrode.main.dielectric.landing.asperity_height = 3 um: must be below gap.electrode");
  const std::string no_bed =
      "electrode.main.dielectric.landing.asperity_height: must not be given with a stiffness, a height `from` or damping";
  refused([&](Device& d) { asperities(d).damping = 1; }, no_bed);
  refused([&](Device& d) { asperities(d), landing(d).from = 1_nm; }, no_bed);
  refused([&](Device& d) { asperities(d), landing(d).stiffness = 1e15; }, no_bed);
  refused(
      [&](Device& d) {
        asperities(d);
        d.electrodes.push_back(d.electrodes.front());
        d.electrodes.back().name = "other";
        d.electrodes.back().begin = 200_um;
        d.electrodes.back().end = 250_um;
        d.electrodes.back().dielectric->landing->asperities->summits.density = 2e12;
      },
      std::string("gap.contact = 2.97 um: ") + unequal_landings);
  refused([](Device& d) { d.dispersion = Dispersion{}; },
          "gap.contact = 2.97 um: a beam that lands on a dielectric takes no dispersion force");
  refused(
      [](Device& d) {
        d.electrodes.push_back(d.electrodes.front());
        d.electrodes.back().name = "other";
        d.electrodes.back().begin = 200_um;
        d.electrodes.back().end = 250_um;
        d.electrodes.back().dielectric.reset();
      },
      std::string("gap.contact = 2.97 um: ") + unequal_landings);
}

}  // namespace
}  // namespace softland
