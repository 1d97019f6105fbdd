// Pulse waveform: n voltage levels, n - 1 switching times, linear edges. The first edge runs on [0, edge] from the voltage
// before t = 0; the edge from level k to level k + 1 runs on [t_k, t_k + edge]. The last level is held without end.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "waveforms/parameter.h"
#include "waveforms/signal.h"

namespace softland {

template <class P>
struct PulseOf {
  std::vector<P> levels = {};  ///< voltage levels [V]; at least one
  /// Switching times, one fewer than levels [s], increasing by at least edge; the first at least edge.
  std::vector<P> times = {};
  P edge = 0;  ///< duration of the edge between two levels [s], >= 0
};
using Pulse = PulseOf<double>;

template <>
struct FamilyOf<Pulse> {
  static constexpr std::string_view name = "pulse";
  static constexpr auto parameters = std::to_array<Parameter<Pulse>>({
      {"levels", ParameterKind::level, &Pulse::levels, true, "one level or more; the last one is held"},
      {"times", ParameterKind::time, &Pulse::times, false,
       "one time less than levels: when the edge to the next level begins; rising by at least edge, from edge on"},
      {"edge", ParameterKind::time, &Pulse::edge, false,
       "duration of every linear edge; the first, from `before`, runs on [0, edge]"},
  });
  [[nodiscard]] static Pulse example() { return {.levels = {1, -2, 0.5}, .times = {1, 4}, .edge = 0.5}; }
};

/// Returns the points (time [s], voltage [V]) that straight lines connect, for a valid pulse that begins at the voltage
/// `before` [V].
template <class P>
[[nodiscard]] std::vector<std::pair<P, P>> points(const PulseOf<P>& pulse, const P& before = P(0)) {
  std::vector<std::pair<P, P>> all{{P(0), before}};
  P edge_end = pulse.edge;
  for (std::size_t k = 0; k < pulse.times.size(); ++k) {
    const P& time = pulse.times[k];
    if (!internal::coincide(edge_end, time)) all.emplace_back(edge_end, pulse.levels[k]);
    all.emplace_back(time, pulse.levels[k]);
    edge_end = time + pulse.edge;
  }
  all.emplace_back(edge_end, pulse.levels.back());
  return all;
}
template <class P>
[[nodiscard]] Pieces<P> pieces(const PulseOf<P>& pulse, const P& before = P(0)) {
  return internal::straight_pieces(points(pulse, before));
}
/// Compiles the pulse to a voltage signal. Throws InvalidParameter for an invalid pulse.
[[nodiscard]] Signal signal(const Pulse& pulse, double before = 0);

namespace internal {

/// Checks the parameters of a waveform of n levels, n - 1 switching times and a common duration of the edges; `what` is the
/// waveform's name in messages. Throws InvalidParameter for an invalid parameter.
void require_levels_and_edges(std::string_view what, const std::vector<double>& levels, const std::vector<double>& times,
                              double edge);

}  // namespace internal

}  // namespace softland
