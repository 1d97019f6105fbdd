// A switch that stays open: its rest position, the motion to it, and whether its drives are meant to close it.
#include "studies/closing/open_state.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "biased.h"
#include "model/pull_in.h"
#include "scenes.h"
#include "studies/closing/certify.h"
#include "studies/closing/simulate.h"

namespace softland::open_state_test {
namespace {

Closing closing_of(const SceneFile& file) { return simulate(prepare(file), true); }

/// A plate with one degree of freedom under a small step: a damped oscillator, apart from the field.
SceneFile small_step(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = spring_plate({"waveform.main.level=2 V", "structure.damping_ratio=0.2", "simulate.duration=400 us"});
  for (const std::string_view change : changes) file.set(change);
  return file;
}

TEST(OpenState, IsThatOfADampedOscillator) {
  const Closing c = closing_of(small_step());
  ASSERT_EQ(c.metrics.status, Status::open);
  constexpr double stiffness = 42, area = 1e-8, gap = 3.8e-6, zeta = 0.2, eps0 = 8.8541878128e-12, volts = 2;
  // First order of a small deflection: k y = eps0 A V^2 / (2 (d - y)^2).
  const double first = eps0 * area * volts * volts / (2 * gap * gap * stiffness), y = first / (1 - 2 * first / gap);
  constexpr double small = 1e-3;  // deflection over gap
  EXPECT_NEAR(c.metrics.static_deflection, y, small * y);
  EXPECT_NEAR(c.metrics.capacitance, eps0 * area / (gap - y), 1e-6 * eps0 * area / gap);
  const double root = std::sqrt(1 - zeta * zeta);
  EXPECT_NEAR(c.metrics.overshoot, y * std::exp(-std::numbers::pi * zeta / root), 2 * small * y);
  // The last crossing of the 2 % band in the closed form of the oscillator.
  const double omega = std::sqrt(42 / 2.4e-9);
  const auto left = [&](double t) {
    return std::exp(-zeta * omega * t) * (std::cos(root * omega * t) + zeta / root * std::sin(root * omega * t));
  };
  double last = 0;
  for (double t = 0; t < 400e-6; t += 1e-9) {
    if (std::abs(left(t)) > settled_share) last = t;
  }
  EXPECT_NEAR(c.metrics.open_settling_time, last, 0.01 * last);
  for (const auto member : {&Metrics::static_deflection, &Metrics::overshoot, &Metrics::open_settling_time})
    EXPECT_LT(c.errors[member], 1e-3 * (c.metrics.*member)) << "and has an error";
}

TEST(OpenState, HasNotSettledWhereItSwings) {
  // The window ends while the plate moves through its static deflection.
  const Closing c = closing_of(small_step({"structure.damping_ratio=0", "simulate.duration=391.9 us"}));
  ASSERT_EQ(c.metrics.status, Status::open);
  EXPECT_NEAR(c.metrics.overshoot, c.metrics.static_deflection, 1e-3 * c.metrics.static_deflection);
  EXPECT_TRUE(std::isnan(c.metrics.open_settling_time));
}

TEST(OpenState, OfASwitchThatOpensIsSeenFromWhereItStarted) {
  const Closing c = closing_of(small_step({"waveform.main.level=1 V", "waveform.main.before=3 V"}));
  ASSERT_EQ(c.metrics.status, Status::open);
  // The plate starts at eight times its static deflection, and overshoots by half of that.
  EXPECT_NEAR(c.metrics.overshoot, 8 * 0.527 * c.metrics.static_deflection, 0.1 * c.metrics.static_deflection);
  const double expected = closing_of(small_step()).metrics.open_settling_time;
  EXPECT_NEAR(c.metrics.open_settling_time, expected, 0.01 * expected);
}

// Tests just below and just above the dynamic pull-in voltage, in windows in which the switch does not touch.
TEST(OpenState, IsThatOfEveryShippedScenePulledByLess_slow) {
  for (const std::string& name : shipped_scenes()) {
    const Scene read = read_scene(scene(name.c_str()));
    if (read.device.electrodes.empty()) continue;
    const auto status = [&](double vdp, const char* window) {
      SceneFile file = scene(name.c_str());
      file.set(fmt::format("waveform.main={{family=\"step\",level=\"{} Vdp\"}}", vdp));
      file.erase("waveform.upper");
      file.erase("driver.main");
      if (window != nullptr) file.set(fmt::format("simulate.duration={}", window));
      return simulate(prepare(file), false).metrics.status;
    };
    EXPECT_EQ(status(0.98, nullptr), Status::open) << name;
    EXPECT_EQ(status(0.5, nullptr), Status::open) << name;
    EXPECT_EQ(status(1.02, "1 ns"), Status::no_contact) << name;
  }
}

TEST(OpenState, IsNotThatOfADriveThatIsDueToClose) {
  const auto status = [](const char* waveform) {
    return closing_of(spring_plate({waveform, "driver.main.max_voltage=200 V", "simulate.duration=100 us"})).metrics.status;
  };
  // Vdp of the plate is 80.7 V: the pulse is too short to close it, but was meant to.
  EXPECT_EQ(status("waveform.main={family=\"pulse\",levels=[\"150 V\",\"0 V\"],times=[\"1 us\"]}"), Status::no_contact);
  EXPECT_EQ(status("waveform.main={family=\"pulse\",levels=[\"70 V\",\"0 V\"],times=[\"10 us\"]}"), Status::open);
  EXPECT_EQ(status("waveform.main={family=\"step\",level=\"190 V\",rise_time=\"90 ms\"}"), Status::no_contact);
}

TEST(OpenState, StepsCloseFromTheDynamicPullInVoltageOn) {
  for (const std::string& name : shipped_scenes()) {
    const Switch model(read_scene(scene(name.c_str())).device);
    for (std::size_t k = 0; k < model.device().electrodes.size(); ++k) {
      const double vdp = dynamic_pull_in(model, k, static_pull_in(model, k)).voltage;
      EXPECT_FALSE(step_closes(model, k, 0.999 * vdp)) << name;
      EXPECT_EQ(step_closes(model, k, 1.001 * vdp), std::isfinite(vdp)) << name;
    }
  }
}

TEST(OpenState, IsCertified_long) {
  const Closing c = certify(prepare(small_step()), {}, 1);
  EXPECT_EQ(c.metrics.status, Status::open);
  ASSERT_TRUE(c.certificate);
  EXPECT_TRUE(c.certificate->ill_conditioned.empty());
  EXPECT_LT(c.errors[&Metrics::static_deflection], 1e-5 * c.metrics.static_deflection);
}

}  // namespace
}  // namespace softland::open_state_test
