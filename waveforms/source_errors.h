// Errors of a voltage source: what comes out where it is told to give the signal f.
//
//   V(t) = gain f(t - delay) + offset for t >= 0, f's own voltage before, with every edge of f late by a time of its own
//
// An edge is a jump, a ramp between two levels, which moves as a whole, or a
// corner where ramps or curves meet; a curve between two edges is stretched with them. Of the sine of a harmonic it is where the
// sine begins, ends or fades: the carrier keeps its phase. f begins with its first edge; before it, only the offset is there. An
// edge moves towards a neighbour by at most 0.49 of the time between them, so that edges keep their order and pulses their
// levels; before the first and after the last there is room without end.
//
// A run begins at t = 0 at rest under that voltage. Where a delay or an edge is early by more than there is before it, nothing is
// cut off: the clock begins at the first edge instead. It is then to be the same clock for all drives of a device.
#pragma once

#include <cstddef>
#include <vector>

#include "waveforms/signal.h"

namespace softland {

struct SourceErrors {
  double gain = 1;                 ///< > 0
  double offset = 0;               ///< [V]
  double delay = 0;                ///< of all of f [s]
  std::vector<double> edges = {};  ///< by which each edge is late [s]; those that are missing are in time

  [[nodiscard]] bool are_none() const { return gain == 1 && offset == 0 && delay == 0 && edges.empty(); }
};

/// The number of edges. One at t = 0 counts, unless the signal goes on there at the voltage it has stood at.
[[nodiscard]] std::size_t edge_count(const Signal& signal);

/// When the first edge comes [s], which may be before 0; infinity where there is none.
[[nodiscard]] double first_edge(const Signal& signal, const SourceErrors& errors);

/// The signal with these errors. Its clock is at 0 where that of `errors` is at `origin` [s], which is at most 0: an edge before
/// it comes at 0. Throws InvalidInput unless all numbers are finite and the gain is > 0.
[[nodiscard]] Signal with_errors(const Signal& signal, const SourceErrors& errors, double origin = 0);

}  // namespace softland
