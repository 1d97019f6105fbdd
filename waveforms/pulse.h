// Pulse: n levels, n - 1 switching times, linear edges. The first edge runs from 0 V on [0, edge]; the edge from level k to level
// k + 1 runs on [t_k, t_k + edge]. The last level holds for ever.
#pragma once

#include <array>
#include <vector>

#include "waveforms/parameter.h"
#include "waveforms/signal.h"

namespace softland {

struct Pulse {
  std::vector<double> levels = {};  ///< [V], n >= 1
  std::vector<double> times = {};   ///< [s], n - 1, increasing by at least edge; the first at least edge
  double edge = 0;                  ///< [s], >= 0
};

template <>
struct FamilyOf<Pulse> {
  static constexpr std::string_view name = "pulse";
  static constexpr auto parameters = std::to_array<Parameter<Pulse>>({
      {"levels", Meaning::level, &Pulse::levels, true, "n levels; the last is held for ever"},
      {"times", Meaning::time, &Pulse::times, false, "n - 1 times at which the edge to the next level begins"},
      {"edge", Meaning::time, &Pulse::edge, false, "duration of every linear edge"},
  });
};

[[nodiscard]] Signal signal(const Pulse& pulse);

}  // namespace softland
