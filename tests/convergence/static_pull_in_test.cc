// Static pull-in of ideal cantilevers against an independent program: the integral equation of the beam (Green's function, no
// modes) with displacement control.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "base/literals.h"
#include "model/pull_in.h"
#include "tests/convergence/ideal_cantilever.h"

namespace softland {
namespace {

using namespace literals;
using test::beta;
using test::converged_modes;
using test::full_length_beta;
using test::full_length_tip;
using test::IdealCantilever;

constexpr double beta_digits = 1e-6;  // absolute: the reference prints six decimals

struct Fold {
  double beta, tip;
};

Fold fold(const IdealCantilever& ideal) {
  const Device d = test::device(ideal);
  const StaticPullIn found = static_pull_in(Switch(d), 0);
  EXPECT_EQ(found.status, Status::done);
  EXPECT_EQ(found.kind, StaticKind::fold);
  return {beta(d, found.voltage), found.deflection / d.gap.electrode};
}

TEST(StaticPullIn, OfTheFullLengthElectrodeIsTheClassicalNumber) {
  constexpr double tip_digits = 1e-6;  // a printed digit; at the fold the voltage hardly depends on the deflection
  const Fold found = fold({.modes = converged_modes});
  EXPECT_NEAR(found.beta, full_length_beta, beta_digits);
  EXPECT_NEAR(found.tip, full_length_tip, tip_digits);
}

TEST(StaticPullIn, NeedsFewModes) {
  EXPECT_NEAR(fold({.modes = 4}).beta, full_length_beta, 2e-6);
  EXPECT_NEAR(fold({.modes = 2}).beta, full_length_beta, 2e-4);
  EXPECT_NEAR(fold({.modes = 1}).beta, full_length_beta, 3e-3);
}

TEST(StaticPullIn, FallsWithFringingAsTheReferenceDoes) {
  // Load 1/(1-W)^2 + gam/(1-W): the `linear` fringing factor with gam = 0.65 g/a.
  struct Row {
    double gam, beta, tip;
  };
  constexpr std::array<Row, 5> reference{{{0.05, 1.625672, 0.450993},
                                          {0.1, 1.574261, 0.455212},
                                          {0.3, 1.399181, 0.470103},
                                          {0.65, 1.174720, 0.490547},
                                          {1, 1.014620, 0.506244}}};
  constexpr double tip_digits = 2e-6;
  for (const Row& row : reference) {
    const Fold found = fold({.modes = converged_modes, .fringing = Fringing::linear, .gap_over_width = row.gam / 0.65});
    EXPECT_NEAR(found.beta, row.beta, beta_digits) << "gam = " << row.gam;
    EXPECT_NEAR(found.tip, row.tip, tip_digits) << "gam = " << row.gam;
  }
}

TEST(StaticPullIn, OfPartialElectrodesIsTheReference) {
  EXPECT_NEAR(fold({.modes = 20, .electrode_begin = 0.25}).beta, 1.698496, beta_digits);
  const Fold middle = fold({.modes = 20, .electrode_begin = 0.2, .electrode_end = 0.8});
  EXPECT_NEAR(middle.beta, 4.146719, 2 * beta_digits);
  EXPECT_NEAR(middle.tip, 0.596, 5e-4);
}

TEST(StaticPullIn, OfAHalfLengthElectrodeAtTheRootIsTheContactNotTheFold) {
  // The reference has its fold at beta = 26.89345, with a tip deflection of 1.056 gaps: the tip reaches the electrode first, at
  // a lower voltage.
  const Device d = test::device({.modes = converged_modes, .electrode_end = 0.5});
  const StaticPullIn found = static_pull_in(Switch(d), 0);
  ASSERT_EQ(found.status, Status::done);
  EXPECT_EQ(found.kind, StaticKind::contact);
  EXPECT_DOUBLE_EQ(found.deflection, d.gap.contact);
  EXPECT_LT(beta(d, found.voltage), 26.89345);
  EXPECT_GT(beta(d, found.voltage), 0.98 * 26.89345);  // near the fold the voltage hardly changes
}

TEST(StaticPullIn, OfPublishedBeamsWithEveryFringingFactorIsTheReference) {
  constexpr double printed = 1e-4;  // relative: the reference has five digits
  struct Beam {
    std::string name;
    double length, width, thickness, gap, youngs_modulus;
    std::array<double, 4> volts;  // none, linear, meijs-fokkema, bao-2001
  };
  const std::array<Beam, 6> beams{
      {{"wide", 300_um, 50_um, 1_um, 2.5_um, 77_GPa, {2.1678, 2.1443, 2.1312, 2.1016}},
       {"wide, plate modulus", 300_um, 50_um, 1_um, 2.5_um, 77_GPa / (1 - 0.33 * 0.33), {2.2965, 2.2715, 2.2576, 2.2264}},
       {"narrow", 300_um, 0.5_um, 1_um, 2.5_um, 77_GPa, {2.1678, 1.2378, 1.2520, 1.3920}},
       {"macroscopic", 0.02_m, 5000_um, 57_um, 92_um, 155.8_GPa, {66.655, 66.385, 66.121, 65.719}},
       {"stiff, wide gap", 100_um, 20_um, 2_um, 4_um, 169_GPa, {165.46, 158.64, 156.31, 150.96}},
       {"stiff, narrow gap", 100_um, 15_um, 3_um, 1_um, 169_GPa, {37.996, 37.449, 36.626, 36.172}}}};
  constexpr std::array fringing{Fringing::none, Fringing::linear, Fringing::meijs_fokkema, Fringing::bao_2001};
  for (const Beam& beam : beams) {
    for (std::size_t f = 0; f < fringing.size(); ++f) {
      const Device d{.structure = {.length = beam.length,
                                   .width = beam.width,
                                   .thickness = beam.thickness,
                                   .modes = converged_modes,
                                   .kind = Cantilever{{.youngs_modulus = beam.youngs_modulus, .density = 2300_kg_m3}}},
                     .gap = {.electrode = beam.gap, .contact = 0.95 * beam.gap},
                     .electrodes = {{.name = "full", .begin = 0, .end = beam.length, .fringing = fringing[f]}}};
      const StaticPullIn found = static_pull_in(Switch(d), 0);
      EXPECT_EQ(found.kind, StaticKind::fold) << beam.name;
      EXPECT_NEAR(found.voltage, beam.volts[f], printed * beam.volts[f]) << beam.name << ", fringing " << f;
    }
  }
}

TEST(StaticPullIn, DoesNotDependOnTheScale) {
  // A beam that is a thousand times smaller in every length has the same beta and relative deflection at pull-in.
  Device small = test::device({.modes = converged_modes});
  Structure& s = small.structure;
  for (double* length :
       {&s.length, &s.width, &s.thickness, &small.gap.electrode, &small.gap.contact, &small.electrodes[0].end.value}) {
    *length /= 1000;
  }
  const StaticPullIn found = static_pull_in(Switch(small), 0);
  ASSERT_EQ(found.status, Status::done);
  EXPECT_NEAR(beta(small, found.voltage), full_length_beta, beta_digits);
  EXPECT_NEAR(found.deflection / small.gap.electrode, full_length_tip, 1e-6);
}

}  // namespace
}  // namespace softland
