// Gap-closing actuators measured by Rauf, Contreras, Shih, Schindler & Pister, J. MEMS 31(1) (2022) 29-36 (data published with
// the paper), as devices: scenes/gap-closing-actuator.toml for any overlap of the fingers.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "base/literals.h"
#include "model/device.h"

namespace softland::test {

/// Published depth of the etch at every edge [m], and Young's modulus of the textbook [Pa].
inline constexpr double published_undercut = 0.4e-6, textbook_modulus = 169e9;

/// Returns an actuator whose nominal design has this overlap of the fingers [m] and this width of the springs [m].
[[nodiscard]] inline Device gap_closing_actuator(double overlap, double spring_width = 3e-6, double undercut = published_undercut,
                                                 double youngs_modulus = textbook_modulus) {
  using namespace literals;
  constexpr double layer = 40_um, density = 2300, fingers = 70, root = 10_um, spring_length = 241_um;
  const double modulus = youngs_modulus / (1 - 0.069 * 0.069);
  const double finger = 5.01_um - 2 * undercut, hole = 8_um + 2 * undercut, holes = 61;
  const double spine = (20_um - 2 * undercut) * (860_um - 2 * undercut) - holes * hole * hole;
  const double stops = 2 * (10_um - 2 * undercut) * (45_um - undercut);
  const double spring = spring_width - 2 * undercut, facing = overlap - undercut;
  const double moving = spine + stops + fingers * (facing + root) * finger;
  return {.structure = {.length = fingers * facing,
                        .width = layer,
                        .thickness = finger,
                        .kind = Plate{.mass = density * layer * (moving + 2 * 13.0 / 35 * spring * spring_length),
                                      .stiffness = 2 * modulus * std::pow(spring / spring_length, 3) * layer}},
          .gap = {.electrode = 4.83_um + 2 * undercut, .contact = 3.83_um + 2 * undercut},
          .electrodes = {{.name = "main",
                          .begin = 0,
                          .end = fingers * facing,
                          .fringing = Fringing::meijs_fokkema,
                          .side = Side::both,
                          .gap = 7.75_um + 2 * undercut}},
          .gas = StripSlitGas{.film = {.viscosity = 1.85e-5_Pa_s},
                              .film_length = facing,
                              .slit_height = 2_um,
                              .slit_length = finger / 2,
                              .far_gap = 7.75_um + 2 * undercut},
          .contacts = {Contact{.model = LinearSpring{.stiffness = 1e5_N_m}}}};
}

/// Voltages at which three chips pulled in and one released [V]; the error of the instrument is 1 V.
struct MeasuredPullIn {
  double overlap;  ///< [m]
  std::array<double, 3> pull_in;
  double pull_out;
};
inline constexpr std::array<MeasuredPullIn, 9> measured_pull_in{{{15.3e-6, {35.3, 33.5, 33.3}, 18.0},
                                                                 {22.95e-6, {32.0, 30.5, 30.6}, 14.5},
                                                                 {30.6e-6, {25.8, 24.7, 25.0}, 12.2},
                                                                 {38.25e-6, {24.6, 24.0, 24.0}, 11.3},
                                                                 {45.9e-6, {22.3, 21.9, 21.9}, 10.6},
                                                                 {53.55e-6, {20.9, 20.2, 20.1}, 9.7},
                                                                 {61.2e-6, {19.0, 18.8, 18.7}, 8.8},
                                                                 {68.85e-6, {17.9, 17.6, 17.4}, 8.4},
                                                                 {76.5e-6, {16.6, 16.6, 16.5}, 8.0}}};

/// Pull-in voltages for other widths of the springs, at an overlap of 76.5 um.
struct MeasuredSprings {
  double width;  ///< nominal width [m]
  double pull_in, pull_out;
};
inline constexpr std::array<MeasuredSprings, 8> measured_springs{{{2e-6, 6.3, 2.4},
                                                                  {2.5e-6, 11.1, 5.4},
                                                                  {3e-6, 16.6, 7.7},
                                                                  {3.5e-6, 22.8, 9.9},
                                                                  {4e-6, 29.5, 13.0},
                                                                  {4.5e-6, 36.4, 16.6},
                                                                  {5e-6, 44.0, 21.1},
                                                                  {5.5e-6, 51.5, 24.6}}};

/// Time from the step to the stop, as the mean of three or four closings.
struct MeasuredTime {
  double volts;
  double time;  ///< [s]
};
struct MeasuredTimes {
  double overlap;  ///< [m]
  std::vector<MeasuredTime> times;
};
inline const std::array<MeasuredTimes, 2> measured_times{{{76.5e-6,
                                                           {{20, 90.9e-6},
                                                            {25, 57.9e-6},
                                                            {30, 43.17e-6},
                                                            {35, 34.87e-6},
                                                            {40, 29.37e-6},
                                                            {45, 25.5e-6},
                                                            {50, 23.07e-6},
                                                            {55, 20.47e-6},
                                                            {60, 18.63e-6},
                                                            {65, 17.03e-6},
                                                            {70, 15.43e-6},
                                                            {75, 14.23e-6},
                                                            {80, 13.3e-6}}},
                                                          {15.3e-6,
                                                           {{41, 55.05e-6},
                                                            {45, 43.98e-6},
                                                            {50, 37.38e-6},
                                                            {55, 32.8e-6},
                                                            {60, 29.45e-6},
                                                            {65, 26.68e-6},
                                                            {70, 24.6e-6},
                                                            {75, 22.83e-6},
                                                            {80, 21.15e-6},
                                                            {85, 19.88e-6},
                                                            {90, 18.6e-6},
                                                            {95, 17.58e-6},
                                                            {100, 16.73e-6}}}}};

}  // namespace softland::test
