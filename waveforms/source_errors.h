// Errors of a voltage source: the applied voltage V when the signal f is commanded.
//
//   V(t) = gain f(t - delay) + offset for t >= 0, the voltage of f before t = 0 else; every edge of f has a delay of its own
//
// An edge is a jump, a ramp between two levels, which moves as a whole, or a corner where ramps or curves meet; a curve between
// two edges is stretched with them. The edges of a harmonic's sine are where it begins, ends or fades: the carrier keeps its
// phase. f begins with its first edge; before it, only the offset acts. An edge moves towards a neighbour by at most 0.49 of
// the time between them, so that edges keep their order and pulses their levels; the first edge may move back, and the last
// edge forth, without limit.
//
// A simulation begins at t = 0 at rest under the voltage before t = 0. If an edge would be earlier than t = 0, the time axis is
// shifted so that it begins at the first edge. All drives of a device must then have the same shift.
#pragma once

#include <cstddef>
#include <vector>

#include "waveforms/signal.h"

namespace softland {

struct SourceErrors {
  double gain = 1;                 ///< > 0
  double offset = 0;               ///< [V]
  double delay = 0;                ///< delay of the whole signal f [s]
  std::vector<double> edges = {};  ///< delay of each edge [s]; 0 for missing elements

  [[nodiscard]] bool are_none() const { return gain == 1 && offset == 0 && delay == 0 && edges.empty(); }
};

/// Returns the number of edges, including an edge at t = 0 unless the voltage is constant there.
[[nodiscard]] std::size_t edge_count(const Signal& signal);

/// Returns the time of the first edge [s], which may be before 0; infinity without an edge.
[[nodiscard]] double first_edge(const Signal& signal, const SourceErrors& errors);

/// Returns the signal with these errors, with time counted from `origin` [s], which is at most 0; an edge before `origin` is
/// moved to `origin`. Throws InvalidInput unless all numbers are finite and the gain is > 0.
[[nodiscard]] Signal with_errors(const Signal& signal, const SourceErrors& errors, double origin = 0);

}  // namespace softland
