#include "integrators/modal_motion.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace softland {
namespace {

constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();

TEST(Turn, IsThatOfTheCircleUpToTheLargestPhase) {
  for (double phase = 1e-9; phase <= largest_phase; phase = std::min(1.3 * phase, phase + 0.01)) {
    const Turn turned = turn(Lane(0, phase, -phase, phase / 2));
    EXPECT_EQ(turned.cosine[0], 1);
    EXPECT_EQ(turned.sine[0], 0);
    EXPECT_NEAR(turned.cosine[1], std::cos(phase), rounding);
    EXPECT_NEAR(turned.sine[1], std::sin(phase), rounding * std::sin(phase));
    EXPECT_NEAR(turned.sine[2], -std::sin(phase), rounding * std::sin(phase));
    const double slack = 2 * std::pow(std::sin(phase / 2), 2);
    EXPECT_NEAR(turned.slack[1], slack, rounding * slack) << "without cancellation";
  }
}

TEST(Turn, AddsUp) {
  const Turn once = turn(Lane(0.01, 0.3, 1, 1.9));
  Turn sum = once;
  for (int k = 2; k <= 50; ++k) {
    sum = sum + once;
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(lanes); ++i) {
      const double phase = k * std::array{0.01, 0.3, 1.0, 1.9}[static_cast<std::size_t>(i)];
      EXPECT_NEAR(sum.cosine[i], std::cos(phase), k * rounding);
      EXPECT_NEAR(sum.sine[i], std::sin(phase), k * rounding);
      EXPECT_NEAR(sum.slack[i], 1 - std::cos(phase), k * rounding);
    }
  }
}

// Modes at rest at 0 under a force that grows as t^3: q'' = -omega^2 q + a0 + s t^3. The solution is a particular one plus a
// free one.
struct Forced {
  double omega, a0, s, v0;
  [[nodiscard]] ModalMotion::Sample at(double t) const {
    const double w2 = omega * omega;
    const double slope = -6 * s / (w2 * w2);  // slope of the particular solution at 0
    const double c = -a0 / w2, d = (v0 - slope) / omega;
    return {a0 / w2 + s * (t * t * t - 6 * t / w2) / w2 + c * std::cos(omega * t) + d * std::sin(omega * t),
            s * (3 * t * t - 6 / w2) / w2 - omega * (c * std::sin(omega * t) - d * std::cos(omega * t)),
            6 * s * t / w2 - w2 * (c * std::cos(omega * t) + d * std::sin(omega * t))};
  }
};

// Returns the largest error of the interpolated position over a step of `length`, of a point that moves in five modes.
double worst_error(double length, double growth) {
  const std::vector<double> omega{0.1, 0.5, 1, 1.5, 2}, shape{1, -0.7, 0.5, -0.3, 0.2};
  std::vector<Forced> modes;
  for (const double w : omega) modes.push_back({.omega = w, .a0 = 0.3 - w, .s = growth * w, .v0 = 1 / w});
  const auto exact = [&](double t) {
    ModalMotion::Sample sum{0, 0, 0};
    for (std::size_t i = 0; i < modes.size(); ++i) {
      const ModalMotion::Sample mode = modes[i].at(t);
      sum.position += shape[i] * mode.position;
      sum.velocity += shape[i] * mode.velocity;
      sum.acceleration += shape[i] * mode.acceleration;
    }
    return sum;
  };
  std::vector<double> q, v, a;
  for (const Forced& mode : modes) {
    const ModalMotion::Sample begin = mode.at(0);
    q.push_back(begin.position);
    v.push_back(begin.velocity);
    a.push_back(begin.acceleration);
  }
  ModalMotion motion(omega, shape);
  constexpr int pieces = 7;
  motion.set(length, pieces, q.data(), v.data(), a.data(), exact(length));
  double worst = 0;
  for (int i = 0; i <= 20; ++i) {
    const double t = length * i / 20;
    const ModalMotion::Sample found = motion.at(t), truth = exact(t);
    worst = std::max(worst, std::abs(found.position - truth.position));
    EXPECT_NEAR(found.velocity, truth.velocity, 1e-2 * growth + 1e-13);
    EXPECT_NEAR(found.acceleration, truth.acceleration, 1e-1 * growth + 1e-13);
  }
  constexpr double rotations = 1e-14;  // rounding of successive rotations compared with a single one
  for (int k = 1; k <= pieces; ++k) {
    const ModalMotion::Sample found = motion.at(length * k / pieces), knot = motion.knot(k);
    EXPECT_NEAR(knot.position, found.position, rotations);
    EXPECT_NEAR(knot.velocity, found.velocity, rotations);
    EXPECT_NEAR(knot.acceleration, found.acceleration, rotations);
  }
  return worst;
}

TEST(ModalMotion, IsExactUnderAConstantForce) { EXPECT_LT(worst_error(1, 0), 1e-14); }

TEST(ModalMotion, ErrsByTheChangeOfTheForceAndAHighPowerOfTheStep) {
  const double coarse = worst_error(1, 0.1), fine = worst_error(0.5, 0.1);
  EXPECT_LT(coarse, 1e-5);
  EXPECT_GT(std::log2(coarse / fine), 5.5);
  EXPECT_NEAR(worst_error(1, 0.2), 2 * coarse, 1e-3 * coarse);
}

}  // namespace
}  // namespace softland
