// Optimal control problems with solutions in closed form.
#include "optimizers/collocation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/require.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// x'' = -k x + c: a mass with a push c, on a spring if k > 0.
class Mass final : public ControlledSystem {
 public:
  explicit Mass(double spring = 0) : spring_(spring) {}
  [[nodiscard]] Index states() const override { return 2; }
  [[nodiscard]] Index controls() const override { return 1; }
  [[nodiscard]] bool depends(Index r, Index k) const override { return r == 0 ? k == 1 : k != 1; }
  [[nodiscard]] Rates rates(const VectorXd& x, const VectorXd& c) override {
    Rates rates{.value = VectorXd(2), .slope = MatrixXd::Zero(2, 3)};
    rates.value << x[1], -spring_ * x[0] + c[0];
    rates.slope(0, 1) = 1;
    rates.slope(1, 0) = -spring_;
    rates.slope(1, 2) = 1;
    return rates;
  }
  [[nodiscard]] MatrixXd curvature(const VectorXd&, const VectorXd&, const VectorXd&) override { return MatrixXd::Zero(3, 3); }

 private:
  double spring_;
};

// x' = v cos c, y' = v sin c, v' = sin c: a bead on a wire of inclination c, under unit gravity.
class Bead final : public ControlledSystem {
 public:
  [[nodiscard]] Index states() const override { return 3; }
  [[nodiscard]] Index controls() const override { return 1; }
  [[nodiscard]] bool depends(Index r, Index k) const override { return k == 3 || (r < 2 && k == 2); }
  [[nodiscard]] Rates rates(const VectorXd& x, const VectorXd& c) override {
    Rates rates{.value = VectorXd(3), .slope = MatrixXd::Zero(3, 4)};
    rates.value << x[2] * std::cos(c[0]), x[2] * std::sin(c[0]), std::sin(c[0]);
    rates.slope << 0, 0, std::cos(c[0]), -x[2] * std::sin(c[0]), 0, 0, std::sin(c[0]), x[2] * std::cos(c[0]), 0, 0, 0,
        std::cos(c[0]);
    return rates;
  }
  [[nodiscard]] MatrixXd curvature(const VectorXd& x, const VectorXd& c, const VectorXd& m) override {
    MatrixXd h = MatrixXd::Zero(4, 4);
    h(2, 3) = h(3, 2) = -m[0] * std::sin(c[0]) + m[1] * std::cos(c[0]);
    h(3, 3) = -m[0] * x[2] * std::cos(c[0]) - m[1] * x[2] * std::sin(c[0]) - m[2] * std::sin(c[0]);
    return h;
  }
};

std::vector<double> knots(int n) {
  std::vector<double> all;
  for (int k = 0; k <= n; ++k) all.push_back(static_cast<double>(k) / n);
  return all;
}

// Returns a straight line from one state to another.
ControlledCourse line(const VectorXd& begin, const VectorXd& end, double time, double control) {
  ControlledCourse course{.time = time, .knots = {0, 1}, .controls = MatrixXd::Constant(1, 1, control), .points = {0, 1}};
  course.states.resize(begin.size(), 2);
  course.states << begin, end;
  return course;
}

ControlProblem push_to(Mass& mass, const VectorXd& end, int intervals) {
  return {.system = &mass,
          .start = VectorXd::Zero(2),
          .bounds = {{.lower = -1, .upper = 1}},
          .at_the_end = {{.row = VectorXd::Unit(2, 0), .lower = end[0], .upper = end[0]},
                         {.row = VectorXd::Unit(2, 1), .lower = end[1], .upper = end[1]}},
          .longest = 100,
          .knots = knots(intervals)};
}

TEST(Collocation, PushesAMassFromRestToRestByABangBangControl) {
  Mass mass;
  const VectorXd end = VectorXd::Unit(2, 0);
  const ControlledCourse course = solve(push_to(mass, end, 8), line(VectorXd::Zero(2), end, 3, 0));
  ASSERT_TRUE(course.converged) << course.message;
  EXPECT_NEAR(course.time, 2, 1e-6);
  for (Index k = 0; k < 8; ++k) EXPECT_NEAR(course.controls(0, k), k < 4 ? 1 : -1, 1e-5);
  EXPECT_NEAR(course.state_at(0.5)[0], 0.5, 1e-5);
}

TEST(Collocation, FindsASwitchBetweenItsKnotsByRefiningThem) {
  // From rest to x = 1, v = 1/2: full push to x_s, then full brake; v_s^2 = 2 x_s and 1/4 = 2 x_s - 2 (1 - x_s).
  Mass mass;
  const VectorXd end = (VectorXd(2) << 1, 0.5).finished();
  const double x_s = 2.25 / 4, v_s = std::sqrt(2 * x_s), exact = v_s + (v_s - 0.5);
  ControlProblem problem = push_to(mass, end, 7);
  ControlledCourse course = solve(problem, line(VectorXd::Zero(2), end, 3, 0));
  const double coarse = course.time - exact;
  for (int round = 0; round < 5; ++round) {
    problem.knots = refined_knots(course, problem.bounds, 1e-3);
    course = solve(problem, course);
    ASSERT_TRUE(course.converged) << course.message;
  }
  EXPECT_GT(coarse, 1e-4);                // coarse knots give a visible error
  EXPECT_NEAR(course.time, exact, 2e-5);  // a switch of the control inside of an interval costs the square of the interval
  EXPECT_LT(problem.knots.size(), 40U);   // knots are added only where the control changes
}

TEST(Collocation, KeepsASlewLimit) {
  // The push increases at the rate J to 1, stays for p, changes at the rate J to -1, and stays until the mass is at rest.
  constexpr double jerk = 4, p = 0.3, r = p + 0.5 / jerk;
  double x = 0, v = 0, a = 0;
  const auto go = [&](double rate, double time) {
    x += v * time + a * time * time / 2 + rate * time * time * time / 6;
    v += a * time + rate * time * time / 2;
    a += rate * time;
  };
  go(jerk, 1 / jerk);
  go(0, p);
  go(-jerk, 2 / jerk);
  go(0, r);
  ASSERT_NEAR(v, 0, 1e-12);
  Mass mass;
  ControlProblem problem = push_to(mass, (VectorXd(2) << x, 0).finished(), 60);
  problem.bounds[0].slew = jerk;
  const ControlledCourse course = solve(problem, line(VectorXd::Zero(2), (VectorXd(2) << x, 0).finished(), 2, 0));
  ASSERT_TRUE(course.converged) << course.message;
  EXPECT_NEAR(course.time, 1 / jerk + p + 2 / jerk + r, 5e-4);  // corners lie between knots
  EXPECT_GE(course.time, 1 / jerk + p + 2 / jerk + r - 1e-7);
  for (Index k = 0; k + 1 < course.controls.cols(); ++k) {
    const double span = (course.knots[static_cast<std::size_t>(k) + 1] - course.knots[static_cast<std::size_t>(k)]) * course.time;
    EXPECT_LE(std::abs(course.controls(0, k + 1) - course.controls(0, k)), jerk * span * (1 + 1e-6));
  }
  EXPECT_EQ(course.controls(0, 0), 0);
}

TEST(Collocation, EndsOnTheControlThatIsAskedFor) {
  Mass mass;
  const VectorXd end = VectorXd::Unit(2, 0);
  ControlProblem problem = push_to(mass, end, 30);
  problem.bounds[0].slew = 4;
  const ControlledCourse any = solve(problem, line(VectorXd::Zero(2), end, 3, 0));
  problem.bounds[0].after = 0;
  const ControlledCourse course = solve(problem, line(VectorXd::Zero(2), end, 3, 0));
  ASSERT_TRUE(any.converged && course.converged);
  EXPECT_LT(any.controls(0, 30), -0.5);
  EXPECT_EQ(course.controls(0, 30), 0);
  EXPECT_GT(course.time, any.time);
}

TEST(Collocation, FindsTheBrachistochrone) {
  // The cycloid x = R (a - sin a), y = R (1 - cos a) to a = pi takes pi sqrt(R).
  Bead bead;
  const double radius = 1 / M_PI;
  const VectorXd begin = VectorXd::Zero(3), end = (VectorXd(3) << 1, 2 * radius, std::sqrt(4 * radius)).finished();
  ControlProblem problem{.system = &bead,
                         .start = begin,
                         .bounds = {{.lower = -1, .upper = 1.7}},
                         .at_the_end = {{.row = VectorXd::Unit(3, 0), .lower = 1, .upper = 1},
                                        {.row = VectorXd::Unit(3, 1), .lower = 2 * radius, .upper = 2 * radius}},
                         .shortest = 0.1,
                         .longest = 100,
                         .knots = knots(40)};
  const ControlledCourse course = solve(problem, line(begin, end, 2, 0.6));
  ASSERT_TRUE(course.converged) << course.message;
  EXPECT_NEAR(course.time, M_PI * std::sqrt(radius), 2e-4);
  EXPECT_LT(course.iterations, 60);  // limit for exact second derivatives
}

TEST(Collocation, EndsBestWhereThatIsAsked) {
  // A push of at most half a period moves a mass on a spring twice as far as its equilibrium under a constant push.
  Mass mass(1);
  ControlProblem problem{.system = &mass,
                         .start = VectorXd::Zero(2),
                         .bounds = {{.lower = -1, .upper = 1}},
                         .shortest = 1,
                         .longest = M_PI,
                         .ends_best = VectorXd(-VectorXd::Unit(2, 0)),
                         .knots = knots(10)};
  const ControlledCourse course = solve(problem, line(VectorXd::Zero(2), VectorXd::Unit(2, 0), 2, 0));
  ASSERT_TRUE(course.converged) << course.message;
  EXPECT_NEAR(course.time, M_PI, 1e-3);  // x = 1 - cos t is flat there
  EXPECT_NEAR(course.states(0, course.states.cols() - 1), 2, 1e-5);
}

TEST(Collocation, KeepsConditionsOnTheWay) {
  // With a speed of at most 1/2 to x = 1: v = 1/2 from t = 1/2 on, so that T = 1/2 + (1 - 1/8 - 1/8) / (1/2) + 1/2.
  Mass mass;
  ControlProblem problem = push_to(mass, VectorXd::Unit(2, 0), 50);
  problem.on_the_way = {{.row = VectorXd::Unit(2, 1), .upper = 0.5}};
  const ControlledCourse course =
      solve(problem, line((VectorXd(2) << 0, 0.3).finished(), (VectorXd(2) << 1, 0.3).finished(), 3, 0));
  ASSERT_TRUE(course.converged) << course.message;
  EXPECT_NEAR(course.time, 2.5, 1e-5);
  EXPECT_LE(course.states.row(1).maxCoeff(), 0.5 + 1e-6);
}

TEST(Collocation, ReportsAnImpossibleProblem) {
  Mass mass;
  ControlProblem problem = push_to(mass, VectorXd::Unit(2, 0), 8);
  problem.longest = 1;
  problem.max_iterations = 100;
  EXPECT_FALSE(solve(problem, line(VectorXd::Zero(2), VectorXd::Unit(2, 0), 1, 0)).converged);
}

TEST(Collocation, StopsWhenAskedTo) {
  Mass mass;
  const std::atomic<bool> stop = true;
  ControlProblem problem = push_to(mass, VectorXd::Unit(2, 0), 8);
  problem.stop = &stop;
  const ControlledCourse course = solve(problem, line(VectorXd::Zero(2), VectorXd::Unit(2, 0), 3, 0));
  EXPECT_TRUE(course.interrupted);
}

TEST(Collocation, RefusesPartsThatDoNotFit) {
  Mass mass;
  const VectorXd end = VectorXd::Unit(2, 0);
  const auto refused = [&](auto&& spoil) {
    ControlProblem problem = push_to(mass, end, 4);
    spoil(problem);
    EXPECT_THROW((void)solve(problem, line(VectorXd::Zero(2), end, 3, 0)), InvalidInput);
  };
  refused([](ControlProblem& p) { p.knots = {0, 0.5, 0.5, 1}; });
  refused([](ControlProblem& p) { p.knots = {0, 0.5}; });
  refused([](ControlProblem& p) { p.bounds[0].lower = 2; });
  refused([](ControlProblem& p) { p.bounds.clear(); });
  refused([](ControlProblem& p) { p.start = VectorXd::Zero(3); });
  refused([](ControlProblem& p) { p.at_the_end[0].row = VectorXd::Zero(3); });
  refused([](ControlProblem& p) { p.shortest = p.longest; });
  refused([](ControlProblem& p) { p.longest_piece = 0; });
  EXPECT_THROW((void)solve(push_to(mass, end, 4), line(VectorXd::Zero(3), VectorXd::Zero(3), 3, 0)), InvalidInput);
}

}  // namespace
}  // namespace softland
