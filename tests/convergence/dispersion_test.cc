// Dispersion forces on ideal beams against an independent program: the integral equation of the beam (Green's function, no modes)
// with displacement control.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "base/literals.h"
#include "model/forces/casimir.h"
#include "model/pull_in.h"
#include "tests/convergence/ideal_cantilever.h"

namespace softland {
namespace {

using namespace literals;
using test::converged_modes;
using test::IdealCantilever;

constexpr double printed_digits = 1e-6;  // absolute: the reference prints six decimals

double rigidity(const Structure& s) { return part_of<Beam>(s).youngs_modulus * s.width * std::pow(s.thickness, 3) / 12; }

/// al4 = pi^2 hbar c a L^4 / (240 g^5 EI)
double casimir_parameter(const Device& d) {
  return casimir_strength * d.structure.width * std::pow(d.structure.length, 4) /
         (std::pow(d.gap.electrode, 5) * rigidity(d.structure));
}

/// al3 = A a L^4 / (6 pi g^4 EI)
double van_der_waals_parameter(const Device& d) {
  return d.dispersion->hamaker_constant * d.structure.width * std::pow(d.structure.length, 4) /
         (6 * pi * std::pow(d.gap.electrode, 4) * rigidity(d.structure));
}

Device casimir_cantilever() {
  Device d = test::device({.modes = converged_modes});
  d.dispersion = Dispersion{.model = DispersionModel::casimir};
  return d;
}

/// Static pull-in by the dispersion force: factor, and tip deflection over the gap.
struct ForceFold {
  double factor, tip;
};
ForceFold fold_of_the_force(Device d) {
  d.electrodes.clear();
  const StaticPullIn found = static_pull_in(Switch(d), 0);
  EXPECT_EQ(found.status, Status::done);
  EXPECT_EQ(found.kind, StaticKind::fold);
  return {1 + found.voltage, found.deflection / d.gap.electrode};
}

TEST(Dispersion, CasimirForceBeyondTheReferenceParameterCollapsesTheCantilever) {
  const Device d = casimir_cantilever();
  const ForceFold found = fold_of_the_force(d);
  EXPECT_NEAR(found.factor * casimir_parameter(d), 0.939179, printed_digits);
  EXPECT_NEAR(found.tip, 0.272254, 2 * printed_digits);
}

TEST(Dispersion, VanDerWaalsForceBeyondTheReferenceParameterCollapsesTheCantilever) {
  Device d = test::device({.modes = converged_modes});
  d.dispersion = Dispersion{.model = DispersionModel::van_der_waals, .hamaker_constant = 4e-19};
  const ForceFold found = fold_of_the_force(d);
  EXPECT_NEAR(found.factor * van_der_waals_parameter(d), 1.204837, printed_digits);
  EXPECT_NEAR(found.tip, 0.338429, 2 * printed_digits);
}

TEST(Dispersion, BeamsBetweenTwoClampsBearTheReferenceParameters) {
  constexpr double printed = 1e-6;  // relative: the reference has seven digits
  Device d = casimir_cantilever();
  d.structure.kind = Bridge{part_of<Beam>(d.structure)};
  part_of<Bridge>(d.structure).stretches = false;
  d.structure.modes = 20;  // ten of them symmetric
  const ForceFold retarded = fold_of_the_force(d);
  EXPECT_NEAR(retarded.factor * casimir_parameter(d), 39.01398, printed * 39.01398);
  EXPECT_NEAR(retarded.tip, 0.240354, 2 * printed_digits);
  d.dispersion = Dispersion{.model = DispersionModel::van_der_waals, .hamaker_constant = 4e-19};
  const ForceFold near = fold_of_the_force(d);
  EXPECT_NEAR(near.factor * van_der_waals_parameter(d), 50.11591, printed * 50.11591);
  EXPECT_NEAR(near.tip, 0.299410, 2 * printed_digits);
}

TEST(Dispersion, LowersTheStaticPullInAsTheReferenceDoes) {
  struct Row {
    double al4, beta;
  };
  constexpr std::array<Row, 5> reference{{{0, 1.680841}, {0.2, 1.260409}, {0.4, 0.887246}, {0.8, 0.217098}, {0.9, 0.060439}}};
  for (const Row& row : reference) {
    Device d = casimir_cantilever();
    if (row.al4 == 0) {
      d.dispersion.reset();
    } else {
      // The length for this parameter; the electrode is as long as the beam.
      d.structure.length *= std::pow(row.al4 / casimir_parameter(d), 0.25);
      d.electrodes[0].end = d.structure.length;
    }
    const StaticPullIn found = static_pull_in(Switch(d), 0);
    ASSERT_EQ(found.status, Status::done) << row.al4;
    EXPECT_NEAR(test::beta(d, found.voltage), row.beta, printed_digits) << row.al4;
  }
}

TEST(Dispersion, DetachmentLengthsOfFreestandingBeamsAreTheReference) {
  constexpr double printed = 5e-4;  // relative: three to four digits
  struct Row {
    std::string name;
    double youngs_modulus, thickness, gap, casimir_length, van_der_waals_length;
  };
  const std::array<Row, 4> reference{{{"silicon, wide gap", 169_GPa, 50_nm, 100_nm, 10.62_um, 10.00_um},
                                      {"silicon, narrow gap", 169_GPa, 30_nm, 20_nm, 0.968_um, 1.363_um},
                                      {"titanium nitride", 600_GPa, 30_nm, 20_nm, 1.329_um, 1.871_um},
                                      {"gold", 78_GPa, 50_nm, 50_nm, 3.680_um, 4.121_um}}};
  for (const Row& row : reference) {
    Device d{.structure = {.length = 1_um,
                           .width = 200_nm,
                           .thickness = row.thickness,
                           .kind = Cantilever{{.youngs_modulus = row.youngs_modulus, .density = 5000_kg_m3}}},
             .gap = {.electrode = row.gap, .contact = 0.9 * row.gap}};
    for (const auto& [model, length] : {std::pair{DispersionModel::casimir, row.casimir_length},
                                        std::pair{DispersionModel::van_der_waals, row.van_der_waals_length}}) {
      d.dispersion = Dispersion{.model = model, .hamaker_constant = 4e-19};
      const double found = d.structure.length * std::pow(fold_of_the_force(d).factor, 0.25);
      EXPECT_NEAR(found, length, printed * length) << row.name;
      // Beams that are slightly shorter have a rest position, slightly longer ones have none.
      for (const double part : {0.999, 1.001}) {
        Device near = d;
        near.structure.length = part * found;
        EXPECT_EQ(Switch(near).rest().has_value(), part < 1) << row.name;
      }
    }
  }
}

TEST(Dispersion, AtRestTheBendingBalancesTheForce) {
  // For a small parameter the tip deflects by al4 / 8 of the gap, as under a uniform load.
  Device d = casimir_cantilever();
  d.structure.length *= std::pow(1e-4 / casimir_parameter(d), 0.25);
  d.electrodes[0].end = d.structure.length;
  const Switch model(d);
  ASSERT_TRUE(model.rest().has_value());
  const double tip = model.contact_deflection(model.rest()->data()) / d.gap.electrode;
  EXPECT_NEAR(tip, 1e-4 / 8, 1e-4 / 8 * 1e-3);
}

TEST(Dispersion, DoesNotNeedAFinerQuadratureAtGapsOfNanometres) {
  // A tip that rests in the middle of a gap of 5 nm, under the van der Waals force with its repulsion.
  constexpr double converged = 1e-9;
  Device d{.structure = {.length = 300_nm,
                         .width = 200_nm,
                         .thickness = 30_nm,
                         .kind = Cantilever{{.youngs_modulus = 220_GPa, .density = 5400_kg_m3}}},
           .gap = {.electrode = 5_nm, .contact = 4_nm},
           .electrodes = {{.name = "main", .begin = 0, .end = 300_nm}},
           .dispersion =
               Dispersion{.model = DispersionModel::van_der_waals, .hamaker_constant = 2e-19, .equilibrium_distance = 0.3_nm}};
  const StaticPullIn coarse = static_pull_in(Switch(d), 0), fine = static_pull_in(Switch(d, {.points_per_length = 96}), 0);
  ASSERT_EQ(coarse.status, Status::done);
  EXPECT_NEAR(coarse.voltage, fine.voltage, converged * fine.voltage);
}

}  // namespace
}  // namespace softland
