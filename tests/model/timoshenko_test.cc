// Frequencies of Timoshenko's beam, against its frequency equations, published values, and the limit of slender beams.
#include "model/timoshenko.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "model/constants.h"

namespace softland {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double poissons_ratio = 0.3, shear_coefficient = 5.0 / 6;

constexpr Beam unit_beam{.youngs_modulus = 1, .density = 1, .poissons_ratio = poissons_ratio};

Structure beam(const StructureKind& kind, double thickness, int modes) {
  return {.length = 1, .width = 1, .thickness = thickness, .modes = modes, .kind = kind};
}

// Wave numbers of Euler-Bernoulli's beam: Blevins, Formulas for Natural Frequency and Mode Shape, 1979, table 8-1.
constexpr std::array clamped_free{1.87510407, 4.69409113, 7.85475744, 10.99554073, 14.13716839};
constexpr std::array clamped_clamped{4.73004074, 7.85320462, 10.99560784, 14.13716549, 17.27875966};

// Huang 1961, eqs. for clamped-free and clamped-clamped beams, over the largest of their terms; b in units of sqrt(E I / (rho A
// L^4)).
double frequency_equation(bool far_clamp, double b, double thickness) {
  const double r2 = thickness * thickness / 12, s2 = r2 * 2 * (1 + poissons_ratio) / shear_coefficient;
  const double root = std::sqrt((r2 - s2) * (r2 - s2) + 4 / (b * b));
  const double alpha = std::sqrt((root - r2 - s2) / 2), beta = std::sqrt((root + r2 + s2) / 2);
  const double decay = 1 / std::cosh(b * alpha), tanh = std::tanh(b * alpha), through = std::sqrt(1 - b * b * r2 * s2);
  if (!far_clamp) {
    return 2 * decay + (b * b * (r2 - s2) * (r2 - s2) + 2) * std::cos(b * beta) -
           b * (r2 + s2) / through * tanh * std::sin(b * beta);
  }
  return 2 * decay - 2 * std::cos(b * beta) +
         b / through * (b * b * s2 * (r2 - s2) * (r2 - s2) + 3 * s2 - r2) * tanh * std::sin(b * beta);
}

TEST(Timoshenko, FrequenciesAreZerosOfTheFrequencyEquations) {
  constexpr double close = 1e-7;  // relative distance within which the equation changes sign at the frequency
  for (const StructureKind& kind : {StructureKind(Cantilever{unit_beam}), StructureKind(Bridge{unit_beam})}) {
    const bool far_clamp = beam(kind, 0, 1).has_far_clamp();
    const auto& euler = far_clamp ? clamped_clamped : clamped_free;
    for (const double thickness : {0.02, 0.05, 0.1, 0.2}) {
      const std::vector<double> excess = frequency_excess(beam(kind, thickness, 5));
      ASSERT_THAT(excess, SizeIs(5));
      for (std::size_t i = 0; i < excess.size(); ++i) {
        const double b = euler[i] * euler[i] / (1 + excess[i]);
        const double below = frequency_equation(far_clamp, b * (1 - close), thickness);
        const double above = frequency_equation(far_clamp, b * (1 + close), thickness);
        if (!(b * b * thickness * thickness / 12 * thickness * thickness / 12 * 3.12 < 1))
          continue;  // the equation is not valid beyond
        EXPECT_LT(below * above, 0) << "mode " << i + 1 << ", thickness " << thickness;
      }
    }
  }
}

// Lee & Schultz, J. Sound Vib. 269 (2004) 609, table of the clamped-clamped beam (nu = 0.3, kappa = 5/6): square roots of b.
TEST(Timoshenko, FrequenciesAreThosePublished) {
  constexpr double printed = 1e-5;  // relative, of six digits
  const auto expect = [&](double thickness, const std::vector<double>& published) {
    const std::vector<double> excess = frequency_excess(beam(Bridge{unit_beam}, thickness, 5));
    for (std::size_t i = 0; i < published.size(); ++i) {
      EXPECT_NEAR(clamped_clamped[i] / std::sqrt(1 + excess[i]), published[i], printed * published[i]) << i + 1;
    }
  };
  expect(0.1, {4.57955, 7.33122, 9.85611, 12.1454, 14.2324});
  expect(0.2, {4.24201});
}

// Rotary inertia and shear to first order in (thickness / length)^2, for high modes, on which the ends have little effect.
TEST(Timoshenko, ExcessOfSlenderBeamsGoesWithTheSquareOfThickness) {
  const auto last = [](double thickness) { return frequency_excess(beam(Cantilever{unit_beam}, thickness, 12)).back(); };
  const double beta = 11.5 * pi, first_order = (1 + 2 * (1 + poissons_ratio) / shear_coefficient) / 24;
  constexpr double of_the_ends = 0.2;  // effect of the ends at the twelfth mode, over the first order
  EXPECT_NEAR(last(1e-3) / std::pow(beta * 1e-3, 2), first_order, of_the_ends * first_order);
  for (const double thickness : {1e-3, 1e-5, 1e-7}) {
    EXPECT_NEAR(last(thickness) / last(2 * thickness), 0.25, 1e-3) << thickness;
  }
}

TEST(Timoshenko, WarnsByModeWhereTheBeamIsNotSlender) {
  EXPECT_THAT(slenderness_warning(beam(Cantilever{unit_beam}, 0.1, 4)),
              HasSubstr("length / thickness = 10: shear and rotary inertia are left out, which makes the natural frequencies too "
                        "high by about 5.4 % (mode 2), 12 % (mode 3), 21 % (mode 4)"));
  EXPECT_THAT(slenderness_warning(beam(Cantilever{unit_beam}, 0.1, 1)), IsEmpty()) << "the first mode alone is nearly right";
  EXPECT_THAT(slenderness_warning(beam(Cantilever{unit_beam}, 0.008, 4)), IsEmpty());
  EXPECT_THAT(slenderness_warning(beam(Bridge{unit_beam}, 0.1, 1)), HasSubstr("6.7 % (mode 1)"));
  EXPECT_THAT(frequency_excess({.kind = Plate{}}), IsEmpty());
}

}  // namespace
}  // namespace softland
