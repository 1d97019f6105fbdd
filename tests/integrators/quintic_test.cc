#include "integrators/quintic.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/gauss.h"

namespace softland {
namespace {

TEST(Quintic, ReproducesPolynomialsOfDegreeFive) {
  const auto p = [](double t) { return 3 - 2 * t + t * t - 0.5 * t * t * t + 0.2 * std::pow(t, 4) - 0.03 * std::pow(t, 5); };
  const auto v = [](double t) { return -2 + 2 * t - 1.5 * t * t + 0.8 * t * t * t - 0.15 * std::pow(t, 4); };
  const auto a = [](double t) { return 2 - 3 * t + 2.4 * t * t - 0.6 * t * t * t; };
  const Quintic q(1, p(1), v(1), a(1), 3, p(3), v(3), a(3));
  constexpr double rounding = 1e-13;
  for (double t = 1; t <= 3; t += 0.125) {
    EXPECT_NEAR(q.position(t), p(t), rounding);
    EXPECT_NEAR(q.velocity(t), v(t), rounding);
    EXPECT_NEAR(q.acceleration(t), a(t), 10 * rounding);
  }
  EXPECT_EQ(q.begin(), 1);
  EXPECT_EQ(q.end(), 3);
}

TEST(Quintic, ErrsWithTheSixthPowerOfTheStep) {
  const auto error = [](double h) {
    const Quintic q(0.3, std::sin(0.3), std::cos(0.3), -std::sin(0.3), 0.3 + h, std::sin(0.3 + h), std::cos(0.3 + h),
                    -std::sin(0.3 + h));
    return std::abs(q.position(0.3 + h / 2) - std::sin(0.3 + h / 2));
  };
  const double order = std::log2(error(0.4) / error(0.2));
  EXPECT_NEAR(order, 6, 0.3);
}

TEST(BracketedZero, FindsZerosToRounding) {
  const auto cosine = [](double x) { return std::cos(x); };
  EXPECT_NEAR(bracketed_zero(cosine, 1, 2), std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(bracketed_zero([&](double x) { return -cosine(x); }, 1, 2), std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(bracketed_zero([](double x) { return x - 0.25; }, 0, 1), 0.25);
  // Functions that are steep on one side and flat on the other, and a root of odd order.
  EXPECT_NEAR(bracketed_zero([](double x) { return std::exp(30 * x) - 2; }, -10, 10), std::log(2.0) / 30, 1e-15);
  EXPECT_NEAR(bracketed_zero([](double x) { return std::pow(x - 1, 3); }, 0, 3), 1, 1e-5);
}

TEST(BracketedZero, TakesAnEndThatIsOne) {
  EXPECT_EQ(bracketed_zero([](double x) { return x; }, 0, 1), 0);
  EXPECT_EQ(bracketed_zero([](double x) { return x - 1; }, 0, 1), 1);
}

TEST(BracketedZero, NeedsFewEvaluations) {
  int evaluations = 0;
  const double zero = bracketed_zero([&](double x) { return ++evaluations, x * x * x - 2; }, 0, 2);
  EXPECT_NEAR(zero, std::cbrt(2.0), 1e-15);
  EXPECT_LT(evaluations, 64);  // bisection to rounding takes 53
}

TEST(SignChanges, AreFoundInOrderAndToRounding) {
  constexpr double rounding = 1e-15;
  const auto expect = [&](const auto& found, const std::vector<double>& places) {
    ASSERT_EQ(found.count, places.size());
    for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(found.at[i], places[i], rounding) << i;
  };
  expect(sign_changes(std::array{1.0}), {});
  expect(sign_changes(std::array{-0.25, 1.0}), {0.25});
  expect(sign_changes(std::array{0.25, 1.0}), {});                      // the root is outside
  expect(sign_changes(std::array{0.0, 1.0}), {});                       // the root is on the edge
  expect(sign_changes(std::array{0.25, -1.0, 1.0}), {});                // touches zero at 1/2 without a change of sign
  expect(sign_changes(std::array{0.0625, -0.625, 1.0}), {0.125, 0.5});  // (s - 1/8) (s - 1/2)
  expect(sign_changes(std::array{-0.125, 0.75, -1.5, 1.0}), {0.5});     // (s - 1/2)^3, the slope does not change sign there
  expect(sign_changes(std::array{-0.09375, 0.6875, -1.5, 1.0}), {0.25, 0.5, 0.75});
}

TEST(Quintic, TurnsWhereItsVelocityChangesSign) {
  // A cosine over more than a period between distant knots: it turns where the quintic through the knots does.
  const auto knots = [](double t0, double t1) {
    return Quintic(t0, std::cos(t0), -std::sin(t0), -std::cos(t0), t1, std::cos(t1), -std::sin(t1), -std::cos(t1));
  };
  const Quintic one = knots(3, 3.5), none = knots(3.2, 3.5);
  ASSERT_EQ(one.turns().count, 1u);
  EXPECT_NEAR(one.turns().at[0], std::numbers::pi, 1e-5);
  EXPECT_NEAR(one.velocity(one.turns().at[0]), 0, 1e-15);
  EXPECT_EQ(none.turns().count, 0u);
  const Quintic two = knots(0.5, 7);
  ASSERT_EQ(two.turns().count, 2u);
  for (const double t : two.turns()) EXPECT_NEAR(two.velocity(t), 0, 1e-14);
  EXPECT_LT(two.turns().at[0], two.turns().at[1]);
}

TEST(GaussRule, IsExactUpToItsDegree) {
  for (const int n : {1, 2, 3, 7, 24, 40}) {
    const GaussRule rule = gauss_rule(n);
    ASSERT_EQ(rule.points.size(), static_cast<std::size_t>(n));
    for (int degree = 0; degree < 2 * n; ++degree) {
      double sum = 0;
      for (std::size_t i = 0; i < rule.points.size(); ++i) sum += rule.weights[i] * std::pow(rule.points[i], degree);
      EXPECT_NEAR(sum, degree % 2 == 0 ? 2.0 / (degree + 1) : 0, 1e-13) << n << " points, degree " << degree;
    }
  }
}

}  // namespace
}  // namespace softland
