// Contact along the pad, against the law at many points of the bent beam, closed forms and differences.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/literals.h"
#include "model/beam.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/contact/contact_law.h"
#include "model/contact/pad.h"
#include "model/pull_in.h"
#include "model/switch.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

Device padded(const Contact& contact) {
  Device d = test::gold_cantilever();
  d.contacts = {contact};
  return d;
}

/// Interference of the free end [m] and slope of the beam there: a part of the pad in touch at the free end, the whole pad, the
/// whole pad with the opposite slope, a part at the inner end.
constexpr std::array tilts{std::pair{20e-9, 0.01}, std::pair{80e-9, 0.01}, std::pair{30e-9, -0.004}, std::pair{-5e-9, -0.008}};

/// Returns amplitudes of the first two modes that give the free end this interference and slope.
Eigen::VectorXd tilted(const Switch& model, double depth, double slope) {
  const BeamModes modes(beam_sections(model.device()), model.modes());
  const double end = model.device().structure.length;
  Eigen::Matrix2d m;
  m << modes.value(end).head<2>().transpose(), modes.slope(end).head<2>().transpose();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.modes());
  q.head<2>() = m.partialPivLu().solve(Eigen::Vector2d(model.device().gap.contact + depth, slope));
  return q;
}

/// Returns random velocities as in a closing: the contact point moves at about 0.1 m/s.
Eigen::VectorXd velocities(const Switch& model, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::VectorXd v(model.modes());
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    v[i] = 0.1 * uniform(random) / (model.basis().contact_shape()[0] * static_cast<double>(1 + i * i));
  }
  return v;
}

std::string named(const Contact& c, const std::pair<double, double>& tilt) {
  return fmt::format("{}, {} m, slope {}", test::described(c), tilt.first, tilt.second);
}

const std::vector<double>& no_volts() {
  static const std::vector<double> volts{0};
  return volts;
}

TEST(PadQuadrature, IntegratesTheHalfIntegerPowersOfTheLaws) {
  constexpr double length = 5e-6, rounding = 1e-13;
  constexpr double all_in_touch = 1e-11;  // relative; five times the largest observed error, with the inner end barely in touch
  const PadQuadrature quadrature(length);
  for (const double inner : {-200e-9, -30e-9, -1e-9, 0.0, 1e-12, 1e-10, 1e-9, 3e-9, 1e-8, 3e-8, 1e-7}) {
    for (const double slope : {-0.02, -1e-3, 1e-3, 0.01}) {
      const double end = inner + slope * length, deep = std::max(inner, end), shallow = std::max(0.0, std::min(inner, end));
      if (!(deep > 0)) continue;
      double force = 0, moment = 0, shares = 0;
      quadrature.over_contact(end, slope, [&](double xi, double share, double d) {
        EXPECT_NEAR(d, end - slope * xi, 1e-15 * (std::abs(end) + std::abs(slope) * length));
        EXPECT_TRUE(xi >= 0 && xi <= length);
        shares += share;
        force += share * std::pow(d, 2.5);
        moment += share * std::pow(d, 2.5) * xi;
      });
      const auto power = [&](double p) { return (std::pow(deep, p + 1) - std::pow(shallow, p + 1)) / (p + 1); };
      const double tilt = std::abs(slope) * length;
      const double expected = power(2.5) / tilt, turned = (end * power(2.5) - power(3.5)) / (slope * tilt);
      const double bound = (shallow > 0 ? all_in_touch : rounding) * std::pow(deep, 2.5);
      EXPECT_NEAR(shares, (deep - shallow) / tilt, 1e-9) << inner << ", " << slope;
      EXPECT_NEAR(force, expected, bound) << inner << ", " << slope;
      EXPECT_NEAR(moment, turned, bound * length) << inner << ", " << slope;
    }
  }
}

TEST(PadQuadrature, OfAPadParallelToThePlaneIsAllOfItOrNothing) {
  const PadQuadrature quadrature(5e-6);
  double shares = 0, lever = 0;
  quadrature.over_contact(1e-9, 0, [&](double xi, double share, double d) {
    EXPECT_EQ(d, 1e-9);
    shares += share;
    lever += share * xi;
  });
  EXPECT_NEAR(shares, 1, 1e-14);
  EXPECT_NEAR(lever, 2.5e-6, 1e-19);
  for (const double end : {0.0, -1e-9}) {
    quadrature.over_contact(end, 0, [](double, double, double) { ADD_FAILURE(); });
  }
}

TEST(PadContact, IsTheLawIntegratedAlongTheBentBeam) {
  constexpr double straight = 1e-3;  // relative: the second mode, bent over the pad by 3e-6 of up to 1 um
  std::mt19937_64 random(1);
  for (const Contact& contact : test::pad_contacts()) {
    const Switch model(padded(contact));
    const Device& d = model.device();
    const BeamModes modes(beam_sections(d), model.modes());
    Device without = d;
    without.contacts.front().distribution = ContactDistribution::centre;
    const Switch free(without);
    Switch::Workspace work = model.workspace(), free_work = free.workspace();
    for (const auto& tilt : tilts) {
      const Eigen::VectorXd q = tilted(model, tilt.first, tilt.second), v = velocities(model, random);
      constexpr int points = 4000;
      Eigen::VectorXd expected = Eigen::VectorXd::Zero(model.modes());
      double push = 0, stored = 0, dissipated = 0;
      for (int k = 0; k < points; ++k) {
        const Eigen::VectorXd shape = modes.value(d.structure.length - contact.pad_length * (k + 0.5) / points);
        const double at = shape.dot(q) - d.gap.contact, rate = shape.dot(v);
        if (!(at > 0)) continue;
        const double force = contact_force(model.contact(), at, true, rate) / points;
        push += force;
        expected -= force * shape;
        stored += contact_energy(model.contact(), at) / points;
        dissipated += contact_dissipation(model.contact(), at, rate) / points;
      }
      Eigen::VectorXd with(model.modes()), alone(model.modes());
      model.accelerations(q.data(), v.data(), no_volts(), true, work, with.data());
      free.accelerations(q.data(), v.data(), no_volts(), false, free_work, alone.data());
      const std::string name = named(contact, tilt);
      EXPECT_LT((with - alone - expected).norm(), straight * expected.norm()) << name;
      EXPECT_NEAR(model.contact_push(q.data(), v.data(), true), push, straight * std::abs(push)) << name;
      EXPECT_NEAR(model.contact_stored(q.data(), true), stored, straight * std::abs(stored)) << name;
      EXPECT_NEAR(model.contact_dissipation(q.data(), v.data()), dissipated, straight * dissipated) << name;
      EXPECT_EQ(dissipated > 0, test::damping(contact) > 0) << name;
    }
  }
}

TEST(PadContact, HasItsExactDerivativesAndEnergy) {
  constexpr double differences = 1e-6;  // error as a share of the largest entry, of the contact alone
  constexpr double step = 0.2e-9;       // [m] at the free end
  std::mt19937_64 random(2);
  for (const Contact& contact : test::pad_contacts()) {
    const Switch model(padded(contact));
    Switch::Workspace work = model.workspace();
    const Eigen::Index n = model.modes();
    for (const auto& tilt : tilts) {
      Eigen::VectorXd q = tilted(model, tilt.first, tilt.second), v = velocities(model, random);
      const std::string name = named(contact, tilt);
      // The force of the contact alone: subtract the force of the same device without it.
      const auto force = [&](const Eigen::VectorXd& rate) {
        Eigen::VectorXd with(n), without(n);
        model.accelerations(q.data(), rate.data(), no_volts(), true, work, with.data());
        model.accelerations(q.data(), rate.data(), no_volts(), false, work, without.data());
        return Eigen::VectorXd(with - without);
      };
      Eigen::MatrixXd by_q(n, n), by_v(n, n), idle_by_q(n, n), idle_by_v(n, n);
      model.jacobian(q.data(), v.data(), no_volts(), true, work, by_q, by_v);
      model.jacobian(q.data(), v.data(), no_volts(), false, work, idle_by_q, idle_by_v);
      by_q -= idle_by_q;
      by_v -= idle_by_v;
      const auto derivative = [](double& x, double h, auto&& f) {
        const double at = x;
        auto sum = f();
        sum *= 0;
        for (const auto& [offset, weight] : {std::pair{1, 8.0}, {-1, -8.0}, {2, -1.0}, {-2, 1.0}}) {
          x = at + offset * h;
          sum += weight * f();
        }
        x = at;
        sum /= 12 * h;
        return sum;
      };
      const Eigen::VectorXd still = Eigen::VectorXd::Zero(n), at_rest = force(still);
      Eigen::VectorXd gradient(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const double unit = 1 / std::abs(model.basis().contact_shape()[i]);
        const Eigen::VectorXd q_column = derivative(q[i], step * unit, [&] { return force(v); });
        EXPECT_LT((q_column - by_q.col(i)).cwiseAbs().maxCoeff(), differences * by_q.cwiseAbs().maxCoeff()) << name;
        const Eigen::VectorXd v_column = derivative(v[i], 0.01 * unit, [&] { return force(v); });
        EXPECT_LE((v_column - by_v.col(i)).cwiseAbs().maxCoeff(), differences * by_v.cwiseAbs().maxCoeff() + 1e-6) << name;
        gradient[i] = derivative(q[i], step * unit, [&] {
          return model.potential(q.data(), no_volts(), true, work) - model.potential(q.data(), no_volts(), false, work);
        });
      }
      EXPECT_LT((at_rest + gradient).cwiseAbs().maxCoeff(), differences * at_rest.cwiseAbs().maxCoeff()) << name;
      const double power = -v.dot(force(v) - at_rest);
      EXPECT_NEAR(model.contact_dissipation(q.data(), v.data()), power, differences * v.norm() * at_rest.norm()) << name;
    }
  }
}

TEST(PadContact, OfAVeryShortPadIsTheContactAtItsCentre) {
  Contact short_pad = test::pad_contacts().front();
  short_pad.pad_length /= 1000;
  Device d = padded(short_pad);
  const Switch pad(d);
  d.contacts.front().distribution = ContactDistribution::centre;
  const Switch centre(d);
  const Eigen::VectorXd q = tilted(pad, 20_nm, 0.01), still = Eigen::VectorXd::Zero(pad.modes());
  const double expected = centre.contact_push(q.data(), still.data(), true);
  constexpr double tilt = 1e-5;  // relative: the square of 25 pm over 20 nm
  EXPECT_NEAR(pad.contact_push(q.data(), still.data(), true), expected, tilt * expected);
}

TEST(PadContact, IsSeenFromTheFreeEnd) {
  const Switch model(padded(test::pad_contacts().front()));
  const Device& d = model.device();
  const BeamModes modes(beam_sections(d), model.modes());
  EXPECT_EQ(d.contact_position(), d.structure.length);
  EXPECT_EQ(model.basis().contact_shape(), modes.value(d.structure.length));
  EXPECT_DOUBLE_EQ(model.basis().in_contact_period(), 2 * pi / modes.pinned_frequency(d.structure.length));
  // The scale of penetration corresponds to the force that bends the beam by the contact gap, on the pad as tilted by that
  // force.
  const Eigen::VectorXd bent = model.basis().contact_shape().cwiseQuotient(model.basis().angular_frequencies().cwiseAbs2());
  const double compliance = model.basis().contact_shape().dot(bent);
  const Eigen::VectorXd q = bent * ((d.gap.contact + model.penetration_scale()) / compliance), still = 0 * q;
  const double force = d.gap.contact / compliance;
  EXPECT_NEAR(model.contact_push(q.data(), still.data(), true), force, 1e-9 * force);
}

TEST(PadContact, LeavesTheFoldOfTheStaticBranchWhereItIs) {
  Device d = test::gold_cantilever();
  const double expected = static_pull_in(Switch(d), 0).voltage;
  d.contacts.front().distribution = ContactDistribution::pad;
  const StaticPullIn found = static_pull_in(Switch(d), 0);
  EXPECT_EQ(found.kind, StaticKind::fold);
  EXPECT_NEAR(found.voltage, expected, 1e-7 * expected) << "seen from another point of the same beam";
}

TEST(PadContact, PushesFromTheTouchOfTheFreeEndOn) {
  Device d = padded(test::gold_cantilever().contacts.front());
  d.contacts.front().distribution = ContactDistribution::pad;
  const Switch model(d);
  const std::vector<Signal> drives{Signal::constant(17.771)};
  const Trajectory t = simulate_closing(model, drives, {.duration = 100_us, .tolerance = 1e-8});
  ASSERT_EQ(t.status, Status::done);
  ASSERT_GE(t.touches.size(), 2u);
  double at_knots = 0, recorded = 0;
  for (const TrajectoryPoint& p : t.points) {
    constexpr double begun = 1e-12;  // [m] beyond the plane, and a force below 1e-30 N there
    if (p.position > t.contact_gap + begun) {
      EXPECT_GT(p.contact_force, 0) << p.time;
    } else {
      EXPECT_LT(p.contact_force, 1e-20) << p.time;
    }
    at_knots = std::max(at_knots, p.contact_force);
  }
  for (const Touch& touch : t.touches) recorded = std::max(recorded, touch.peak_force);
  EXPECT_GE(recorded, at_knots);
  EXPECT_LT(recorded, 1.05 * at_knots);
  EXPECT_LT(recorded, contact_force(model.contact(), t.deepest_penetration)) << "of a pad all of which is that deep";
}

}  // namespace
}  // namespace softland
