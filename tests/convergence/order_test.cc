// Observed orders of convergence in modes, quadrature points and integrator tolerance, against theory.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/pull_in.h"
#include "objectives/metrics.h"
#include "tests/convergence/ideal_cantilever.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

constexpr double reference_step = 17.771;  // [V], about 1.25 Vdp

double pull_in_beta(int modes, double points_per_length = 48) {
  const Device d = test::device({.modes = modes});
  return test::beta(d, static_pull_in(Switch(d, {.points_per_length = points_per_length}), 0).voltage);
}

TEST(Order, OfTheModesIsSeven) {
  // The modal forces of a load that does not vanish at the clamp decrease like 1/N. The null vector of the fold, whose load
  // vanishes there together with its slope, decreases like 1/N^7. The contributions beyond N modes therefore sum to 1/N^7.
  const double exact = pull_in_beta(20);
  const double four = std::abs(pull_in_beta(4) - exact), eight = std::abs(pull_in_beta(8) - exact);
  const double order = std::log2(four / eight);
  EXPECT_GT(order, 6.5);
  EXPECT_LT(order, 8.5);
}

TEST(Order, OfTheQuadratureIsExponential) {
  const double exact = pull_in_beta(4, 64);
  // On a smooth load each further Gauss point reduces the error by more than a factor of ten, until rounding.
  constexpr double rounding = 1e-13;
  double previous = 1;
  for (const double points : {4.0, 5.0, 6.0, 7.0, 8.0}) {
    const double error = std::abs(pull_in_beta(4, points) - exact) / exact;
    EXPECT_LT(error, previous / 10) << points << " points";
    EXPECT_GT(error, rounding) << points << " points: nothing left to observe";
    previous = error;
  }
}

struct Figures {
  double contact_time, impact_velocity, bounce_height;
};

Figures closing(const SwitchOptions& options, double tolerance) {
  const Switch model(test::gold_cantilever(), options);
  const std::vector<Signal> drives{Signal::constant(reference_step)};
  const Metrics m = metrics(simulate_closing(model, drives, {.duration = 60_us, .tolerance = tolerance}));
  return {m.initial_contact_time, m.impact_velocity, m.major_bounce_height};
}

TEST(Order, OrdinaryQuadratureLeavesNineDigitsOfTheReferenceClosing) {
  // The error by the quadrature is far below that of any integrator tolerance in use.
  constexpr double left = 3e-9, left_of_velocity = 3e-8;  // relative; the bounce height follows the velocities
  constexpr double finest = 1e-12;
  const Figures ordinary = closing({}, finest), fine = closing({.points_per_length = 96}, finest);
  EXPECT_NEAR(ordinary.contact_time, fine.contact_time, left * fine.contact_time);
  EXPECT_NEAR(ordinary.impact_velocity, fine.impact_velocity, left_of_velocity * fine.impact_velocity);
  EXPECT_NEAR(ordinary.bounce_height, fine.bounce_height, left_of_velocity * fine.bounce_height);
}

// Returns the slope of the least-squares line through (log tolerance, log error).
double slope(const std::vector<double>& tolerances, const std::vector<double>& errors) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(tolerances.size());
  for (std::size_t i = 0; i < tolerances.size(); ++i) {
    const double x = std::log(tolerances[i]), y = std::log(errors[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

TEST(Order, ErrorsOfAClosingAreProportionalToTheTolerance) {
  // The integrator is restarted at every make and break, so that each part of a run is smooth and no event costs an order.
  const std::vector<double> tolerances{1e-7, 3e-8, 1e-8, 3e-9, 1e-9, 3e-10, 1e-10, 1e-11, 1e-12};
  // Errors over the tolerance. Users may rely on about 1 for t_i and v_i, and on 100 for B_H. Observed: 0.02, 1 and 6.
  constexpr double of_contact_time = 0.1, of_impact_velocity = 3, of_bounce_height = 100;
  const Figures exact = closing({}, 1e-13);
  std::vector<double> bounce_height;
  for (const double tolerance : tolerances) {
    const Figures found = closing({}, tolerance);
    EXPECT_NEAR(found.contact_time / exact.contact_time, 1, of_contact_time * tolerance);
    EXPECT_NEAR(found.impact_velocity / exact.impact_velocity, 1, of_impact_velocity * tolerance);
    EXPECT_NEAR(found.bounce_height / exact.bounce_height, 1, of_bounce_height * tolerance);
    bounce_height.push_back(std::abs(found.bounce_height / exact.bounce_height - 1));
  }
  // The figure to which the errors of many steps and events contribute.
  const double observed = slope(tolerances, bounce_height);
  EXPECT_GT(observed, 0.75);
  EXPECT_LT(observed, 1.25);
}

}  // namespace
}  // namespace softland
