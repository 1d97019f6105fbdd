// Errors of a voltage source: the voltage that it gives when the signal f is commanded.
//
//   V(t) = gain f(t - delay) + offset for t >= 0, f's own voltage before, with every edge of f late by a time of its own
//
// An edge is a jump, a ramp between two levels, which moves as a whole, or a corner where ramps or curves meet; a curve between
// two edges is stretched with them. The edges of a harmonic's sine are where it begins, ends or fades: the carrier keeps its
// phase. f begins with its first edge; before it, only the offset acts. An edge moves towards a neighbour by at most 0.49 of
// the time between them, so that edges keep their order and pulses their levels; the room before the first and after the last
// is unlimited.
//
// A run begins at t = 0 at rest under that voltage. A delay or an edge that is early by more than the time before it cuts
// nothing off: the clock begins at the first edge instead. All drives of a device must then share that clock.
#pragma once

#include <cstddef>
#include <vector>

#include "waveforms/signal.h"

namespace softland {

struct SourceErrors {
  double gain = 1;                 ///< > 0
  double offset = 0;               ///< [V]
  double delay = 0;                ///< delay of the whole signal f [s]
  std::vector<double> edges = {};  ///< delay of each edge [s]; missing edges are in time

  [[nodiscard]] bool are_none() const { return gain == 1 && offset == 0 && delay == 0 && edges.empty(); }
};

/// Returns the number of edges. One at t = 0 counts, unless the signal continues there at its voltage before.
[[nodiscard]] std::size_t edge_count(const Signal& signal);

/// Returns the time of the first edge [s], which may be before 0; infinity without an edge.
[[nodiscard]] double first_edge(const Signal& signal, const SourceErrors& errors);

/// Returns the signal with these errors. Its clock is at 0 where that of `errors` is at `origin` [s], which is at most 0: an
/// edge before it comes at 0. Throws InvalidInput unless all numbers are finite and the gain is > 0.
[[nodiscard]] Signal with_errors(const Signal& signal, const SourceErrors& errors, double origin = 0);

}  // namespace softland
