#include "model/receptance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/constants.h"

namespace softland {
namespace {

constexpr double rounding = 1e-12;

std::vector<BeamElement> cut(const std::vector<double>& nodes) {
  std::vector<BeamElement> elements;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    elements.push_back({.begin = nodes[i], .end = nodes[i + 1], .rigidity = 1, .mass = 1});
  }
  return elements;
}

const std::vector<BeamElement> even = cut({0, 0.25, 0.5, 0.75, 1}), uneven = cut({0, 1e-4, 0.2, 0.5, 0.7, 0.9, 1});

TEST(Receptance, WithoutInertiaIsTheTextbookFlexibility) {
  for (const auto& elements : {even, uneven}) {
    for (const double x : {0.5, 1.0}) {  // nodes of the elements: within an element the moment is smooth
      Receptance free(elements, 0, false);
      EXPECT_NEAR(free.at(Lane::Zero(), x).deflection[0], x * x * x / 3, rounding * x);
      if (x == 1) continue;
      Receptance held(elements, 0, true);
      EXPECT_NEAR(held.at(Lane::Zero(), x).deflection[0], std::pow(x * (1 - x), 3) / 3, rounding * x) << x;
    }
  }
}

TEST(Receptance, UnderTensionIsThatOfAStiffenedString) {
  // EI y'''' = N y'': with k^2 = N / EI, the tip of a cantilever deflects by (k - tanh k) / (k^3 EI) under a unit force.
  for (const double k : {0.5, 3.0}) {
    Receptance free(uneven, k * k, false);
    EXPECT_NEAR(free.at(Lane::Zero(), 1).deflection[0], (k - std::tanh(k)) / (k * k * k), 1e-11);
  }
}

TEST(Receptance, IsThatOfTheClosedForm) {
  // Driving-point receptance of a cantilever's tip: (cosh b sin b - sinh b cos b) / (b^3 (1 + cosh b cos b)).
  const auto closed = [](double b) {
    return (std::cosh(b) * std::sin(b) - std::sinh(b) * std::cos(b)) / (b * b * b * (1 + std::cosh(b) * std::cos(b)));
  };
  Receptance free(uneven, 0, false);
  for (const double b : {0.5, 1.5, 3.0, 4.2, 6.0, 9.0}) {
    EXPECT_NEAR(free.at(Lane::Constant(std::pow(b, 4)), 1).deflection[0] / closed(b), 1, 1e-9) << b;
  }
}

TEST(Receptance, GrowsByItsInertia) {
  Receptance beam(even, -0.7, false);
  for (const double square : {3.0, 200.0, 900.0}) {
    const double h = 1e-4 * square;
    const Receptance::Answer around = beam.at({square - 2 * h, square - h, square + h, square + 2 * h}, 0.6);
    const Lane& a = around.deflection;
    const double slope = (a[0] - 8 * a[1] + 8 * a[2] - a[3]) / (12 * h);
    EXPECT_NEAR(beam.at(Lane::Constant(square), 0.6).inertia[2] / slope, 1, 1e-9) << square;
  }
}

TEST(Receptance, CountsTheFrequenciesBelow) {
  for (const bool held : {false, true}) {
    Receptance beam(uneven, 0, held);
    for (int mode = 0; mode < 6; ++mode) {
      // Mode numbers from cos x cosh x = 1 or -1 are within a tenth of these; that of a cantilever's first mode is 1.875.
      const double number = mode == 0 && !held ? 1.875104 : (mode + (held ? 1.5 : 0.5)) * pi;
      const Lane around = beam.at({std::pow(number - 0.3, 4), std::pow(number + 0.3, 4), 0, 1e-9}, 0.4).below;
      EXPECT_EQ(around[0], mode);
      EXPECT_EQ(around[1], mode + 1);
      EXPECT_EQ(around[2], 0);
    }
  }
}

TEST(Receptance, MotionIsADeflectionByTheForce) {
  Receptance beam(even, 0, false);
  ASSERT_NEAR(beam.at(Lane::Zero(), 1).deflection[1], 1.0 / 3, rounding);
  // Its bending energy is half of force times deflection, and that of every basis function is a half.
  EXPECT_NEAR(beam.motion(1).squaredNorm(), 1.0 / 3, rounding);
}

}  // namespace
}  // namespace softland
