// Errors of a voltage source: the applied voltage V when the signal f is commanded.
//
//   V(t) = gain f(t - delay) + offset for t >= 0, the voltage of f before t = 0 otherwise; every edge of f has its own delay
//
// An edge is a jump, a ramp between two levels, which moves as a whole, or a corner where ramps or curves meet; a curve between
// two edges is stretched with them. The edges of a harmonic's sine are where the sine begins, ends or fades: the sine keeps its
// phase. f begins with its first edge; before this edge, only the offset changes the voltage. An edge moves towards a neighbour
// by at most 0.49 of the time between them, so that edges keep their order and pulses their levels; the first edge may move
// back, and the last edge forward, without limit.
//
// A simulation begins at t = 0 at rest under the voltage before t = 0. If delays would move an edge to a time before t = 0, the
// time axis is shifted so that it begins at the first edge. All drives of a device must then have the same shift.
#pragma once

#include <cstddef>
#include <vector>

#include "waveforms/signal.h"

namespace softland {

struct SourceErrors {
  double gain = 1;                 ///< factor on the commanded voltage, > 0
  double offset = 0;               ///< voltage added to the commanded voltage [V]
  double delay = 0;                ///< delay of the whole commanded signal [s]
  std::vector<double> edges = {};  ///< additional delay of each edge of the signal [s]; 0 for missing elements

  [[nodiscard]] bool are_none() const { return gain == 1 && offset == 0 && delay == 0 && edges.empty(); }
};

/// Returns the number of edges of a voltage signal, including an edge at t = 0 unless the voltage is constant there.
[[nodiscard]] std::size_t edge_count(const Signal& signal);

/// Returns the time of the first voltage edge with its delays [s], which may be negative; infinity for a signal without an
/// edge.
[[nodiscard]] double first_edge(const Signal& signal, const SourceErrors& errors);

/// Returns the voltage that a source with these errors applies for the commanded signal. Time counts from `origin` [s], at most
/// 0, as first_edge() may return; an edge before `origin` is moved to `origin`. Throws InvalidInput unless all numbers are
/// finite and the gain is > 0.
[[nodiscard]] Signal with_errors(const Signal& signal, const SourceErrors& errors, double origin = 0);

}  // namespace softland
