// A right-hand side from laws and modal projection, over the three scalars, compared with that of a Switch.
#include "model/modal_projection.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <experimental/simd>
#include <vector>

#include "base/gauss.h"
#include "model/beam.h"
#include "model/contact/asperity_uniform.h"
#include "model/dual.h"
#include "model/forces/electrostatic.h"
#include "model/gas/strip.h"
#include "model/switch.h"
#include "tests/support/devices.h"

namespace softland::modal_projection_test {
namespace {

constexpr std::size_t modes = 3, devices = 4;
using DeviceLane = std::experimental::fixed_size_simd<double, devices>;

Device device() {
  Device d = test::gold_cantilever();
  d.structure.modes = modes;
  return d;
}

/// A point of the beam.
struct Place {
  double weight = 0;  ///< [m]
  bool on_electrode = false;
  Eigen::VectorXd shape;  ///< [kg^(-1/2)]
};

struct Beam {
  std::vector<Place> places;
  Eigen::VectorXd tip, frequencies;
};

Beam beam() {
  const Device d = device();
  const BeamModes own(beam_sections(d), modes);
  Beam b{.places = {}, .tip = own.value(d.contact_position()), .frequencies = own.angular_frequencies()};
  const Electrode& e = d.electrodes.front();
  const std::array corners{0.0, e.begin.on(d.structure.length), e.end.on(d.structure.length), d.structure.length};
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const double length = corners[k + 1] - corners[k];
    if (length == 0) continue;
    const GaussRule rule = gauss_rule(40);
    for (std::size_t i = 0; i < rule.points.size(); ++i) {
      b.places.push_back({.weight = rule.weights[i] * length / 2,
                          .on_electrode = k == 1,
                          .shape = own.value(corners[k] + length * (1 + rule.points[i]) / 2)});
    }
  }
  return b;
}

/// The quantities that vary between devices.
template <class P>
struct Sample {
  P thickness, width, gap, viscosity;
};
Sample<double> nominal() {
  const Device d = device();
  return {d.structure.thickness, d.structure.width, d.gap.electrode, viscosity(*film_of(*d.gas))};
}

std::span<const double> of(const Eigen::VectorXd& shape) { return {shape.data(), modes}; }

/// Returns the modal accelerations with the tip in contact.
template <class S>
std::array<S, modes> accelerations(const Beam& b, const Sample<S>& sample, const S* q, const S* v, S volts) {
  const ElectrostaticForce<MeijsFokkemaFringingOf<S>> electrode{{.width = sample.width, .thickness = sample.thickness}};
  const StripSqueezeFilmOf<S> film{.viscosity = sample.viscosity, .width = sample.width};
  const Device d = device();
  const auto law = std::get<UniformAsperityContact>(contact_law(d.contacts.front(), d.structure.width));
  std::array<S, modes> a;
  for (std::size_t i = 0; i < modes; ++i) {
    const double omega = b.frequencies[static_cast<Eigen::Index>(i)];
    a[i] = S(-omega * omega) * q[i];
  }
  for (const Place& place : b.places) {
    const S gap = sample.gap - deflection(of(place.shape), q), velocity = deflection(of(place.shape), v);
    S load = film.load(gap, velocity);
    if (place.on_electrode) load = load + volts * volts * electrode.load(gap, velocity);
    add_modal_force(of(place.shape), S(place.weight) * load, a.data());
  }
  const UniformAsperityContactOf<S> contact{.strength = law.strength, .height = law.height};
  add_modal_force(of(b.tip), -contact.force(deflection(of(b.tip), q) - S(d.gap.contact)), a.data());
  return a;
}

struct Motion {
  std::array<double, modes> q, v;
  double volts = 12;
};

/// The tip is in the contact, at a depth of 20 nm.
Motion motion(const Beam& b) {
  Motion m{.q = {1, 0.02, -0.005}, .v = {1, -2, 3}};
  const double tip = deflection(of(b.tip), m.q.data()), speed = deflection(of(b.tip), m.v.data());
  for (double& q : m.q) q *= (device().gap.contact + 20e-9) / tip;
  for (double& v : m.v) v *= 0.05 / speed;
  return m;
}

TEST(ModalProjection, GivesTheAccelerationsOfASwitch) {
  const Beam b = beam();
  const Motion m = motion(b);
  const auto own = accelerations<double>(b, nominal(), m.q.data(), m.v.data(), m.volts);
  const Switch reference(device(), {.points_per_length = 96});
  Switch::Workspace work = reference.workspace();
  std::array<double, modes> expected;
  reference.accelerations(m.q.data(), m.v.data(), std::array{m.volts}, true, work, expected.data());
  for (std::size_t i = 0; i < modes; ++i) EXPECT_NEAR(own[i], expected[i], 1e-9 * std::abs(expected[0])) << i;
}

TEST(ModalProjection, GivesEveryDeviceOfALaneItsOwnAccelerations) {
  const Beam b = beam();
  const Motion m = motion(b);
  const auto sample_of = [](std::size_t i) {
    const double by = 1e-3 * static_cast<double>(i);
    const Sample<double> n = nominal();
    return Sample<double>{n.thickness * (1 + by), n.width * (1 - by), n.gap * (1 + 2 * by), n.viscosity * (1 - 3 * by)};
  };
  const auto lane = [](const auto& f) { return DeviceLane([&](auto i) { return f(static_cast<std::size_t>(i)); }); };
  std::array<DeviceLane, modes> q, v;
  for (std::size_t k = 0; k < modes; ++k) q[k] = m.q[k], v[k] = m.v[k];
  const Sample<DeviceLane> samples{
      lane([&](std::size_t i) { return sample_of(i).thickness; }), lane([&](std::size_t i) { return sample_of(i).width; }),
      lane([&](std::size_t i) { return sample_of(i).gap; }), lane([&](std::size_t i) { return sample_of(i).viscosity; })};
  const auto all = accelerations<DeviceLane>(b, samples, q.data(), v.data(), DeviceLane(m.volts));
  for (std::size_t i = 0; i < devices; ++i) {
    const auto alone = accelerations<double>(b, sample_of(i), m.q.data(), m.v.data(), m.volts);
    for (std::size_t k = 0; k < modes; ++k) EXPECT_NEAR(all[k][i], alone[k], 1e-11 * std::abs(alone[0])) << i << k;
  }
}

TEST(ModalProjection, GivesTheJacobianOfASwitchAndTheSlopesOfItsSizes) {
  constexpr std::size_t directions = 2 * modes + 2;  // coordinates, velocities, drive, gap
  using G = Gradient<directions>;
  using D = Directions<directions>;
  const Beam b = beam();
  const Motion m = motion(b);
  std::array<G, modes> q, v;
  for (std::size_t k = 0; k < modes; ++k) {
    q[k] = G(m.q[k], D::unit(k));
    v[k] = G(m.v[k], D::unit(modes + k));
  }
  const Sample<double> n = nominal();
  const Sample<G> sample{n.thickness, n.width, G(n.gap, D::unit(2 * modes + 1)), n.viscosity};
  const auto all = accelerations<G>(b, sample, q.data(), v.data(), G(m.volts, D::unit(2 * modes)));

  const Switch reference(device(), {.points_per_length = 96});
  Switch::Workspace work = reference.workspace();
  Eigen::MatrixXd by_q(modes, modes), by_v(modes, modes);
  reference.jacobian(m.q.data(), m.v.data(), std::array{m.volts}, true, work, by_q, by_v);
  const auto moved = [&](double volts, double gap) {
    Sample<double> other = n;
    other.gap += gap;
    return accelerations<double>(b, other, m.q.data(), m.v.data(), m.volts + volts);
  };
  for (std::size_t i = 0; i < modes; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < modes; ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      EXPECT_NEAR(all[i].slope.along[k], by_q(row, column), 1e-9 * by_q.norm()) << i << k;
      EXPECT_NEAR(all[i].slope.along[modes + k], by_v(row, column), 1e-9 * by_v.norm()) << i << k;
    }
    const double by_volts = (moved(1e-3, 0)[i] - moved(-1e-3, 0)[i]) / 2e-3;
    const double by_gap = (moved(0, 1e-11)[i] - moved(0, -1e-11)[i]) / 2e-11;
    EXPECT_NEAR(all[i].slope.along[2 * modes], by_volts, 1e-6 * std::abs(by_volts)) << i;
    EXPECT_NEAR(all[i].slope.along[2 * modes + 1], by_gap, 1e-5 * std::abs(by_gap)) << i;
  }
}

}  // namespace
}  // namespace softland::modal_projection_test
