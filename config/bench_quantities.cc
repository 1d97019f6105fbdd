#include "config/bench.h"

namespace softland {

const std::vector<BenchQuantity>& bench_quantities() {
  static const std::vector<BenchQuantity> all{
      {.name = "pull_in", .dimension = dimension::voltage},
      {.name = "release", .dimension = dimension::voltage},
      {.name = "frequency", .dimension = dimension::frequency, .has_level = true},
      {.name = "capacitance", .dimension = dimension::capacitance, .has_level = true},
      {.name = "closing_time", .dimension = dimension::time, .has_level = true, .has_waveform = true},
      {.name = of_contact,
       .dimension = dimension::time,
       .has_level = true,
       .has_waveform = true,
       .is_over_time = true,
       .is_positive = false},
      {.name = "position",
       .dimension = dimension::length,
       .has_level = true,
       .has_waveform = true,
       .is_over_time = true,
       .is_positive = false},
      {.name = "velocity",
       .dimension = dimension::velocity,
       .has_level = true,
       .has_waveform = true,
       .is_over_time = true,
       .is_positive = false},
  };
  return all;
}

}  // namespace softland
