#include "model/surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/literals.h"
#include "base/require.h"
#include "model/beam.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

constexpr double relative_rounding = 1e-12;

/// Silicon, faces along [100]: E_s = -10.654 N/m, tau_0 = 0.6048 N/m (Miller & Shenoy 2000).
Device silicon(double thickness, SurfaceFaces faces = SurfaceFaces::wide) {
  return {.structure = {.length = 500_nm,
                        .width = 100_nm,
                        .thickness = thickness,
                        .modes = 4,
                        .kind = Cantilever{{.youngs_modulus = 169_GPa, .density = 2330_kg_m3}}},
          .gap = {.electrode = 20_nm, .contact = 18_nm},
          .electrodes = {{.name = "main", .begin = 0, .end = 500_nm, .fringing = Fringing::none}},
          .surface = Surface{.elastic_modulus = -10.654, .residual_stress = 0.6048, .faces = faces}};
}

double relative_rigidity(const Device& d) {
  return plain_section(d.structure, d.surface).rigidity / plain_section(d.structure).rigidity;
}

TEST(Surface, ChangesTheRigidityOfThinSiliconByThePublishedParts) {
  constexpr double printed = 5e-5;  // rounding of the rigidity to three digits
  EXPECT_NEAR(relative_rigidity(silicon(10_nm)), 1 - 0.0378, printed);
  EXPECT_NEAR(relative_rigidity(silicon(30_nm)), 1 - 0.0126, printed);
  EXPECT_NEAR(relative_rigidity(silicon(50_nm)), 1 - 0.0076, printed);
}

TEST(Surface, SideFacesCountAsTheirSecondMoment) {
  // Two plates of thickness b on edge: 2 E_s b^3 / 12, which is b / (3 a) of the contribution of upper and lower face.
  const double wide = relative_rigidity(silicon(30_nm)) - 1, all = relative_rigidity(silicon(30_nm, SurfaceFaces::all)) - 1;
  EXPECT_NEAR(all / wide, 1 + 30.0 / 300, 1e-10);
}

TEST(Surface, ScalesFrequenciesAndPullInByTheRootOfTheRigidity) {
  Device d = silicon(30_nm);
  const Switch with(d);
  const double root = std::sqrt(relative_rigidity(d));
  d.surface.reset();
  const Switch without(d);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(with.basis().angular_frequencies()[i], root * without.basis().angular_frequencies()[i],
                1e-10 * without.basis().angular_frequencies()[i]);
  }
  EXPECT_NEAR(static_pull_in(with, 0).voltage, root * static_pull_in(without, 0).voltage,
              1e-9 * static_pull_in(without, 0).voltage);
}

TEST(Surface, ResidualStressDoesNothingToACantileverByDefault) {
  Device d = silicon(30_nm);
  const Switch with(d);
  d.surface->residual_stress = 0;
  EXPECT_EQ(with.basis().angular_frequencies(), Switch(d).basis().angular_frequencies());
}

TEST(Surface, ResidualCompressionSoftensACantileverUntilItBuckles) {
  Device d = silicon(30_nm);
  d.surface->cantilever_load = ResidualLoad::compression;
  const double pull = 2 * 0.6048 * 100_nm;
  EXPECT_NEAR(beam_support(d.structure, d.surface).axial_force, -pull, relative_rounding * pull);
  const double buckling_length = pi / 2 * std::sqrt(plain_section(d.structure, d.surface).rigidity / pull);
  EXPECT_NEAR(buckling_length, 0.875_um, 0.001_um);
  const auto of_length = [&](double length) {
    d.structure.length = length;
    d.electrodes[0].end = length;
    return d;
  };
  // The first frequency goes to zero there. Its square is Rayleigh's quotient of the buckled shape, 1 - cos(pi x / (2 L)),
  // times the missing part of the load.
  constexpr double close = 1e-6;
  const Switch near(of_length(buckling_length * (1 - close)));
  d.surface->cantilever_load = ResidualLoad::none;
  const Switch free(d);
  const double expected = 2 * close * std::pow(pi / 2, 4) / (2 * (1.5 - 4 / pi)) / std::pow(1.87510407, 4);
  EXPECT_NEAR(std::pow(near.basis().angular_frequencies()[0] / free.basis().angular_frequencies()[0], 2), expected,
              1e-4 * expected);
  EXPECT_LT(static_pull_in(near, 0).voltage, 0.01 * static_pull_in(free, 0).voltage);
  d.surface->cantilever_load = ResidualLoad::compression;
  EXPECT_THROW(validate(of_length(buckling_length * (1 + close))), InvalidInput);
  d.surface->residual_stress *= -1;  // surfaces in compression leave the bulk in tension
  EXPECT_GT(Switch(d).basis().angular_frequencies()[0], 1.2 * free.basis().angular_frequencies()[0]);
}

TEST(Surface, ResidualStressIsATensionBetweenTwoClamps) {
  Device d = silicon(30_nm);
  d.structure.kind = Bridge{part_of<Beam>(d.structure)};
  d.surface->elastic_modulus = 0;
  const Switch by_surface(d);
  d.surface.reset();
  part_of<Bridge>(d.structure).residual_stress = 2 * 0.6048 / 30_nm;
  const Switch by_stress(d);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(by_surface.basis().angular_frequencies()[i], by_stress.basis().angular_frequencies()[i],
                relative_rounding * by_stress.basis().angular_frequencies()[i]);
  }
}

TEST(Surface, IsRefusedWhereItMeansNothing) {
  const auto refused = [](const Device& d) {
    try {
      validate(d);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  Device plate = test::full_plate();
  plate.surface = Surface{.elastic_modulus = 1};
  EXPECT_EQ(refused(plate), "surface: a rigid plate does not bend; a surface needs a beam");
  Device layered = test::gold_pzt_cantilever();
  layered.surface = Surface{.elastic_modulus = 1};
  EXPECT_EQ(refused(layered), "surface: is for a bare beam, and the piezo layer covers a face");
  Device soft = silicon(30_nm);
  soft.surface->elastic_modulus = -1000;
  EXPECT_EQ(refused(soft).substr(0, 38), "surface: leaves a bending rigidity of ") << refused(soft);
  Device bridge = silicon(30_nm);
  bridge.structure.kind = Bridge{part_of<Beam>(bridge.structure)};
  EXPECT_EQ(refused(bridge), "");
  bridge.surface->cantilever_load = ResidualLoad::compression;
  EXPECT_EQ(refused(bridge), "surface: cantilever_load is for a cantilever; between two clamps residual_stress is a tension");
  bridge.surface = Surface{.residual_stress = -100};
  EXPECT_EQ(refused(bridge).substr(0, 16), "surface: leaves ") << refused(bridge);
}

}  // namespace
}  // namespace softland
