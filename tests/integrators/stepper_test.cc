#include "integrators/stepper.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>

namespace softland {
namespace {

using ::testing::HasSubstr;

TEST(Integrators, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names{to_string(Integrator::automatic)};
  for (const IntegratorDescriptor& d : integrator_descriptors) {
    EXPECT_TRUE(names.insert(d.name).second) << d.name;
    EXPECT_EQ(to_string(d.integrator), d.name);
    EXPECT_EQ(is_implicit(d.integrator), d.implicit);
  }
}

TEST(Integrators, AreAllSteppers) {
  OdeSystem system{.size = 2, .frequencies = {1}};
  for (const Integrator integrator : all_integrators) EXPECT_NE(make_stepper(integrator, system, 1e-6), nullptr);
  EXPECT_THROW(static_cast<void>(make_stepper(Integrator::automatic, system, 1e-6)), std::logic_error);
}

// q'' = -q - friction q' + cos(2 t) from q = 1 at rest.
OdeSystem forced_oscillator(double friction) {
  OdeSystem system{.size = 2, .frequencies = {1}};
  system.rates = [=](double t, const double* y, double* rates) { rates[0] = -y[0] - friction * y[1] + std::cos(2 * t); };
  system.jacobian = [=](double, const double*, double* j) { j[0] = 0, j[1] = -1, j[2] = 1, j[3] = -friction; };
  return system;
}

void follow_a_forced_oscillator(Integrator integrator, double tolerance) {
  const OdeSystem system = forced_oscillator(0);
  const double begin[] = {1, 0}, rate = 0, near = 1000 * tolerance;
  const auto stepper = make_stepper(integrator, system, tolerance);
  ASSERT_TRUE(stepper->restart(0, begin, &rate, {tolerance, tolerance}, 1e-3, 1e9));
  while (stepper->time() < 2) ASSERT_TRUE(stepper->step(2)) << stepper->message();
  const double middle[] = {stepper->state()[0], stepper->state()[1]}, there = stepper->rates()[0];
  ASSERT_TRUE(stepper->restart(2, middle, &there, {tolerance, tolerance}, 1e-3, 0.05));
  double last = 2;
  while (stepper->time() < 5) {
    ASSERT_TRUE(stepper->step(5)) << stepper->message();
    EXPECT_LE(stepper->time() - last, 0.05 * (1 + 1e-9));
    last = stepper->time();
  }
  EXPECT_EQ(stepper->time(), 5);
  const double exact = 4.0 / 3 * std::cos(5.0) - std::cos(10.0) / 3;
  const double speed = -4.0 / 3 * std::sin(5.0) + 2 * std::sin(10.0) / 3;
  EXPECT_NEAR(stepper->state()[0], exact, near);
  EXPECT_NEAR(stepper->state()[1], speed, near);
  EXPECT_NEAR(stepper->rates()[0], -exact + std::cos(10.0), near);
}

TEST(Steppers, FollowAForcedOscillatorThroughARestart) {
  for (const Integrator integrator : all_integrators) {
    for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
      SCOPED_TRACE(fmt::format("{} {}", to_string(integrator), tolerance));
      follow_a_forced_oscillator(integrator, tolerance);
    }
  }
}

TEST(Steppers, SayWhatTheLibrarySaysOfAFailure) {
  OdeSystem system{.size = 2, .frequencies = {1}};
  system.rates = [](double, const double*, double* rates) { rates[0] = std::nan(""); };
  system.jacobian = [](double, const double*, double* j) { j[0] = j[1] = j[2] = j[3] = 0; };
  const double begin[] = {1, 0}, rate = 0;
  for (const Integrator integrator : all_integrators) {
    if (integrator == Integrator::lawson) continue;
    const auto stepper = make_stepper(integrator, system, 1e-9);
    bool going = stepper->restart(0, begin, &rate, {1e-9, 1e-9}, 1e-3, 1);
    for (int i = 0; going && i < 10'000; ++i) going = stepper->step(1);
    EXPECT_FALSE(going) << to_string(integrator);
    EXPECT_THAT(stepper->message(), HasSubstr("returned -")) << to_string(integrator);
    EXPECT_THAT(stepper->message(), HasSubstr(": ")) << to_string(integrator);
  }
}

// CVODE itself refuses a negative step length; ARKODE takes it for its default.
TEST(Steppers, RefuseWhatTheLibraryRefusesOfTheirSetUp) {
  const OdeSystem system = forced_oscillator(0);
  const double begin[] = {1, 0}, rate = 0;
  for (const Integrator integrator : {Integrator::bdf, Integrator::adams}) {
    const auto stepper = make_stepper(integrator, system, 1e-9);
    EXPECT_FALSE(stepper->restart(0, begin, &rate, {1e-9, 1e-9}, 1e-3, -1)) << to_string(integrator);
    EXPECT_THAT(stepper->message(), HasSubstr("CVodeSetMaxStep returned -")) << to_string(integrator);
    EXPECT_THAT(stepper->message(), HasSubstr("hmax")) << to_string(integrator);
  }
}

TEST(Lawson, KnowsWhenStabilityKeepsItsStepsShort) {
  const auto last_stiffness = [](double friction) {
    OdeSystem system{.size = 2, .frequencies = {1}};
    system.rates = [&](double, const double* y, double* rates) { rates[0] = -y[0] - friction * y[1]; };
    const auto stepper = make_stepper(Integrator::lawson, system, 1e-6);
    const double begin[] = {1, 0}, acceleration = -1;
    EXPECT_TRUE(stepper->restart(0, begin, &acceleration, {1e-6, 1e-6}, 1e-4, 1));
    for (int i = 0; i < 500; ++i) EXPECT_TRUE(stepper->step(1e6));
    return stepper->stiffness();
  };
  // The pair is stable up to a decay rate of 3.3 per step.
  EXPECT_NEAR(last_stiffness(1e3), 3.3, 0.7);
  EXPECT_LT(last_stiffness(1e-2), 0.1);
}

}  // namespace
}  // namespace softland
