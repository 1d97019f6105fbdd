// Undamped voltage steps on the ideal cantilever against an independent Galerkin program.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/pull_in.h"
#include "tests/convergence/ideal_cantilever.h"

namespace softland {
namespace {

using namespace literals;

TEST(DynamicPullIn, OfAnUndampedStepIsNinePercentBelowTheStaticOne) {
  // V_DPI / V_SPI of the distributed static value: 0.9093 with one mode, 0.9094 with two and more, beta_DPI = 1.39009.
  constexpr double printed = 1e-4;
  struct Row {
    int modes;
    double ratio;
  };
  for (const auto& [modes, ratio] : {Row{1, 0.9093}, Row{2, 0.9094}, Row{3, 0.9094}}) {
    const Device d = test::device({.modes = modes});
    const Switch model(d);
    const DynamicPullIn found = dynamic_pull_in(model, 0, static_pull_in(model, 0));
    ASSERT_EQ(found.status, Status::done);
    EXPECT_NEAR(found.voltage / test::volts(d, test::full_length_beta), ratio, printed) << modes << " modes";
    if (modes == 3) {
      EXPECT_NEAR(test::beta(d, found.voltage), 1.39009, printed * 1.39009);
    }
  }
}

TEST(ClosingTime, OfAnUndampedStepIsTheReference) {
  constexpr double time_digits = 1e-3;  // relative; the reference has four digits
  struct Row {
    double over_static, four_modes, one_mode;  // V / V_SPI, w1 t to tip = 0.97 g
  };
  constexpr std::array<Row, 6> reference{{{1.0, 3.785, 3.836},
                                          {1.1, 3.043, 3.088},
                                          {1.2, 2.626, 2.657},
                                          {1.3, 2.325, 2.356},
                                          {1.5, 1.919, 1.945},
                                          {2.0, 1.370, 1.384}}};
  for (const int modes : {4, 1}) {
    const Device d = test::device({.modes = modes});
    const Switch model(d);
    const double frequency = model.basis().angular_frequencies()[0];
    for (const Row& row : reference) {
      const std::vector<Signal> drives{Signal::constant(row.over_static * test::volts(d, test::full_length_beta))};
      const Trajectory trajectory = simulate_closing(model, drives, {.duration = 10 / frequency, .tolerance = 1e-9});
      ASSERT_EQ(trajectory.touches.size(), 1u) << "V/Vsp = " << row.over_static;
      const double expected = modes == 4 ? row.four_modes : row.one_mode;
      EXPECT_NEAR(frequency * trajectory.touches[0].begin, expected, time_digits * expected)
          << modes << " modes, V/Vsp = " << row.over_static;
    }
  }
}

}  // namespace
}  // namespace softland
