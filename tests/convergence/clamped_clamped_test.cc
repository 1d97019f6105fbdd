// Pull-in of beams between two clamps, against an independent program: the integral equation of the beam (Green's function, no
// modes) with displacement control. Values for residual stress and stretching are published ones, by shooting (Runge-Kutta of
// order 4).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/pull_in.h"
#include "tests/convergence/ideal_cantilever.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

constexpr int converged_bridge_modes = 20;   // ten of them symmetric
constexpr double reference_beta = 70.09505;  // full-length electrode, no fringing field

/// The ideal beam between two clamps of the literature on pull-in, without stretching.
Device bridge(int modes, double gap_over_width = 0.1, Fringing fringing = Fringing::none) {
  Device d = test::device({.modes = modes, .fringing = fringing, .gap_over_width = gap_over_width});
  d.structure.kind = Bridge{part_of<Beam>(d.structure)};
  part_of<Bridge>(d.structure).stretches = false;
  return d;
}

StaticPullIn bridge_fold(const Device& d) {
  const StaticPullIn found = static_pull_in(Switch(d), 0);
  EXPECT_EQ(found.status, Status::done);
  EXPECT_EQ(found.kind, StaticKind::fold);
  return found;
}

TEST(ClampedClamped, StaticPullInIsTheClassicalNumber) {
  constexpr double printed = 1e-7;  // relative: the reference has seven digits
  const Device d = bridge(converged_bridge_modes);
  const StaticPullIn found = bridge_fold(d);
  EXPECT_NEAR(test::beta(d, found.voltage), reference_beta, printed * reference_beta);
  EXPECT_NEAR(found.deflection / d.gap.electrode, 0.396657, 1e-6);
}

TEST(ClampedClamped, StaticPullInNeedsFewModes) {
  const auto beta = [](int modes) {
    const Device d = bridge(modes);
    return test::beta(d, bridge_fold(d).voltage);
  };
  EXPECT_NEAR(beta(1), reference_beta, 3e-3 * reference_beta);
  EXPECT_NEAR(beta(3), reference_beta, 1e-4 * reference_beta);
  EXPECT_NEAR(beta(5), reference_beta, 1e-5 * reference_beta);
  EXPECT_NEAR(beta(6), beta(5), 1e-10 * reference_beta) << "the sixth mode is antisymmetric";
}

TEST(ClampedClamped, StaticPullInFallsWithFringingAsTheReferenceDoes) {
  // Load 1/(1-W)^2 + gam/(1-W): the `linear` fringing factor with gam = 0.65 g/a.
  constexpr double printed = 2e-6;  // relative: the reference has six digits
  struct Row {
    double gam, beta;
  };
  for (const auto& [gam, expected] :
       {Row{0.05, 67.8111}, Row{0.1, 65.6818}, Row{0.3, 58.4237}, Row{0.65, 49.1026}, Row{1, 42.4427}}) {
    const Device d = bridge(converged_bridge_modes, gam / 0.65, Fringing::linear);
    EXPECT_NEAR(test::beta(d, bridge_fold(d).voltage), expected, printed * expected) << "gam = " << gam;
  }
}

TEST(ClampedClamped, DynamicPullInOfAnUndampedStepIsTheReference) {
  // V_DPI / V_SPI of the distributed static value: 0.9127 to 0.9128 with 1, 3 and 5 modes.
  for (const int modes : {1, 3, 5}) {
    const Device d = bridge(modes);
    const Switch model(d);
    const DynamicPullIn found = dynamic_pull_in(model, 0, static_pull_in(model, 0));
    ASSERT_EQ(found.status, Status::done);
    const double ratio = found.voltage / test::volts(d, reference_beta);
    EXPECT_GT(ratio, 0.91265) << modes << " modes";
    EXPECT_LT(ratio, 0.91285) << modes << " modes";
  }
}

constexpr double shooting_digits = 1e-6;  // relative; truncation of the modes, and error of the shooting program

TEST(ClampedClamped, StaticPullInWithStressAndStretchingIsTheReference) {
  // Osterberg 1995: 50 um wide, 3 um thick, gap 1 um, 169 GPa, nu = 0.06; stretching on, force factor 1 + 0.65 h/a.
  struct Beam {
    double length, stress;
    bool biaxial;
    double volts;
  };
  for (const auto& [length, stress, biaxial, volts] :
       {Beam{350_um, 0, false, 20.0705832}, Beam{350_um, 100e6, false, 36.2739423}, Beam{350_um, 100e6, true, 35.5301542},
        Beam{350_um, -25e6, false, 12.7534104}, Beam{350_um, -25e6, true, 13.3144148}, Beam{250_um, 0, false, 39.3383431},
        Beam{250_um, 100e6, false, 57.9969891}, Beam{250_um, 100e6, true, 57.0660756}, Beam{250_um, -25e6, false, 32.8670907},
        Beam{250_um, -25e6, true, 33.2937698}}) {
    const Device d{
        .structure = {.length = length,
                      .width = 50_um,
                      .thickness = 3_um,
                      .modes = 13,
                      .kind =
                          Bridge{{.youngs_modulus = 169_GPa, .density = 2330_kg_m3, .poissons_ratio = 0.06}, stress, biaxial}},
        .gap = {.electrode = 1_um, .contact = 0.95_um},
        .electrodes = {{.name = "full", .begin = 0, .end = length, .fringing = Fringing::linear}}};
    EXPECT_NEAR(bridge_fold(d).voltage, volts, shooting_digits * volts)
        << length << " m, " << stress << " Pa, biaxial " << biaxial;
  }
}

TEST(ClampedClamped, StaticPullInOfTheHungSenturiaBeamIsTheReference) {
  struct Row {
    double stress;
    bool stretching;
    Fringing fringing;
    double volts;
  };
  for (const Row& row : {Row{-3.7e6, false, Fringing::none, 8.86285670}, Row{-3.7e6, false, Fringing::linear, 8.75321802},
                         Row{-3.7e6, true, Fringing::none, 10.4993973}, Row{-3.7e6, true, Fringing::linear, 10.3918260},
                         Row{0, false, Fringing::none, 13.5629112}, Row{0, true, Fringing::none, 14.4956069}}) {
    Device d = test::hung_senturia();
    d.structure.modes = converged_bridge_modes;
    part_of<Bridge>(d.structure).residual_stress = row.stress;
    part_of<Bridge>(d.structure).stretches = row.stretching;
    d.electrodes[0].fringing = row.fringing;
    EXPECT_NEAR(bridge_fold(d).voltage, row.volts, shooting_digits * row.volts)
        << row.stress << " Pa, stretching " << row.stretching;
  }
}

}  // namespace
}  // namespace softland
