// S-curve waveform: a pulse whose edges are half cosines, which begin and end without a corner: n voltage levels, n - 1
// switching times. The first edge runs on [0, edge] from the voltage before t = 0; the edge from level k to level k + 1 runs on
// [t_k, t_k + edge]:
//
//   V(t) = (V_k + V_(k+1)) / 2 - (V_(k+1) - V_k) / 2 cos(pi (t - t_k) / edge)
//
// The last level is held without end. An S-curve with one level is a single smooth rise.
#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <vector>

#include "waveforms/parameter.h"
#include "waveforms/signal.h"

namespace softland {

template <class P>
struct SCurveOf {
  std::vector<P> levels = {};  ///< voltage levels [V]; at least one
  /// Switching times, one fewer than levels [s], increasing by at least edge; the first at least edge.
  std::vector<P> times = {};
  P edge = 0;  ///< duration of the edge between two levels [s], >= 0
};
using SCurve = SCurveOf<double>;

template <>
struct FamilyOf<SCurve> {
  static constexpr std::string_view name = "s-curve";
  static constexpr auto parameters = std::to_array<Parameter<SCurve>>({
      {"levels", ParameterKind::level, &SCurve::levels, true, "one level or more; the last one is held"},
      {"times", ParameterKind::time, &SCurve::times, false,
       "one time less than levels: when the edge to the next level begins; rising by at least edge, from edge on"},
      {"edge", ParameterKind::time, &SCurve::edge, false,
       "duration of every edge, half a cosine; the first, from `before`, runs on [0, edge]"},
  });
  [[nodiscard]] static SCurve example() { return {.levels = {1, -2, 0.5}, .times = {1, 4}, .edge = 0.5}; }
};

/// Returns the signal pieces of a valid S-curve, which begins at the voltage `before` [V].
template <class P>
[[nodiscard]] Pieces<P> pieces(const SCurveOf<P>& curve, const P& before = P(0)) {
  const bool has_edges = internal::decided(curve.edge > P(0));
  Pieces<P> all;
  P time = P(0), level = before, edge_end = P(0);
  for (std::size_t k = 0; k < curve.levels.size(); ++k) {
    if (k > 0) {
      time = curve.times[k - 1];
      if (!internal::coincide(edge_end, time)) all.push_back({.begin = edge_end, .value = level});
    }
    const P next = curve.levels[k];
    if (has_edges) {
      SignalPieceOf<P> piece{.begin = time, .value = P(0.5) * (level + next)};
      piece.terms.push_back(
          {.cosine = {P(0.5) * (level - next), P(0), P(0), P(0)}, .angular_frequency = P(std::numbers::pi) / curve.edge});
      all.push_back(piece);
    }
    level = next;
    edge_end = time + curve.edge;
  }
  all.push_back({.begin = edge_end, .value = level});
  return all;
}
/// Compiles the S-curve to a voltage signal. Throws InvalidParameter for an invalid curve.
[[nodiscard]] Signal signal(const SCurve& curve, double before = 0);

}  // namespace softland
