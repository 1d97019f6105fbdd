// Energy balance: the work of the sources is stored or dissipated, for any combination of effects and waveforms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/contact/contact_law.h"
#include "model/forces/electrostatic.h"
#include "model/pull_in.h"
#include "tests/model/gold.h"
#include "tests/support/devices.h"
#include "waveforms/harmonic.h"
#include "waveforms/pulse.h"

namespace softland {
namespace {

using namespace literals;
using test::step_level;

struct Loss {
  std::string name;
  bool gas;
  double damping_ratio;
};

std::vector<Signal> waveforms(int kind, double volts, bool layer) {
  std::vector<Signal> drives;
  if (kind == 0) {
    drives = {Signal::constant(volts)};
  } else if (kind == 1) {
    drives = {signal(Pulse{.levels = {volts, 0.8 * volts, volts}, .times = {20_us, 40_us}, .edge = 2_us})};
  } else {
    drives = {
        signal(Harmonic{.base = volts, .amplitude = 0.1 * volts, .angular_frequency = 4e5_rad_s, .end = 80_us, .fade = 10_us})};
  }
  if (layer) {
    drives.push_back(kind == 0 ? Signal::constant(-0.05)
                               : signal(Pulse{.levels = {0.1_V, -0.1_V, 0_V}, .times = {15_us, 40_us}, .edge = 5_us}));
  }
  return drives;
}

void expect_balanced(bool layer, const Loss& loss, const Contact& contact, int kind) {
  constexpr double tolerance = 1e-9;
  constexpr double balance = 1e-6;   // residual over the sources' work that users may rely on
  constexpr double measured = 1e-7;  // five times the largest observed residual
  Device d = layer ? test::gold_pzt_cantilever() : test::gold_cantilever();
  if (!loss.gas) d.gas.reset();
  d.structure.damping_ratio = loss.damping_ratio;
  d.contacts = {contact};
  const Switch model(d);
  const Trajectory t =
      simulate_closing(model, waveforms(kind, layer ? 28_V : step_level, layer), {.duration = 150_us, .tolerance = tolerance});
  const std::string name =
      fmt::format("piezo {}, loss {}, contact {}, waveform {}", layer, loss.name, test::described(contact), kind);
  ASSERT_EQ(t.status, Status::done) << name;
  EXPECT_GE(t.touches.size(), std::holds_alternative<AdhesiveRepulsiveSurfaces>(contact.model) ? 2u : 3u)
      << name;  // its adhesion holds the beam
  EXPECT_GT(t.energy.source_work, 0) << name;
  EXPECT_LT(std::abs(t.energy.residual()), balance * t.energy.source_work) << name;
  EXPECT_LT(std::abs(t.energy.residual()), measured * t.energy.source_work) << name;
  if (loss.gas || loss.damping_ratio > 0) {
    EXPECT_GT(t.energy.dissipated, 0.01 * t.energy.source_work) << name;
  } else if (test::damping(contact) > 0 || has_memory(model.contact())) {
    EXPECT_GT(t.energy.dissipated, 1e-4 * t.energy.source_work) << name;
  } else {
    EXPECT_EQ(t.energy.dissipated, 0) << name;
  }
}

// Calls f(layer, loss, contact) for every combination.
template <class F>
void for_every_switch(F&& f) {
  for (const bool layer : {false, true}) {
    for (const Loss& loss :
         {Loss{"none", false, 0}, Loss{"gas", true, 0}, Loss{"modal", false, 0.02}, Loss{"both", true, 0.02}}) {
      for (const Contact& contact : test::contacts()) f(layer, loss, contact);
    }
  }
}

// Each switch has one waveform, so that every pair of layer, loss, contact and waveform occurs.
TEST(EnergyBalance, ClosesOverSeveralBouncesForEveryPair) {
  std::map<std::string, int> next;  // waveform, per contact
  for_every_switch([&](bool layer, const Loss& loss, const Contact& contact) {
    const auto* const plastic = std::get_if<PlasticAsperities>(&contact.model);
    const std::string name =
        fmt::format("{} {}", test::described(contact), plastic ? name_of(plasticities, plastic->plasticity) : "");
    const auto [at, fresh] = next.try_emplace(name, static_cast<int>(next.size()));
    expect_balanced(layer, loss, contact, at->second++ % 3);
  });
}

TEST(ExhaustiveEnergyBalance, ClosesOverSeveralBouncesForEveryCombination_optimized) {
  for_every_switch([](bool layer, const Loss& loss, const Contact& contact) {
    for (const int kind : {0, 1, 2}) expect_balanced(layer, loss, contact, kind);
  });
}

TEST(EnergyBalance, ClosesForEveryContactAlongThePad) {
  for (const bool gas : {false, true}) {
    for (const Contact& contact : test::pad_contacts()) {
      Device d = test::gold_cantilever();
      if (!gas) d.gas.reset();
      d.contacts = {contact};
      const Trajectory t = simulate_closing(Switch(d), waveforms(1, step_level, false), {.duration = 100_us, .tolerance = 1e-9});
      const std::string name = fmt::format("gas {}, contact {}", gas, test::described(contact));
      ASSERT_EQ(t.status, Status::done) << name;
      EXPECT_GE(t.touches.size(), 2u) << name;
      EXPECT_LT(std::abs(t.energy.residual()), 1e-7 * t.energy.source_work) << name;
      EXPECT_EQ(t.energy.dissipated > 1e-4 * t.energy.source_work, gas || test::damping(contact) > 0) << name;
    }
  }
}

TEST(EnergyBalance, ClosesForEveryFringingFactor) {
  for (const FringingRow& fringing : fringing_laws) {
    Device d = test::gold_cantilever();
    d.electrodes[0].fringing = fringing.value;
    const std::vector<Signal> drives = waveforms(1, step_level, false);
    const Trajectory t = simulate_closing(Switch(d), drives, {.duration = 100_us, .tolerance = 1e-9});
    ASSERT_EQ(t.status, Status::done);
    EXPECT_LT(std::abs(t.energy.residual()), 1e-7 * t.energy.source_work) << fringing.name;
  }
}

TEST(EnergyBalance, ClosesForEveryGasModel) {
  for (const Gas& gas : test::gases()) {
    Device d = test::gold_cantilever();
    d.gas = gas;
    const std::vector<Signal> drives = waveforms(1, step_level, false);
    const Trajectory t = simulate_closing(Switch(d), drives, {.duration = 100_us, .tolerance = 1e-9});
    ASSERT_EQ(t.status, Status::done) << name_of(gas);
    EXPECT_GE(t.touches.size(), 2u) << name_of(gas);
    EXPECT_LT(std::abs(t.energy.residual()), 1e-7 * t.energy.source_work) << name_of(gas);
    EXPECT_GT(t.energy.dissipated, 0.001 * t.energy.source_work) << name_of(gas);
  }
}

TEST(EnergyBalance, ClosesBetweenTwoClamps) {
  for (const bool gas : {false, true}) {
    for (const bool stretching : {false, true}) {
      Device d = test::gold_bridge();
      if (!gas) d.gas.reset();
      part_of<Bridge>(d.structure).stretches = stretching;
      const Switch model(d);
      const std::vector<Signal> drives{Signal::constant(static_pull_in(model, 0).voltage),
                                       signal(Pulse{.levels = {30_V, 0_V}, .times = {2_us}, .edge = 0.5_us})};
      const Trajectory t = simulate_closing(model, drives, {.duration = 20_us, .tolerance = 1e-9});
      ASSERT_EQ(t.status, Status::done) << t.message;
      EXPECT_GE(t.touches.size(), 2u) << gas << stretching;
      EXPECT_EQ(t.energy.dissipated > 0, gas);
      EXPECT_LT(std::abs(t.energy.residual()), 1e-7 * t.energy.source_work) << gas << stretching;
    }
  }
}

TEST(EnergyBalance, ClosesForThePlate) {
  for (const bool gas : {false, true}) {
    for (const double damping : {0.0, 0.02}) {
      for (const double restitution : {-1.0, 0.0, 0.4, 0.9}) {
        Device d = test::full_plate();
        if (!gas) d.gas.reset();
        const bool rigid = restitution >= 0;
        if (rigid) d.contacts = {Contact{.model = RigidStop{.restitution = restitution}}};
        d.structure.damping_ratio = damping;
        const std::vector<Signal> drives{Signal::constant(110),
                                         signal(Pulse{.levels = {50_V, 0_V}, .times = {10_us}, .edge = 2_us})};
        const Trajectory t = simulate_closing(Switch(d), drives, {.duration = 150_us, .tolerance = 1e-9});
        ASSERT_EQ(t.status, Status::done) << t.message;
        EXPECT_GE(t.touches.size(), restitution == 0 ? 1u : 2u) << gas << damping << restitution;
        EXPECT_EQ(t.energy.dissipated > 0, gas || damping > 0 || rigid);
        EXPECT_LT(std::abs(t.energy.residual()), 1e-7 * t.energy.source_work) << gas << damping << restitution;
      }
    }
  }
}

TEST(EnergyBalance, ClosesForEveryDispersionForceWhileItsFactorChanges) {
  constexpr double balance = 1e-6;  // residual over the energy that bends the beam by the contact gap
  for (const DispersionModel law : {DispersionModel::casimir, DispersionModel::van_der_waals, DispersionModel::automatic}) {
    for (const Conductor conductor : {Conductor::ideal, Conductor::gold}) {
      for (const double edge : {0.0, 0.3}) {
        Device d = test::casimir_cantilever();
        // The force is so weak that every law leaves an open state, and the crossover of `auto` is within the travel.
        d.structure.length = 3_um;
        d.dispersion =
            Dispersion{.model = law, .conductor = conductor, .hamaker_constant = 6e-19, .equilibrium_distance = 0.4_nm};
        if (law == DispersionModel::automatic && conductor == Conductor::gold) d.dispersion->hamaker_constant = 1.2e-19;
        const Switch model(d);
        ASSERT_TRUE(model.rest().has_value());
        const double period = 2 * pi / model.basis().angular_frequencies()[0];
        const StaticPullIn fold = static_pull_in(model, 0);
        ASSERT_EQ(fold.status, Status::done);
        const std::vector<Signal> drives{signal(Pulse{.levels = {1.4 * fold.voltage, 0.9 * fold.voltage, 1.2 * fold.voltage},
                                                      .times = {period, 2 * period},
                                                      .edge = edge * period})};
        const Trajectory t = simulate_closing(model, drives, {.duration = 4 * period, .tolerance = 1e-9});
        const std::string name =
            fmt::format("model {}, conductor {}, edge {}", static_cast<int>(law), static_cast<int>(conductor), edge);
        ASSERT_EQ(t.status, Status::done) << name << ": " << t.message;
        EXPECT_GE(t.touches.size(), 1u) << name;
        EXPECT_LT(std::abs(t.energy.source_work), 1e3 * model.bending_energy()) << name;
        EXPECT_LT(t.energy_error, balance * model.bending_energy()) << name;
        EXPECT_GT(t.energy.dissipated, 0.01 * model.bending_energy()) << name;
      }
    }
  }
}

TEST(EnergyBalance, ClosesWhenAVoltageAndADispersionForceClose) {
  const Switch model(test::nano_cantilever());
  const std::vector<Signal> drives{signal(Pulse{.levels = {16_V, 10_V, 16_V}, .times = {1e-9, 2e-9}, .edge = 2e-10}),
                                   signal(Pulse{.levels = {0.5, -0.5}, .times = {1.5e-9}, .edge = 1e-10})};
  const Trajectory t = simulate_closing(model, drives, {.duration = 10e-9, .tolerance = 1e-9});
  ASSERT_EQ(t.status, Status::done) << t.message;
  EXPECT_GE(t.touches.size(), 2u);
  EXPECT_LT(std::abs(t.energy.residual()), 1e-6 * t.energy.source_work);
}

TEST(Rest, IsWhereARunBegins) {
  const Switch model(test::casimir_cantilever());
  ASSERT_TRUE(model.rest().has_value());
  const double tip = model.contact_deflection(model.rest()->data());
  EXPECT_GT(tip, 1_nm);
  // The tip stays at rest under the nominal force. The steps of an explicit method grow at rest until the motion by rounding
  // reaches the tolerance.
  const std::vector<Signal> drives(1);
  const Trajectory t = simulate_closing(model, drives, {.duration = 1_us, .tolerance = 1e-9});
  EXPECT_EQ(t.status, Status::done);
  for (const TrajectoryPoint& p : t.points) EXPECT_NEAR(p.position, tip, 1e-6 * tip);
}

TEST(Rest, IsMissingWhereTheForceClosesTheSwitchByItself) {
  Device d = test::casimir_cantilever();
  d.structure.length = 6_um;
  const Switch model(d);
  EXPECT_FALSE(model.rest().has_value());
  const Trajectory t = simulate_closing(model, std::vector<Signal>(1), {.duration = 1_us});
  EXPECT_EQ(t.status, Status::collapsed_at_rest);
  EXPECT_TRUE(t.touches.empty());
  EXPECT_LT(static_pull_in(model, 0).voltage, 0);
  EXPECT_EQ(dynamic_pull_in(model, 0, static_pull_in(model, 0)).status, Status::collapsed_at_rest);
}

TEST(Rest, OfASwitchWithoutDispersionForceIsTheStraightBeam) {
  const Switch model(test::gold_cantilever());
  ASSERT_TRUE(model.rest().has_value());
  EXPECT_TRUE(model.rest()->isZero(0));
}

TEST(EnergyBalance, ClosesBetweenElectrodes) {
  const Signal braking = signal(Pulse{.levels = {0_V, 60_V, 0_V}, .times = {10_us, 25_us}, .edge = 2_us});
  const Trajectory plate =
      simulate_closing(Switch(test::plate_between_electrodes()), std::vector<Signal>{Signal::constant(110), braking},
                       {.duration = 150_us, .tolerance = 1e-9});
  const Trajectory beam = simulate_closing(Switch(test::cantilever_between_electrodes()),
                                           std::vector<Signal>{Signal::constant(20), braking, Signal::constant(10)},
                                           {.duration = 150_us, .tolerance = 1e-9});
  for (const Trajectory& t : {plate, beam}) {
    ASSERT_EQ(t.status, Status::done) << t.message;
    EXPECT_GE(t.touches.size(), 2u);
    EXPECT_GT(t.energy.dissipated, 0);
    EXPECT_LT(std::abs(t.energy.residual()), 1e-7 * t.energy.source_work);
  }
}

TEST(EnergyBalance, ResidualFallsWithTheTolerance) {
  const Switch model(test::gold_cantilever());
  const std::vector<Signal> drives{Signal::constant(step_level)};
  const auto residual = [&](double tolerance) {
    const Trajectory t = simulate_closing(model, drives, {.duration = 60_us, .tolerance = tolerance});
    return std::abs(t.energy.residual() / t.energy.source_work);
  };
  const double slope = std::log10(residual(1e-6) / residual(1e-9)) / 3;
  EXPECT_GT(slope, 0.7);
  EXPECT_LT(slope, 1.3);
}

TEST(EnergyBalance, OfEveryRunIsCheckedAtEveryTouch) {
  const Switch model(test::gold_cantilever());
  const std::vector<Signal> drives{Signal::constant(step_level)};
  const auto run = [&](double tolerance) {
    return simulate_closing(model, drives, {.duration = 100_us, .tolerance = tolerance, .integrator = Integrator::arkode_erk});
  };
  // Observed: 3.2e-5 of the bending energy at 1e-6, 4 % at 1e-3, almost five times the bending energy at 1e-2.
  const Trajectory good = run(1e-6);
  EXPECT_LT(good.energy_error, 1e-4 * model.bending_energy());
  EXPECT_GE(good.energy_error, std::abs(good.energy.residual()));
  EXPECT_TRUE(good.warnings.empty());

  const Trajectory loose = run(1e-3);
  EXPECT_EQ(loose.status, Status::done);
  ASSERT_EQ(loose.warnings.size(), 1u);
  EXPECT_NE(loose.warnings[0].find("energy balance: "), std::string::npos) << loose.warnings[0];

  const Trajectory wild = run(1e-2);
  EXPECT_EQ(wild.status, Status::numerical_failure);
  EXPECT_NE(wild.message.find("of the bending energy: the tolerance 0.01 is too loose"), std::string::npos) << wild.message;
}

TEST(EnergyBalance, ShowsWhatTooLooseATolerancePutsIn) {
  Device d = test::gold_cantilever();
  d.contacts.front().model = LinearSpring{.stiffness = 1e9_N_m};
  const Switch model(d);
  const std::vector<Signal> drives{Signal::constant(step_level)};
  const auto run = [&](Integrator integrator, double tolerance) {
    return simulate_closing(model, drives, {.duration = 100_us, .tolerance = tolerance, .integrator = integrator});
  };
  const Trajectory loose = run(Integrator::arkode_erk, 1e-2);
  EXPECT_EQ(loose.status, Status::numerical_failure);
  EXPECT_NE(loose.message.find("residual of the energy balance"), std::string::npos) << loose.message;
  EXPECT_GT(loose.energy_error, 0.5 * model.bending_energy());
  // Long steps alone are harmless: so stiff a contact is located at the plane, not at the end of the flight's interpolant.
  for (const Integrator integrator : {Integrator::esdirk, Integrator::bdf}) {
    const Trajectory t = run(integrator, 1e-3);
    EXPECT_EQ(t.status, Status::done) << t.message;
    EXPECT_LT(t.energy_error, 0.1 * model.bending_energy());
  }
}

TEST(DriveEnergy, OfAStepIsChargingAtRestPlusVoltageTimesTheMovedCharge) {
  const Switch model(test::gold_cantilever());
  Switch::Workspace work = model.workspace();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.modes());
  const std::vector<Signal> drives{Signal::constant(step_level)};
  Eigen::VectorXd last = rest;
  const Trajectory t =
      simulate_closing(model, drives, {.duration = 60_us, .observer = [&](double, const double* q, const double*) {
                                         last = Eigen::Map<const Eigen::VectorXd>(q, model.modes());
                                         return false;
                                       }});
  const double at_rest = model.capacitance(0, rest.data(), work), at_end = model.capacitance(0, last.data(), work);
  const double expected = step_level * step_level * (at_rest / 2 + (at_end - at_rest));
  EXPECT_NEAR(t.energy.source_work, expected, 1e-12 * expected);
}

TEST(DriveEnergy, OfAJumpIsTheLimitOfSteepEdges) {
  const Switch model(test::gold_pzt_cantilever());
  const auto run = [&](double edge) {
    const std::vector<Signal> drives{signal(Pulse{.levels = {28_V, 20_V, 28_V}, .times = {10_us, 16_us}, .edge = edge}),
                                     signal(Pulse{.levels = {0.1_V, -0.1_V, 0_V}, .times = {9_us, 17_us}, .edge = edge})};
    return simulate_closing(model, drives, {.duration = 60_us, .tolerance = 1e-9});
  };
  constexpr double same = 1e-6;  // relative: a picosecond is 1e-8 of the closing time
  const Trajectory jump = run(0), steep = run(1e-12);
  ASSERT_FALSE(jump.touches.empty());
  ASSERT_FALSE(steep.touches.empty());
  EXPECT_NEAR(steep.touches[0].begin, jump.touches[0].begin, same * jump.touches[0].begin);
  EXPECT_NEAR(steep.touches[0].impact_velocity, jump.touches[0].impact_velocity, same * jump.touches[0].impact_velocity);
  EXPECT_NEAR(steep.energy.source_work, jump.energy.source_work, 10 * same * jump.energy.source_work);
  EXPECT_LT(std::abs(jump.energy.residual()), 1e-7 * jump.energy.source_work);
  EXPECT_LT(std::abs(steep.energy.residual()), 1e-7 * steep.energy.source_work);
}

TEST(LandingExcess, WithoutLossesIsTheEnergyAtRestAboveTheClosedEquilibrium) {
  Device d = test::gold_cantilever();
  d.gas.reset();
  const Switch model(d);
  const std::vector<double> volts{step_level};
  const auto closed = closed_equilibrium(model, volts);
  ASSERT_TRUE(closed.has_value());
  const std::vector<Signal> drives{Signal::constant(step_level)};
  const Trajectory t = simulate_closing(
      model, drives, {.duration = 60_us, .tolerance = 1e-9, .after_contact = 1_us, .closed_potential = closed->potential});
  Switch::Workspace work = model.workspace();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.modes());
  const double expected = model.potential(rest.data(), volts, false, work) - closed->potential;
  EXPECT_GT(expected, 0);
  EXPECT_NEAR(t.landing_excess, expected, 1e-6 * expected);
}

TEST(LandingExcess, WaitsForTheHoldLevels) {
  const Switch model(test::gold_cantilever());
  const auto closed = closed_equilibrium(model, std::vector<double>{step_level});
  ASSERT_TRUE(closed.has_value());
  // The last edge ends after the window, so that the drives never are at their hold levels.
  const std::vector<Signal> drives{signal(Pulse{.levels = {step_level, 0.9 * step_level}, .times = {90_us}, .edge = 1_us})};
  const ClosingOptions options{.duration = 80_us, .closed_potential = closed->potential};
  EXPECT_FALSE(simulate_closing(model, drives, options).touches.empty());
  EXPECT_TRUE(std::isnan(simulate_closing(model, drives, options).landing_excess));
}

TEST(Contact, StoresNoMoreThanTheFieldHasGiven) {
  // The energy of a lossless contact is at most the work of the field, (C - C0) V^2 / 2. A tip that moves through a stiff
  // contact would store orders of magnitude more.
  for (const double stiffness : {1e5, 1e7, 1e9}) {
    Device d = test::gold_cantilever();
    d.gas.reset();
    d.contacts.front().model = LinearSpring{.stiffness = stiffness};
    const Switch model(d);
    Switch::Workspace work = model.workspace();
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.modes());
    const double at_rest = model.capacitance(0, rest.data(), work);
    const std::vector<Signal> drives{Signal::constant(step_level)};
    for (const Integrator integrator :
         {Integrator::lawson, Integrator::arkode_erk, Integrator::esdirk, Integrator::bdf, Integrator::adams}) {
      for (const double tolerance : {1e-4, 1e-6}) {
        double given = 0;
        const Trajectory t =
            simulate_closing(model, drives,
                             {.duration = 60_us,
                              .tolerance = tolerance,
                              .integrator = integrator,
                              .observer = [&](double, const double* q, const double*) {
                                given = std::max(given, (model.capacitance(0, q, work) - at_rest) * step_level * step_level / 2);
                                return false;
                              }});
        ASSERT_FALSE(t.touches.empty());
        for (const Touch& touch : t.touches) EXPECT_LT(touch.peak_energy, 0.5 * given) << stiffness << " N/m";
        EXPECT_LT(t.deepest_penetration, std::sqrt(given / stiffness)) << stiffness << " N/m";
      }
    }
  }
}

}  // namespace
}  // namespace softland
