// Figures of an opening, for motions in closed form.
#include "objectives/opening.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softland {
namespace {

constexpr double omega = 6e4, decay = 4e3, amplitude = 2e-6, open_position = 1e-8;

// Returns open + amplitude exp(-decay t) cos(omega t), with knots at every half radian, in contact until 1 us.
Trajectory ring_down(double end) {
  Trajectory t{.status = Status::done, .contact_gap = amplitude};
  for (double time = 0; time < end + 0.5 / omega; time += 0.5 / omega) {
    const double size = amplitude * std::exp(-decay * time), c = std::cos(omega * time), s = std::sin(omega * time);
    t.points.push_back({.time = time,
                        .position = open_position + size * c,
                        .velocity = size * (-decay * c - omega * s),
                        .acceleration = size * ((decay * decay - omega * omega) * c + 2 * decay * omega * s)});
  }
  t.touches = {{.begin = 0, .end = 1e-6}};
  return t;
}

// Returns the time of turning point n.
double turn(int n) { return (n * std::acos(-1.0) - std::atan(decay / omega)) / omega; }
double size_at(double time) { return amplitude * std::exp(-decay * time) * std::abs(std::cos(omega * time)); }

TEST(OpeningFigures, OfARingDownAreThoseOfItsFormula) {
  const double width = 1e-7;
  const OpeningFigures f =
      release_figures(ring_down(2e-3), {.open_position = open_position, .width = width, .drives_end = 100e-6});
  EXPECT_EQ(f.status, Status::done);
  EXPECT_EQ(f.release_time, 1e-6);
  EXPECT_EQ(f.touches, 0);
  EXPECT_NEAR(f.overshoot, size_at(turn(1)), 1e-4 * amplitude);
  // After the drives have reached their levels, the next turning point is the largest deviation.
  int next = 1;
  while (turn(next) < 100e-6) ++next;
  EXPECT_NEAR(f.residual_vibration, std::max(size_at(turn(next)), size_at(100e-6)), 1e-4 * amplitude);
  // The crossing of the band's edge follows the last turning point outside of the band.
  EXPECT_NEAR(size_at(f.settling_time), width, 1e-3 * width);
  int last = 1;
  while (size_at(turn(last + 1)) > width) ++last;
  EXPECT_GT(f.settling_time, turn(last));
  EXPECT_LT(f.settling_time, turn(last + 1));
}

TEST(OpeningFigures, SayWhatHasNotSettledOrIsStillClosed) {
  const OpeningBand band{.open_position = open_position, .width = 1e-7, .drives_end = 100e-6};
  const OpeningFigures swinging = release_figures(ring_down(200e-6), band);
  EXPECT_EQ(swinging.status, Status::not_settled);
  EXPECT_TRUE(std::isnan(swinging.settling_time));
  EXPECT_GT(swinging.residual_vibration, band.width);

  Trajectory stuck = ring_down(2e-3);
  stuck.touches.back().end = OpeningFigures::unset;
  EXPECT_EQ(release_figures(stuck, band).status, Status::not_settled);
  EXPECT_TRUE(std::isnan(release_figures(stuck, band).release_time));
  EXPECT_TRUE(std::isnan(release_figures(stuck, band).residual_vibration));
  stuck.touches = {{.begin = 0, .end = 1e-6}, {.begin = 2e-6, .end = 3e-6}};
  EXPECT_EQ(release_figures(stuck, band).touches, 1);
  EXPECT_EQ(release_figures(stuck, band).release_time, 3e-6);

  Trajectory failed = ring_down(2e-3);
  failed.status = Status::numerical_failure;
  EXPECT_EQ(release_figures(failed, band).status, Status::numerical_failure);
  EXPECT_TRUE(std::isnan(release_figures(failed, band).settling_time));
}

TEST(OpeningFigures, KnowNoVibrationBeforeTheDrivesStand) {
  const OpeningFigures f =
      release_figures(ring_down(50e-6), {.open_position = open_position, .width = 1e-7, .drives_end = 100e-6});
  EXPECT_TRUE(std::isnan(f.residual_vibration));
}

}  // namespace
}  // namespace softland
