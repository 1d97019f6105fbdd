// Example 02: pull-in voltages over two dimensions of a device that is described here, not in a file.
//
// The actuators that Rauf et al. measured (J. MEMS 31(1) (2022) 29-36): 70 silicon fingers on two springs. The map is over the
// overlap of the fingers and the width of the springs; its column of 3 um and its row of 76.5 um are those of
// results/measured-actuators.md.
//
//   02_pull_in_map
//
//   pull-in voltage [V] over the springs' width [um] to the right and the fingers' overlap [um] downwards
//                2     2.5       3     3.5       4     4.5       5     5.5
//    15.3    16.05   27.09   39.85 ...
#include <softland/softland.h>

#include <cmath>
#include <cstdio>
#include <exception>

// Lengths in metres, as drawn; the etch takes 0.4 um off every edge.
softland::Device actuator(double overlap, double spring_width) {
  const double etch = 0.4e-6, layer = 40e-6, fingers = 70, finger = 5.01e-6 - 2 * etch;
  const double facing = overlap - etch, spring = spring_width - 2 * etch, modulus = 169e9 / (1 - 0.069 * 0.069);
  return {.structure = {.length = fingers * facing,
                        .width = layer,
                        .thickness = finger,
                        .kind = softland::Plate{.mass = 3.5e-9,  // no matter at rest
                                                .stiffness = 2 * modulus * std::pow(spring / 241e-6, 3) * layer}},
          .gap = {.electrode = 4.83e-6 + 2 * etch, .contact = 3.83e-6 + 2 * etch},
          .electrodes = {{.name = "main",
                          .begin = 0,
                          .end = fingers * facing,
                          .fringing = softland::Fringing::meijs_fokkema,
                          .side = softland::Side::both,  // a comb: the back of each finger pulls the other way
                          .gap = 7.75e-6 + 2 * etch}}};
}

int main() try {
  const double widths[] = {2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5};
  const double overlaps[] = {15.3, 22.95, 30.6, 38.25, 45.9, 53.55, 61.2, 68.85, 76.5};
  std::puts("pull-in voltage [V] over the springs' width [um] to the right and the fingers' overlap [um] downwards");
  std::printf("%7s", "");
  for (const double width : widths) std::printf("%8g", width);
  for (const double overlap : overlaps) {
    std::printf("\n%7g", overlap);
    for (const double width : widths) {
      // A Switch is the device made ready: it refuses what cannot be built. Electrode 0 is "main".
      const softland::Switch model(actuator(1e-6 * overlap, 1e-6 * width));
      const softland::StaticPullIn found = softland::static_pull_in(model, 0);
      std::printf("%8.2f", found.voltage);
    }
  }
  std::puts("");
  return 0;
} catch (const softland::InvalidInput& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
