// A user's own waveform as a signal.
#include "waveforms/own_waveform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "base/literals.h"
#include "tests/waveforms/expect_invalid.h"
#include "waveforms/waveform.h"

namespace softland {
namespace {

using namespace literals;
using test::expect_invalid;

/// An own waveform from functions.
class Made final : public OwnWaveform {
 public:
  std::function<double(double)> at;
  std::vector<double> times;
  std::vector<OwnParameter> known = {};

  Made(std::function<double(double)> voltage, std::vector<double> breakpoints)
      : at(std::move(voltage)), times(std::move(breakpoints)) {}
  [[nodiscard]] std::string_view name() const override { return "made"; }
  [[nodiscard]] std::vector<OwnParameter> parameters() const override { return known; }
  [[nodiscard]] std::vector<double> breakpoints(std::span<const double>) const override { return times; }
  [[nodiscard]] double voltage(double time, std::span<const double>) const override { return at(time); }
};

Own made(std::function<double(double)> voltage, std::vector<double> breakpoints) {
  return own(std::make_shared<Made>(std::move(voltage), std::move(breakpoints)));
}

// Returns a decaying oscillation with a kink at 20 us, from where it falls as a bell.
double ringing(double time) {
  const double pi = std::numbers::pi;
  if (time < 20_us) return 12 * (1 - std::exp(-time / 3_us) * std::cos(2 * pi * time / 7_us));
  const double late = (time - 20_us) / 9_us;
  return 5 + (ringing(std::nextafter(20_us, 0)) - 5) * std::exp(-late * late) * (1 - late / 5);
}
constexpr double ringing_end = 60e-6;

TEST(OwnWaveform, IsFollowedWithinTheStatedAccuracy) {
  constexpr double between_checks = 1.1;  // between the points that are checked the error of a cubic may be slightly larger
  const Signal followed = signal(made(ringing, {20_us, ringing_end}));
  const double largest = followed.peak();
  EXPECT_GT(largest, 12);
  for (int k = 0; k < 20'000; ++k) {
    const double time = k / 20'000.0 * ringing_end;
    ASSERT_LE(std::abs(followed.voltage(time) - ringing(time)), between_checks * own_waveform_accuracy * largest) << time;
  }
  EXPECT_EQ(followed.voltage(1), ringing(ringing_end));
}

TEST(OwnWaveform, DoesNotJumpWhereItsVoltageDoesNot) {
  const Signal followed = signal(made(ringing, {20_us, ringing_end}));
  ASSERT_GT(followed.pieces().size(), 20u);
  for (const double time : followed.breakpoints()) EXPECT_EQ(followed.voltage_before(time), followed.voltage(time)) << time;
  EXPECT_LT(followed.peak_slew(), 2 * 12 / 1_us);
}

TEST(OwnWaveform, DoesNotJumpWhereItFallsSteeplyToAKinkLate) {
  // One bit of the time before the kink the voltage exceeds the rounding of the piece that ends there.
  const auto falling = [](double t) { return t < 40_us ? 20 : t < 41_us ? 20 * (41_us - t) / 1_us : 0; };
  const Signal followed = signal(made(falling, {40_us, 41_us}), 20);
  EXPECT_EQ(followed.voltage_before(41_us), followed.voltage(41_us));
  EXPECT_LT(followed.peak_slew(100_us) - 20 / 1_us, 1);
}

TEST(OwnWaveform, JumpsAtABreakpointToTheValueThereAndFromThatBefore) {
  const Signal followed = signal(made([](double t) { return t < 3_us ? 2 * t / 3_us : t < 5_us ? 7 : -1; }, {3_us, 5_us}));
  EXPECT_NEAR(followed.voltage_before(3_us), 2, 1e-12);
  EXPECT_EQ(followed.voltage(3_us), 7);
  EXPECT_EQ(followed.voltage_before(5_us), 7);
  EXPECT_EQ(followed.hold_level(), -1);
  EXPECT_EQ(followed.pieces().size(), 3u) << "straight lines need no cubics";
  EXPECT_TRUE(followed.pieces()[1].is_level());
}

TEST(OwnWaveform, OfTheVoltagesOfAStraightOrCubicFamilyHasItsPieces) {
  const std::vector<Waveform> all{Step{.level = 17.5, .rise_time = 3_us},
                                  Pulse{.levels = {12, 3, 8}, .times = {4_us, 9_us}, .edge = 1_us},
                                  BSpline{.levels = {8, -3, 5, 12, 1, 0.5, 7}, .duration = 30_us}};
  for (const Waveform& waveform : all) {
    const Signal given = signal(waveform);
    std::vector<double> times = given.breakpoints();
    times.erase(times.begin());
    const Signal followed = signal(made([&](double t) { return given.voltage(t); }, times));
    ASSERT_EQ(followed.breakpoints(), given.breakpoints()) << family(waveform);
    constexpr double rounding = 1e-12;
    for (int k = 0; k < 1000; ++k)
      EXPECT_NEAR(followed.voltage(k * 40e-9), given.voltage(k * 40e-9), 12 * rounding) << family(waveform);
  }
}

TEST(OwnWaveform, InTheUnitsOfADeviceHasItsPiecesInThem) {
  const Waveform given = made(ringing, {20_us, ringing_end});
  const Signal own = signal(given), in_units = signal(scaled(given, 1.03, 0.97));
  ASSERT_EQ(in_units.pieces().size(), own.pieces().size());
  for (double t = 0; t < 70_us; t += 0.37_us) EXPECT_NEAR(in_units.voltage(0.97 * t), 1.03 * own.voltage(t), 1e-12 * 20) << t;
}

TEST(OwnWaveform, WithoutBreakpointsIsConstantAfterWhatStoodBefore) {
  const Signal constant = signal(Waveform(made([](double) { return 4.5; }, {})), 1.5);
  EXPECT_EQ(constant.before(), 1.5);
  EXPECT_EQ(constant.voltage(0), 4.5);
  EXPECT_EQ(constant.pieces().size(), 1u);
}

TEST(OwnWaveform, WithoutBreakpointsIsRefusedWhereItWouldBeZeroForEverOrIsNotConstant) {
  expect_invalid([] { (void)signal(made([](double) { return 0.0; }, {})); }, {"'made'", "no breakpoints", "0 V"});
  expect_invalid([] { (void)signal(made([](double t) { return 1e6 * std::min(t, 20e-6); }, {})); },
                 {"'made'", "no breakpoints", "0 V", "and it is"});
  expect_invalid([] { (void)signal(made([](double t) { return t < 3e-6 ? 5.0 : 7.0; }, {})); },
                 {"'made'", "no breakpoints", "5 V", "and it is 7 V"});
}

TEST(OwnWaveform, HasItsParametersAndIsCalledByItsName) {
  auto waveform = std::make_shared<Made>([](double) { return 1.0; }, std::vector<double>{});
  waveform->known = {{"level_V", 0, 5, 1}, {"rise_s", 1e-6, 2e-6, 1.5e-6}};
  EXPECT_EQ(own(waveform).x, (std::vector<double>{1, 1.5e-6}));
  EXPECT_EQ(family(own(waveform)), "made");
  expect_invalid([&] { (void)signal(Own{.waveform = waveform, .x = {1}}); }, {"own waveform 'made'", "2 parameters", "1 values"});
  waveform->known = {{"level_V", 0, 5, 6}};
  expect_invalid([&] { (void)own(waveform); }, {"own waveform 'made'", "'level_V' from 0 to 5 begins at 6"});
}

TEST(OwnWaveform, IsRefusedWhereItHasNoSignal) {
  expect_invalid([] { (void)own(nullptr); }, {"own waveform is null"});
  expect_invalid([] { (void)signal(Own{}); }, {"own waveform is null"});
  expect_invalid([] { (void)signal(made([](double) { return 1.0; }, {3e-6, 2e-6})); }, {"'made'", "2e-06 s follows", "3e-06 s"});
  expect_invalid([] { (void)signal(made([](double) { return 1.0; }, {-1e-6})); }, {"'made'", "-1e-06 s"});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_invalid([=] { (void)signal(made([=](double t) { return t > 1e-6 ? nan : 1.0; }, {2e-6})); },
                 {"'made'", "is nan", "finite"});
  expect_invalid([] { (void)signal(made([](double t) { return t > 1.234e-6 ? 2.0 : 1.0; }, {2e-6})); },
                 {"'made'", "not smooth at 1.234", "breakpoint"});
}

}  // namespace
}  // namespace softland
