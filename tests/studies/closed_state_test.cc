// Tests if a closed switch stays closed: by the tangent of its closed equilibrium, and by closings that are simulated for long.
#include "studies/closing/closed_state.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "model/closing.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "studies/closing/simulate.h"
#include "studies/devices/ensemble.h"
#include "tests/studies/scenes.h"

namespace softland::closed_state_test {
namespace {

using testing::HasSubstr;

// A bridge with its contact in the middle of a long electrode. Held there, it collapses on one side.
SceneFile bridge(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = SceneFile::parse(R"(
[structure]
kind = "clamped-clamped"
length = "300 um"
width = "40 um"
thickness = "1.5 um"
youngs_modulus = "160 GPa"
density = "8900 kg/m^3"
residual_stress = "15 MPa"
modes = 4
[gap]
electrode = "2 um"
contact = "1.4 um"
[electrode.main]
span = ["40 um", "260 um"]
[gas]
model = "strip"
[contact]
model = "linear"
pad_length = "8 um"
stiffness = "2e4 N/m"
[waveform.main]
family = "step"
level = "45 V"
[driver.main]
max_voltage = "200 V"
)",
                                    "bridge.toml");
  for (const std::string_view change : changes) file.set(change);
  return file;
}

ClosedState state_at(const SceneFile& file) {
  const PreparedScene p = prepare(file);
  return closed_state(p, p.signals());
}

double pulled_through() {
  static const double volts = state_at(bridge()).pulled_through.at("main");
  return volts;
}

std::string level(double volts) { return fmt::format("waveform.main.level={:.9g} V", volts); }

// A plate is held up to its fold, in closed form: k d + K (d - c) = eps A V^2 / (2 (g - d)^2) has its fold at the maximum of
// the left side times (g - d)^2.
TEST(ClosedState, OfAPlateEndsAtItsFold) {
  const double k = 42, contact = 312.4, gap = 3.8e-6, plane = 2.6e-6, area = 1e-8;
  double most = 0;
  for (int i = 0; i <= 4'000'000; ++i) {
    const double d = plane + (gap - plane) * i / 4e6;
    most = std::max(most, (gap - d) * (gap - d) * (k * d + contact * (d - plane)));
  }
  const double fold = std::sqrt(2 * most / (vacuum_permittivity * area));
  const SceneFile file = spring_plate({"contact.stiffness=312.4 N/m", "driver.main.max_voltage=200 V"});
  const PreparedScene p = prepare(file);
  const double found = pull_through_voltage(p.model, 0, std::array{0.9 * fold});
  EXPECT_NEAR(found, fold, 1e-5 * fold);
  for (const double share : {0.99, 0.999, 0.9999})
    EXPECT_TRUE(keeps_closed(p.model, closed_equilibrium(p.model, std::array{share * fold}))) << share;
  EXPECT_FALSE(closed_equilibrium(p.model, std::array{1.0001 * fold}));
}

TEST(ClosedState, SmallestEigenvalueIsThatOfDifferences) {
  for (const SceneFile& file :
       {bridge({level(40)}), gold({"waveform.main.level=20 V"}), gold_pzt({"waveform.main.level=25 V"})}) {
    const PreparedScene p = prepare(file);
    const std::vector<double> volts = hold_levels(p.signals());
    const auto closed = closed_equilibrium(p.model, volts);
    ASSERT_TRUE(closed);
    const Eigen::Index n = p.model.modes();
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(n);
    Switch::Workspace work = p.model.workspace();
    // Central differences of the accelerations along the modes give the tangent.
    Eigen::MatrixXd tangent(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double step = 1e-6 * p.scene.device.gap.contact / p.model.basis().contact_shape().cwiseAbs().maxCoeff();
      Eigen::VectorXd ahead(n), behind(n), q = closed->q;
      q[k] += step;
      p.model.accelerations(q.data(), still.data(), volts, true, work, ahead.data());
      q[k] -= 2 * step;
      p.model.accelerations(q.data(), still.data(), volts, true, work, behind.data());
      tangent.col(k) = (behind - ahead) / (2 * step);
    }
    // The smallest eigenvalue, by inverse iteration with a shift far below it.
    const Eigen::MatrixXd a = (tangent + tangent.transpose()) / 2;
    const double largest = a.cwiseAbs().rowwise().sum().maxCoeff();
    Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, 1, 2);
    for (int i = 0; i < 20000; ++i) x = ((largest * Eigen::MatrixXd::Identity(n, n) - a) * x).normalized();
    EXPECT_NEAR(closed->smallest_eigenvalue, x.dot(a * x), 1e-4 * std::abs(closed->smallest_eigenvalue)) << file.name();
  }
}

TEST(ClosedState, BelowThePullThroughVoltageAPushedBeamComesBack) {
  ASSERT_TRUE(std::isfinite(pulled_through()));
  // An electrode that is shifted by a hundredth of its length pushes the beam to one side.
  for (const double share : {0.93, 1.03}) {
    const PreparedScene p = prepare(bridge({level(share * pulled_through()), "electrode.main.span=[\"42 um\", \"260 um\"]",
                                            "simulate.duration=3 ms", "simulate.tolerance=1e-7"}));
    const Closing c = simulate(p, false);
    EXPECT_EQ(c.metrics.status, share < 1 ? Status::done : Status::collapsed_onto_electrode) << share;
    EXPECT_EQ(std::isfinite(c.trajectory.collapse_time), share > 1) << share;
  }
}

// A cantilever over nitride. A dimple keeps it from touching the face where it otherwise would first.
PreparedScene over_nitride(std::string_view volts) {
  SceneFile file = SceneFile::parse(R"(
[structure]
kind = "cantilever"
length = "150 um"
width = "50 um"
thickness = "3 um"
youngs_modulus = "78 GPa"
density = "19300 kg/m^3"
damping_ratio = 0.5
modes = 4
[gap]
electrode = "2 um"
[electrode.main]
span = ["30 um", "140 um"]
fringing = "none"
dielectric = { thickness = "0.2 um", permittivity = 7, landing = { model = "linear", stiffness = "1e18 Pa/m", from = "10 nm" } }
[contact.dimple]
model = "linear"
stiffness = "2e4 N/m"
at = "145 um"
gap = "1.2 um"
pad_length = "4 um"
[waveform.main]
family = "step"
[simulate]
duration = "60 us"
)",
                                    "over_nitride.toml");
  file.assign("waveform.main.level", std::string(volts));
  return prepare(file);
}

// Sums the pressure of the face over the points of the beam.
TEST(ClosedState, TellsWhatTheFaceOfADielectricCarriesBesideItsContact) {
  const PreparedScene p = over_nitride("140 V");
  const Closing down = simulate(p, false);
  ASSERT_EQ(down.contacts.size(), 2U);
  EXPECT_EQ(down.trajectory.contacts[1].name, face_name);
  EXPECT_NEAR(down.trajectory.contacts[0].hold_force, down.metrics.hold_force, 1e-9 * down.metrics.hold_force);
  const std::optional<ClosedEquilibrium> closed = closed_equilibrium(p.model, std::vector<double>{140});
  ASSERT_TRUE(closed);
  const PointQuadrature& points = p.model.quadrature();
  double face = 0;
  for (Eigen::Index k = 0; k < points.points(); ++k) {
    const double depth = 10e-9 - (2e-6 - points.shapes().row(k).dot(closed->q));
    const bool is_over = points.positions()[k] > 30e-6 && points.positions()[k] < 140e-6;
    if (is_over && depth > 0) face += points.weights()[k] * 50e-6 * 1e18 * depth;
  }
  EXPECT_GT(face, 0);
  EXPECT_NEAR(down.trajectory.contacts[1].hold_force, face, 1e-6 * face);

  const Closing above = simulate(over_nitride("60 V"), false);
  EXPECT_GT(above.trajectory.contacts[0].hold_force, 0);
  EXPECT_TRUE(std::isnan(above.trajectory.contacts[1].hold_force));
}

TEST(ClosedState, ThatIsUnstableHasNotSettledAndHoldsNothing) {
  const PreparedScene stable = prepare(bridge({level(0.93 * pulled_through())}));  // stable also with more modes
  const Closing stays = simulate(stable, true);
  EXPECT_TRUE(stays.metrics.settled);
  EXPECT_GT(stays.metrics.hold_force, 0);
  const PreparedScene unstable = prepare(bridge({level(1.03 * pulled_through())}));
  const ClosedState state = closed_state(unstable, unstable.signals());
  EXPECT_TRUE(state.exists);
  EXPECT_EQ(state.stable, false);
  EXPECT_LT(state.smallest_eigenvalue, 0);
  const Closing leaves = simulate(unstable, true);
  ASSERT_GT(leaves.metrics.initial_contact_time, 0);
  EXPECT_FALSE(leaves.metrics.settled);
  EXPECT_TRUE(std::isnan(leaves.metrics.hold_force));
  EXPECT_THAT(leaves.warnings, testing::Contains(HasSubstr("closed equilibrium is unstable")));
}

TEST(ClosedState, OfOneModeBetweenTwoClampsIsJudgedByMore) {
  const SceneFile file = bridge({level(1.2 * pulled_through()), "structure.modes=1", "simulate.accuracy=1e-3"});
  const ClosedState state = state_at(file);
  EXPECT_TRUE(state.exists);
  EXPECT_GT(state.smallest_eigenvalue, 0) << "one mode has no motion to one side";
  EXPECT_EQ(state.stable, false);
  EXPECT_THAT(warning(state), HasSubstr("do not keep the switch closed"));
  EXPECT_FALSE(simulate(prepare(file), false).metrics.settled);
}

TEST(ClosedState, DevicesThatAreNotHeldHaveNotSettled) {
  // Softer devices collapse onto the electrode at lower voltages.
  SceneFile file = bridge({level(0.99 * pulled_through())});
  file.set("spread.\"structure.residual_stress\"={ distribution = \"normal\", standard_deviation = \"5 MPa\" }");
  const PreparedScene p = prepare(file);
  const Ensemble ensemble(p, 40, 3);
  const EnsembleRun run{.duration = p.duration, .tolerance = 1e-6, .jobs = 2};
  std::size_t settled = 0, left = 0;
  const auto outcomes = close_all(ensemble, {{.waveforms = p.waveforms()}}, run);
  ASSERT_EQ(outcomes.size(), 1U);
  DeviceBuilder builder(ensemble);
  for (std::size_t k = 0; k < outcomes[0].size(); ++k) {
    const DeviceOutcome& o = outcomes[0][k];
    const SampledDevice device = builder.device(k);
    const auto closed = closed_equilibrium(*device.model, hold_levels(p.signals()));
    const bool stays = closed && closed->smallest_eigenvalue > 0;
    EXPECT_TRUE(stays || !o.metrics.settled) << k;
    settled += o.metrics.settled;
    left += o.closed() && !stays;
  }
  EXPECT_GT(settled, 0U);
  EXPECT_GT(left, 0U);
}

// Starts the devices of a scene from the closed equilibrium of the nominal one. The result must be that of the search from the
// contact plane.
void expect_the_same_near(const PreparedScene& p, const std::vector<double>& volts, std::uint64_t devices) {
  const auto nominal = closed_equilibrium(p.model, volts);
  if (!nominal) return;
  constexpr double same = 1e-9;  // difference over the contact force: both are solved up to rounding
  const Ensemble ensemble(p, devices, 5);
  DeviceBuilder builder(ensemble);
  for (std::uint64_t k = 0; k < devices; ++k) {
    const SampledDevice device = builder.device(k);
    if (!device.model) continue;
    const auto walked = closed_equilibrium(*device.model, volts), found = closed_equilibrium_near(*device.model, volts, *nominal);
    EXPECT_EQ(keeps_closed(*device.model, found), keeps_closed(*device.model, walked)) << p.scene.file.name() << k;
    if (!found || !walked) continue;
    EXPECT_NEAR(found->contact_force, walked->contact_force, same * walked->contact_force) << k;
  }
}

TEST(ClosedState, OfADeviceIsFoundFromThatOfTheNominalOne) {
  for (const std::string& name : shipped_scenes()) {
    const PreparedScene p = prepare(scene(name.c_str()));
    if (p.scene.spread.empty() || !p.model.has_contact()) continue;
    for (const double share : {0.8, 1.0, 1.3}) {
      std::vector<double> volts = hold_levels(p.signals());
      for (double& level : volts) level *= share;
      expect_the_same_near(p, volts, 60);
    }
  }
}

TEST(ClosedState, IsFoundByContinuationWhereNewtonsMethodFails) {
  for (const SceneFile& file : {gold(), bridge({level(40)})}) {
    const PreparedScene p = prepare(file);
    const std::vector<double> volts = hold_levels(p.signals());
    const ClosedEquilibrium nowhere{.q = Eigen::VectorXd::Constant(p.model.modes(), std::nan(""))};
    const auto walked = closed_equilibrium(p.model, volts), found = closed_equilibrium_near(p.model, volts, nowhere);
    ASSERT_TRUE(walked && found) << file.name();
    EXPECT_EQ(found->contact_force, walked->contact_force) << file.name();
  }
}

TEST(ClosedState, UnderAPiezoAloneIsFoundWhileTheElectrodeStandsAtZero) {
  SceneFile file = scene("mem-gold-pzt.toml");
  for (const char* change : {"waveform.main.level=0 V", "waveform.piezo={family=\"step\",level=\"-1 V\"}"}) file.set(change);
  const PreparedScene p = prepare(file);
  const ClosedState state = closed_state(p, p.signals());
  EXPECT_TRUE(state.stable.value_or(false));
}

TEST(ClosedState, OfADeviceThatIsPulledThroughIsNotFoundFromOneThatHolds) {
  SceneFile file = bridge({level(0.99 * pulled_through())});
  file.set("spread.\"structure.residual_stress\"={ distribution = \"normal\", standard_deviation = \"5 MPa\" }");
  const PreparedScene p = prepare(file);
  expect_the_same_near(p, hold_levels(p.signals()), 40);
}

TEST(ClosedState, OfEveryShippedSceneIsStableBelowWhereItIsPulledThrough_optimized) {
  for (const auto& entry : std::filesystem::directory_iterator(std::string(SOFTLAND_SOURCE_DIR) + "/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const PreparedScene p = prepare(SceneFile::load(entry.path().string()));
    if (!p.model.has_contact()) continue;
    const ClosedState state = closed_state(p, p.signals());
    if (!state.exists) continue;
    EXPECT_NE(state.stable, false) << entry.path();
    const std::vector<double> volts = hold_levels(p.signals());
    for (std::size_t k = 0; k < p.scene.device.electrodes.size(); ++k) {
      const auto found = state.pulled_through.find(p.scene.device.electrodes[k].name);
      if (found == state.pulled_through.end() || !std::isfinite(found->second)) continue;
      EXPECT_GT(found->second, volts[k]) << entry.path();
    }
  }
}

TEST(OpenState, ThatIsUnstableIsWarnedOf) {
  for (const double volts : {8.0, 17.5}) {
    const SceneFile file = SceneFile::parse(fmt::format(R"(
[structure]
kind = "plate"
mass = "2.7e-11 kg"
stiffness = "1.92 N/m"
area = "10000 um^2"
[gap]
electrode = "3 um"
contact = "2.9 um"
[electrode.main]
fringing = "none"
side = "both"
gap = "3 um"
[waveform.main]
family = "step"
level = "{} V"
[simulate]
duration = "1 ms"
)",
                                                        volts),
                                            "plate.toml");
    const PreparedScene p = prepare(file);
    const Closing c = simulate(p, false);
    EXPECT_EQ(c.metrics.status, volts > 17.1 ? Status::no_contact : Status::open);
    const auto warned = testing::Contains(HasSubstr("unstable equilibrium"));
    // For a displacement x the two electrodes pull with eps A V^2 x 2 / g^3, and the spring with k x: unstable from 17.1 V on.
    if (volts > 17.1) {
      EXPECT_THAT(c.warnings, warned);
    } else {
      EXPECT_THAT(c.warnings, testing::Not(warned));
    }
  }
}

// An independent scan for the highest voltage that holds a switch, in steps of 2 % of the distance to its release voltage.
double last_held(const Switch& model, double release) {
  double last = std::nan("");
  for (double above = 1e-6; above < 1; above *= 1.02) {
    const std::vector<double> volts{release * (1 + above)};
    if (!keeps_closed(model, closed_equilibrium(model, volts))) {
      if (std::isfinite(last)) return last;
      continue;
    }
    last = volts[0];
  }
  return std::nan("");
}

TEST(PullThrough, IsFoundHoweverNarrowTheWindowAboveTheReleaseVoltage) {
  // Closed form for a plate on a contact of stiffness kc: V^2 = 2 (d - y)^2 (k y + kc (y - dt)) / (eps0 A) is largest at y =
  // d/3 + 2 kc dt/(3 (k + kc)).
  constexpr double k = 42, area = 1e-8, d = 3.8e-6, dt = 2.6e-6;
  for (const double kc : {200.0, 240.0, 270.0, 280.0, 300.0, 500.0, 2000.0}) {
    const double y = d / 3 + 2 * kc * dt / (3 * (k + kc));
    const double end = (d - y) * std::sqrt(2 * (k * y + kc * (y - dt)) / (vacuum_permittivity * area));
    const SceneFile file = spring_plate({fmt::format("contact.stiffness={} N/m", kc)});
    const Switch model(read_scene(file).device);
    const ClosedRange range = closed_range(model, 0, {0});
    constexpr double precision = 2e-6;  // twice the precision of pull_through_voltage()
    EXPECT_NEAR(range.pulled_through, end, precision * end) << kc;
    constexpr double step = 0.02;  // step of the scan over the distance to the release voltage
    const double scanned = last_held(model, range.release);
    EXPECT_GE(range.pulled_through, scanned * (1 - precision)) << kc;
    EXPECT_LE(range.pulled_through, (range.release + (scanned - range.release) * (1 + step)) * (1 + precision)) << kc;
    // A start above the collapse voltage gives the same result.
    const std::vector<double> beyond{1.2 * end};
    EXPECT_NEAR(pull_through_voltage(model, 0, beyond), end, precision * end) << kc;
  }
}

}  // namespace
}  // namespace softland::closed_state_test
