// The composed switch: exact Jacobian, potential and dissipation of any combination of effects, in one generic test.
#include "model/switch.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "base/literals.h"
#include "model/constants.h"
#include "model/forces/electrostatic.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

struct Combination {
  std::string name;
  Device device;
};

std::vector<Combination> combinations() {
  std::vector<Combination> all;
  for (const FringingRow& fringing : fringing_laws) {
    for (const bool layer : {false, true}) {
      for (const bool gas : {false, true}) {
        for (const double damping : {0.0, 0.03}) {
          for (const Contact& contact : test::contacts()) {
            Device d = layer ? test::gold_pzt_cantilever() : test::gold_cantilever();
            d.electrodes[0].fringing = fringing.value;
            d.structure.damping_ratio = damping;
            if (!gas) d.gas.reset();
            d.contacts = {contact};
            if (double* const corners = number_of(d.contacts.front().model, "asperity_distance"))
              *corners = 60_nm;  // outside of the tested states
            all.push_back({fmt::format("fringing {}, piezo {}, gas {}, damping {}, contact {}", fringing.name, layer, gas,
                                       damping, test::described(contact)),
                           d});
          }
        }
      }
    }
  }
  for (const Gas& gas : test::gases()) {
    if (is_compressible(gas)) continue;  // it has further states: reynolds_film_test.cc
    for (const bool layer : {false, true}) {
      Device d = layer ? test::gold_pzt_cantilever() : test::gold_cantilever();
      d.gas = gas;
      all.push_back({fmt::format("gas {}, piezo {}", name_of(gas), layer), d});
    }
  }
  Device two = test::gold_cantilever();  // two adjacent electrodes
  two.electrodes[0].end = 150_um;
  two.electrodes.push_back({.name = "second", .begin = 150_um, .end = 250_um, .fringing = Fringing::linear});
  all.push_back({"two electrodes", two});
  Device pads = test::gold_cantilever();  // one electrode of several pads
  pads.electrodes[0].end = 100_um;
  pads.electrodes[0].further = {{.begin = 130_um, .end = 180_um}, {.begin = 200_um, .end = 250_um}};
  all.push_back({"three pads", pads});
  for (const bool gas : {false, true}) {
    for (const bool stretching : {false, true}) {
      for (const double stress : {-1e6, 0.0, 20e6}) {
        Device bridge = test::gold_bridge();
        part_of<Bridge>(bridge.structure).stretches = stretching;
        part_of<Bridge>(bridge.structure).residual_stress = stress;
        if (!gas) bridge.gas.reset();
        all.push_back({fmt::format("bridge, gas {}, stretching {}, stress {}", gas, stretching, stress), bridge});
      }
    }
  }
  for (const bool gas : {false, true}) {
    for (const double damping : {0.0, 0.03}) {
      Device plate = test::full_plate();
      plate.structure.damping_ratio = damping;
      if (!gas) plate.gas.reset();
      all.push_back({fmt::format("plate, gas {}, damping {}", gas, damping), plate});
    }
  }
  Device skinned = test::nano_cantilever();
  skinned.surface = Surface{.elastic_modulus = -10, .residual_stress = 0.6, .cantilever_load = ResidualLoad::compression};
  all.push_back({"surface", skinned});
  Device pulled = test::full_plate();
  pulled.dispersion =
      Dispersion{.model = DispersionModel::van_der_waals, .hamaker_constant = 1e-12};  // comparable with its springs
  all.push_back({"plate, dispersion", pulled});
  for (const DispersionModel model : {DispersionModel::casimir, DispersionModel::van_der_waals, DispersionModel::automatic}) {
    for (const Conductor conductor : {Conductor::ideal, Conductor::gold}) {
      for (const bool layer : {false, true}) {
        Device d = test::nano_cantilever();
        d.dispersion->model = model;
        d.dispersion->conductor = conductor;
        if (layer) {
          d.piezo = Piezo{.begin = 20_nm,
                          .end = 270_nm,
                          .thickness = 5_nm,
                          .youngs_modulus = 60_GPa,
                          .density = 7500_kg_m3,
                          .d31 = -100_pm_V};
        }
        all.push_back(
            {fmt::format("dispersion {}, conductor {}, piezo {}", static_cast<int>(model), static_cast<int>(conductor), layer),
             d});
      }
    }
  }
  all.push_back({"plate between electrodes", test::plate_between_electrodes()});
  all.push_back({"cantilever between electrodes", test::cantilever_between_electrodes()});
  return all;
}

/// Random coordinates whose deflection stays well inside the electrode gap. The tip is before the contact plane, or so deep in
/// the contact that the law is smooth. Velocities are as in a closing.
struct State {
  Eigen::VectorXd q, v;
  std::vector<double> volts;
};

State random_state(const Switch& device, bool in_contact, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Eigen::Index n = device.modes();
  const double plane = device.device().gap.contact;
  State s{Eigen::VectorXd(n), Eigen::VectorXd(n), {}};
  for (Eigen::Index i = 0; i < n; ++i) {
    // A mode that does not move the contact point moves the rest of the beam.
    const double shape = std::max(std::abs(device.basis().contact_shape()[i]), 0.1 * device.basis().contact_shape()[0]);
    const double share = shape * static_cast<double>(1 + i * i);
    s.q[i] = 0.15 * plane * uniform(random) / share;
    s.v[i] = 0.1 * uniform(random) / share;
  }
  const double wanted = in_contact ? plane * (1.03 + 0.0125 * uniform(random)) : plane * (0.5 + 0.4 * uniform(random));
  s.q[0] += (wanted - device.contact_deflection(s.q.data())) / device.basis().contact_shape()[0];
  for (std::size_t k = 0; k < device.drives(); ++k) {
    s.volts.push_back((device.drive_kind(k) == DriveKind::electrode ? 10 : 1) * uniform(random));
  }
  if (device.has_piezo()) s.volts.back() /= 2;
  return s;
}

constexpr int states_per_combination = 4;

TEST(Switch, JacobianIsTheDerivativeOfTheAccelerations) {
  constexpr double differences = 1e-7;  // share of the largest entry in the column: rounding of the difference quotient
  std::mt19937_64 random(1);
  for (const Combination& c : combinations()) {
    const Switch device(c.device);
    Switch::Workspace work = device.workspace();
    const Eigen::Index n = device.modes();
    for (int k = 0; k < states_per_combination; ++k) {
      const bool in_contact = k % 2 == 1;
      State s = random_state(device, in_contact, random);
      Eigen::MatrixXd by_q(n, n), by_v(n, n);
      device.jacobian(s.q.data(), s.v.data(), s.volts, in_contact, work, by_q, by_v);
      const auto column = [&](Eigen::VectorXd& unknown, Eigen::Index i, double h) {
        const double at = unknown[i];
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(n), a(n);
        for (const auto& [offset, weight] : {std::pair{1, 8.0}, {-1, -8.0}, {2, -1.0}, {-2, 1.0}}) {
          unknown[i] = at + offset * h;
          device.accelerations(s.q.data(), s.v.data(), s.volts, in_contact, work, a.data());
          sum += weight * a;
        }
        unknown[i] = at;
        return Eigen::VectorXd(sum / (12 * h));
      };
      for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::VectorXd q_column = column(s.q, i, 5e-5 * c.device.gap.contact / device.basis().contact_shape().maxCoeff());
        EXPECT_LT((q_column - by_q.col(i)).cwiseAbs().maxCoeff(), differences * by_q.cwiseAbs().maxCoeff()) << c.name;
        const Eigen::VectorXd v_column = column(s.v, i, 0.01 / device.basis().contact_shape().maxCoeff());
        EXPECT_LE((v_column - by_v.col(i)).cwiseAbs().maxCoeff(),
                  differences * (by_v.cwiseAbs().maxCoeff() + device.basis().angular_frequencies()[0]))
            << c.name;
      }
    }
  }
}

// Compares all functions of a switch that a closing calls, bit for bit if both have the modes of one normalised beam. Otherwise
// it compares up to the rounding of modes, which a beam is sensitive to if it is pressed into its contact by a thousandth of
// the gap, or near its static fold.
void expect_same(const Switch& a, const Switch& b, bool in_bits) {
  const double rounding = in_bits ? 0 : 1e-11, magnified = in_bits ? 0 : 1e-8;
  const auto expect_close = [](const Eigen::VectorXd& x, const Eigen::VectorXd& y, double relative) {
    ASSERT_EQ(x.size(), y.size());
    EXPECT_TRUE((x - y).cwiseAbs().maxCoeff() <= relative * y.cwiseAbs().maxCoeff()) << x.transpose() << "\n" << y.transpose();
  };
  ASSERT_EQ(a.modes(), b.modes());
  ASSERT_EQ(a.quadrature().points(), b.quadrature().points());
  expect_close(a.basis().angular_frequencies(), b.basis().angular_frequencies(), rounding);
  expect_close(a.basis().contact_shape(), b.basis().contact_shape(), rounding);
  expect_close(a.basis().piezo_shape(), b.basis().piezo_shape(), rounding);
  EXPECT_NEAR(a.basis().in_contact_period() / b.basis().in_contact_period(), 1, 1e-11);
  EXPECT_TRUE(std::abs(a.penetration_scale() - b.penetration_scale()) <= rounding * b.penetration_scale());
  EXPECT_TRUE(std::abs(a.bending_energy() - b.bending_energy()) <= rounding * b.bending_energy());
  ASSERT_EQ(a.rest().has_value(), b.rest().has_value());
  if (a.rest()) expect_close(*a.rest(), *b.rest(), magnified);
  EXPECT_TRUE((a.quadrature().positions() == b.quadrature().positions()).all());
  const auto accelerations = [](const Switch& s) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(s.modes()), v = Eigen::VectorXd::Constant(s.modes(), 1e-8), result(s.modes());
    q[0] = 1.001 * s.device().gap.contact / s.basis().contact_shape()[0];
    const std::vector<double> drives(s.drives(), 1.5);
    Switch::Workspace work = s.workspace();
    s.accelerations(q.data(), v.data(), drives, s.has_contact(), work, result.data());
    return result;
  };
  expect_close(accelerations(a), accelerations(b), magnified);
}

TEST(Switch, BuiltLikeAnotherIsTheSameSwitch) {
  const std::vector<void (*)(Device&)> changes{
      [](Device& d) { d.structure.thickness *= 1.02; },
      [](Device& d) {
        d.structure.width *= 0.98;
        if (Beam* const beam = d.structure.find<Beam>()) beam->youngs_modulus *= 1.03, beam->density *= 1.01;
      },
      [](Device& d) { d.gap.electrode *= 1.02, d.gap.contact *= 1.02; },
      [](Device& d) { d.structure.length *= 1.01; },
      [](Device& d) { d.electrodes[0].begin.value += 0.01 * d.structure.length; },
      [](Device& d) { d.contacts.front().pad_length *= 1.1; },
      [](Device& d) { d.structure.modes = 3; },
      [](Device& d) { d.piezo.reset(); },
      [](Device& d) {
        if (Bridge* const bridge = d.structure.find<Bridge>()) bridge->residual_stress = 1e6;
      },
  };
  const std::vector<Combination> all = combinations();
  for (std::size_t i = 0; i < all.size(); i += 5) {  // each takes as long as twenty closings
    const Combination& c = all[i];
    const Switch nominal(c.device);
    for (std::size_t k = 0; k < changes.size(); ++k) {
      Device changed = c.device;
      if (changed.electrodes.empty() || !changed.has_contact()) continue;
      changes[k](changed);
      SCOPED_TRACE(fmt::format("{}, change {}", c.name, k));
      const bool one_shape = changed.structure.is_rigid() ||
                             (changed.structure.find<Cantilever>() != nullptr && !c.device.piezo && !changed.surface);
      expect_same(Switch(changed, {}, &nominal), Switch(changed), one_shape);
    }
    expect_same(Switch(c.device, {.points_per_length = 17}, &nominal), Switch(c.device, {.points_per_length = 17}), true);
  }
}

TEST(Switch, TwiceTheQuadratureIsTwiceThePointsOfEveryPanel) {
  const SwitchOptions coarse{.points_per_length = 30}, fine{.points_per_length = 60, .points_per_panel = 6};
  Device d = test::gold_cantilever();
  d.electrodes[0].begin = 0.3_um;  // the shortest possible panel, with the least number of points
  EXPECT_EQ(Switch(d, fine).quadrature().points(), 2 * Switch(d, coarse).quadrature().points());
}

// An electrode with several pads acts like several electrodes with one voltage.
TEST(Switch, PadsOfOneElectrodeActAsElectrodesOfOneVoltage) {
  for (const Side side : {Side::near, Side::far, Side::both}) {
    Device pads = test::gold_cantilever(), apart = pads;
    for (Device* d : {&pads, &apart})
      d->electrodes[0] = {.name = "one", .begin = 30_um, .end = 100_um, .side = side, .gap = 5_um};
    pads.electrodes[0].further = {{.begin = 130_um, .end = Place::share(1)}};
    apart.electrodes.push_back({.name = "two", .begin = 130_um, .end = 250_um, .side = side, .gap = 5_um});
    const Switch one(pads), two(apart);
    ASSERT_EQ(one.quadrature().points(), two.quadrature().points());
    ASSERT_EQ(one.drives(), 1U);
    const Eigen::VectorXd q = Eigen::VectorXd::Constant(one.modes(), 2e-13), v = Eigen::VectorXd::Constant(one.modes(), 1e-8);
    Switch::Workspace work = one.workspace();
    Eigen::VectorXd a(one.modes()), b(one.modes());
    one.accelerations(q.data(), v.data(), std::vector{17.0}, false, work, a.data());
    const double charge = one.capacitance(0, q.data(), work);
    two.accelerations(q.data(), v.data(), std::vector{17.0, 17.0}, false, work, b.data());
    EXPECT_LT((a - b).norm(), 1e-13 * b.norm());
    EXPECT_NEAR(charge, two.capacitance(0, q.data(), work) + two.capacitance(1, q.data(), work), 1e-13 * charge);
  }
}

TEST(Switch, StaticForceIsMinusTheGradientOfThePotential) {
  constexpr double differences = 1e-7;
  std::mt19937_64 random(2);
  for (const Combination& c : combinations()) {
    const Switch device(c.device);
    Switch::Workspace work = device.workspace();
    const Eigen::Index n = device.modes();
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(n);
    for (int k = 0; k < states_per_combination; ++k) {
      const bool in_contact = k % 2 == 1;
      State s = random_state(device, in_contact, random);
      Eigen::VectorXd force(n), gradient(n);
      device.accelerations(s.q.data(), rest.data(), s.volts, in_contact, work, force.data());
      for (Eigen::Index i = 0; i < n; ++i) {
        const double at = s.q[i], h = 1e-3 * c.device.gap.contact / device.basis().contact_shape().maxCoeff();
        double sum = 0;
        for (const auto& [offset, weight] : {std::pair{1, 672.0}, {2, -168.0}, {3, 32.0}, {4, -3.0}}) {
          s.q[i] = at + offset * h;
          sum += weight * device.potential(s.q.data(), s.volts, in_contact, work);
          s.q[i] = at - offset * h;
          sum -= weight * device.potential(s.q.data(), s.volts, in_contact, work);
        }
        s.q[i] = at;
        gradient[i] = sum / (840 * h);
      }
      EXPECT_LT((force + gradient).cwiseAbs().maxCoeff(), differences * force.cwiseAbs().maxCoeff()) << c.name;
    }
  }
}

TEST(Switch, DissipatedPowerIsWhatTheVelocityDependentForcesTakeOut) {
  constexpr double rounding = 1e-9;
  std::mt19937_64 random(3);
  for (const Combination& c : combinations()) {
    const Switch device(c.device);
    Switch::Workspace work = device.workspace();
    const Eigen::Index n = device.modes();
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(n);
    const bool in_contact = random() % 2 == 1;
    const State s = random_state(device, in_contact, random);
    Eigen::VectorXd moving(n), still(n);
    device.accelerations(s.q.data(), s.v.data(), s.volts, in_contact, work, moving.data());
    device.accelerations(s.q.data(), rest.data(), s.volts, in_contact, work, still.data());
    double power = device.dissipated_power(s.q.data(), s.v.data(), work);
    if (in_contact) power += device.contact_dissipation(s.q.data(), s.v.data());
    EXPECT_NEAR(power, -s.v.dot(moving - still), rounding * (std::abs(power) + s.v.norm() * still.norm())) << c.name;
    EXPECT_GE(power, 0) << c.name;
    EXPECT_EQ(device.damped(),
              c.device.gas || c.device.structure.damping_ratio > 0 || test::damping(c.device.contacts.front()) > 0)
        << c.name;
    if (!c.device.gas && c.device.structure.damping_ratio == 0 && !(in_contact && test::damping(c.device.contacts.front()) > 0)) {
      EXPECT_EQ(power, 0) << c.name;
    } else {
      EXPECT_GT(power, 0) << c.name;
    }
  }
}

TEST(Switch, EnergiesAreThoseOfMassNormalisedModes) {
  const Switch device(test::gold_cantilever());
  std::mt19937_64 random(4);
  const State s = random_state(device, false, random);
  double kinetic = 0, elastic = 0;
  for (Eigen::Index i = 0; i < device.modes(); ++i) {
    kinetic += s.v[i] * s.v[i] / 2;
    elastic += std::pow(device.basis().angular_frequencies()[i] * s.q[i], 2) / 2;
  }
  EXPECT_NEAR(device.basis().kinetic_energy(s.v.data()), kinetic, 1e-14 * kinetic);
  EXPECT_NEAR(device.elastic_energy(s.q.data()), elastic, 1e-14 * elastic);
}

TEST(Switch, CapacitanceAtRestIsThatOfTheStraightBeam) {
  Device d = test::gold_cantilever();
  d.electrodes[0].fringing = Fringing::none;
  const Switch device(d);
  Switch::Workspace work = device.workspace();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(device.modes());
  const double expected = vacuum_permittivity * 20_um * 180_um / 3.5_um;
  EXPECT_NEAR(device.capacitance(0, rest.data(), work), expected, 1e-12 * expected);
  EXPECT_EQ(Switch(test::gold_pzt_cantilever()).capacitance(1, rest.data(), work), 0) << "the layer's own is not described";
}

TEST(Quadrature, CornersThatDifferByARoundingAreOne) {
  Device d = test::gold_cantilever();
  d.electrodes[0].end = d.structure.length - d.contacts.front().pad_length;
  const Eigen::Index points = Switch(d).quadrature().points();
  d.electrodes[0].end = std::nextafter(d.electrodes[0].end.value, 0.0);
  EXPECT_EQ(Switch(d).quadrature().points(), points);
}

TEST(Switch, QuadratureKnowsEveryCorner) {
  const Switch device(test::gold_pzt_cantilever());
  // The weights between any two ends of panels sum to the length, as the capacitance of a straight beam shows.
  Device d = test::gold_pzt_cantilever();
  for (const auto& [begin, end] : {std::pair{0_um, 5_um}, {5_um, 60_um}, {60_um, 245_um}, {13_um, 14_um}, {245_um, 250_um}}) {
    d.electrodes[0] = {.name = "part", .begin = begin, .end = end, .fringing = Fringing::none};
    const Switch part(d);
    Switch::Workspace work = part.workspace();
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(part.modes());
    const double expected = vacuum_permittivity * 20_um * (end - begin) / 3.5_um;
    EXPECT_NEAR(part.capacitance(0, rest.data(), work), expected, 1e-12 * expected) << begin << " " << end;
  }
  EXPECT_TRUE((device.quadrature().positions() > 0).all());
  EXPECT_TRUE((device.quadrature().positions() < 250_um).all());
}

TEST(Switch, ElectrodeUpToTheFreeEndCountsEveryPoint) {
  Device d = test::gold_cantilever();
  d.contacts.clear();
  d.electrodes[0] = {.name = "all", .begin = 0, .end = d.structure.length, .fringing = Fringing::none};
  const Switch device(d);
  Switch::Workspace work = device.workspace();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(device.modes());
  const double expected = vacuum_permittivity * 20_um * 250_um / 3.5_um;
  EXPECT_NEAR(device.capacitance(0, rest.data(), work), expected, 1e-12 * expected);

  EXPECT_DOUBLE_EQ(d.contact_position(), d.structure.length);
}

TEST(Switch, UniformPressureOnAStiffBeamGivesTheTextbookDeflection) {
  // At a small voltage the force per length is f = eps0 a V^2 / (2 d0^2) on the whole beam, and the tip deflects by f L^4 / (8
  // EI).
  Device d = test::gold_cantilever();
  d.contacts.clear();
  d.structure.modes = 20;
  d.electrodes[0] = {.name = "all", .begin = 0, .end = d.structure.length, .fringing = Fringing::none};
  const Switch device(d);
  Switch::Workspace work = device.workspace();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(device.modes());
  Eigen::VectorXd force(device.modes());
  const std::vector<double> volts{0.1};
  device.accelerations(rest.data(), rest.data(), volts, false, work, force.data());
  const Eigen::VectorXd q = force.cwiseQuotient(device.basis().angular_frequencies().cwiseAbs2());
  const double load = vacuum_permittivity * 20_um * 0.01 / (2 * std::pow(3.5_um, 2));
  const double rigidity = 78e9 * 20_um * std::pow(2_um, 3) / 12;
  const double expected = load * std::pow(250_um, 4) / (8 * rigidity);
  EXPECT_NEAR(device.contact_deflection(q.data()), expected, 1e-6 * expected);
}

TEST(Switch, PiezoForceBelongsToItsCharge) {
  const Switch device(test::gold_pzt_cantilever());
  EXPECT_EQ(device.drives(), 2u);
  EXPECT_TRUE(device.has_piezo());
  std::mt19937_64 random(5);
  const State s = random_state(device, false, random);
  EXPECT_DOUBLE_EQ(device.basis().piezo_charge(s.q.data()), device.basis().piezo_shape().dot(s.q));
  EXPECT_LT(device.basis().piezo_shape()[0], 0) << "a positive voltage lifts the tip";
  EXPECT_TRUE(Switch(test::gold_cantilever()).basis().piezo_shape().isZero());
  EXPECT_EQ(Switch(test::gold_cantilever()).drives(), 1u);
}

TEST(Switch, PenetrationScaleCarriesTheForceThatBendsTheBeamByTheGap) {
  Device d = test::gold_cantilever();
  d.contacts.front().model = LinearSpring{.stiffness = 1e4};
  d.structure.modes = 1;
  const Switch device(d);
  const double stiffness = std::pow(device.basis().angular_frequencies()[0] / device.basis().contact_shape()[0], 2);
  EXPECT_NEAR(device.penetration_scale(), stiffness * 2_um / 1e4, 1e-9 * device.penetration_scale());
}

TEST(Switch, InContactItVibratesAsTheBeamPinnedAtTheContact) {
  // As the contact's stiffness and the number of modes grow, the first frequency in contact approaches that of the pinned beam.
  Device d = test::gold_cantilever();
  d.electrodes.clear();
  d.structure.modes = 20;
  d.contacts.front().model = LinearSpring{.stiffness = 1e9};
  const Switch device(d);
  Switch::Workspace work = device.workspace();
  const Eigen::Index n = device.modes();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd by_q(n, n), by_v(n, n);
  device.jacobian(rest.data(), rest.data(), {}, true, work, by_q, by_v);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(-by_q);
  const double period = 2 * pi / std::sqrt(solver.eigenvalues()[0]);
  EXPECT_NEAR(device.basis().in_contact_period(), period, 1e-3 * period);
}

TEST(Switch, BetweenTwoClampsHasItsContactInTheMiddle) {
  Device d = test::gold_bridge();
  const Switch device(d);
  EXPECT_DOUBLE_EQ(d.contact_position(), 125_um);
  EXPECT_DOUBLE_EQ(d.pad().first, 122.5_um);
  EXPECT_DOUBLE_EQ(d.pad().second, 127.5_um);
  // The middle is a node of every second mode.
  for (const int i : {1, 3}) EXPECT_NEAR(device.basis().contact_shape()[i], 0, 1e-9 * device.basis().contact_shape()[0]);
  d.contacts.clear();
  EXPECT_DOUBLE_EQ(d.contact_position(), 125_um);
}

TEST(Stretching, OfOneModeIsTheIntegralOfTheSlopes) {
  // Deflected in the shape of its first mode the beam stores EA/(8 L) (int y'^2)^2 by stretching.
  Device d = test::gold_bridge();
  d.structure.modes = 1;
  part_of<Bridge>(d.structure).residual_stress = 0;
  const Switch stretched(d);
  part_of<Bridge>(d.structure).stretches = false;
  const Switch plain(d);
  const BeamModes beam(beam_sections(d), 1, beam_support(d.structure));
  const double middle = 1.5_um, q = middle / beam.value(125_um)[0];
  double squares = 0;
  constexpr int points = 20000;  // midpoint rule: the integrand and its first derivative vanish at both ends
  for (int k = 0; k < points; ++k) squares += std::pow(q * beam.slope(250_um * (k + 0.5) / points)[0], 2) * 250_um / points;
  const double ea = 78e9 * 20_um * 2_um, expected = ea / (8 * 250_um) * squares * squares;
  const double stored = stretched.elastic_energy(&q) - plain.elastic_energy(&q);
  EXPECT_NEAR(stored, expected, 1e-7 * expected);
  // The similar shape c (1 - cos(2 pi x/L))/2 stores 3/8 (c/b)^2 of its bending energy by stretching.
  const double cosine = 0.375 * std::pow(middle / 2_um, 2);
  EXPECT_NEAR(stored / plain.elastic_energy(&q), cosine, 0.05 * cosine);
}

TEST(Switch, OfAPlateIsOneOscillator) {
  Device d = test::full_plate();
  d.structure.modes = 4;  // a plate has one mode, whatever the scene says
  const Switch device(d);
  ASSERT_EQ(device.modes(), 1);
  EXPECT_EQ(device.quadrature().points(), 3);  // points at the ends of either electrode, and one for the rest
  EXPECT_DOUBLE_EQ(device.basis().angular_frequencies()[0], std::sqrt(42 / 2.4e-9));
  const double x = 0.4_um, q = x / device.basis().contact_shape()[0];
  EXPECT_DOUBLE_EQ(device.contact_deflection(&q), x);
  EXPECT_NEAR(device.elastic_energy(&q), 42 * x * x / 2, 1e-14 * 42 * x * x);
  // Forces are proportional to areas: eps0 A V^2 / (2 h^2), and mu a^2 A / h^3 of the film.
  for (Electrode& e : d.electrodes) e.fringing = Fringing::none;
  const Switch plain(d);
  Switch::Workspace work = plain.workspace();
  const double rest = 0, v = 0.1 / plain.basis().contact_shape()[0];
  double force = 0;
  plain.accelerations(&q, &rest, std::vector<double>{0.0, 10.0}, false, work, &force);
  const double h = 3.8_um - x, area = 100_um * 100_um;
  const double expected = vacuum_permittivity * 0.3 * area * 100 / (2 * h * h) - 42 * x;
  EXPECT_NEAR(force * plain.basis().contact_shape()[0] * 2.4e-9, expected, 1e-12 * 42 * x);
  const double power = 1e-6 * 1e-8 * area / (h * h * h) * 0.01;
  EXPECT_NEAR(plain.dissipated_power(&q, &v, work), power, 1e-12 * power);
}

TEST(Switch, ElectrodeOnTheFarSideLiftsTheBeam) {
  // At a small voltage on two plates each force is eps0 A V^2 / (2 d^2), one towards the contact and one away from it.
  Device d = test::plate_between_electrodes();
  for (Electrode& e : d.electrodes) {
    e.fringing = Fringing::none;
    e.end = 50_um;
  }
  d.electrodes[1].gap = 2 * 3.8_um;
  const Switch device(d);
  Switch::Workspace work = device.workspace();
  const double rest = 0, v = 0.1 / device.basis().contact_shape()[0],
               force = vacuum_permittivity * 5e-9 / (2 * std::pow(3.8_um, 2));
  double a = 0;
  const auto newtons = [&](std::vector<double> volts) {
    device.accelerations(&rest, &rest, volts, false, work, &a);
    return a * 2.4e-9 * device.basis().contact_shape()[0];
  };
  EXPECT_NEAR(newtons({1, 0}), force, 1e-12 * force);
  EXPECT_NEAR(newtons({0, 1}), -force / 4, 1e-12 * force);
  EXPECT_NEAR(newtons({1, 2}), 0, 1e-12 * force);
  EXPECT_NEAR(device.capacitance(1, &rest, work), vacuum_permittivity * 5e-9 / (2 * 3.8_um), 1e-27);
  // Both films act together.
  const double one = 1e-6 * 1e-8 * 1e-8 / std::pow(3.8_um, 3) * 0.01;
  EXPECT_NEAR(device.dissipated_power(&rest, &v, work), 2 * one, 1e-12 * one);
}

TEST(Switch, GapFloorIsAHundredthOfTheElectrodeGap) {
  const Switch device(test::gold_cantilever());
  EXPECT_DOUBLE_EQ(device.gap_floor(), 35_nm);
  Switch::Workspace work = device.workspace();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(4), a(4);
  device.accelerations(q.data(), q.data(), std::vector<double>{1.0}, false, work, a.data());
  EXPECT_DOUBLE_EQ(Switch::smallest_gap(work), 3.5_um);
}

}  // namespace
}  // namespace softland
