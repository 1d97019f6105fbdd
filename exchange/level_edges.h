// When a voltage says that a contact is closed: the times at which a trace crosses a threshold.
//
//   closed from where the trace is hysteresis / 2 beyond the threshold, until it is as far on its other side
//
// The time of an edge is that of the last crossing of the threshold itself before, by a straight line between the rows. States
// that last for less than `merge` are none: openings first, then touches.
#pragma once

#include <vector>

#include "exchange/trace.h"

namespace softland {

struct ThresholdKeys {
  double threshold = 0;          ///< [unit of the trace]
  double hysteresis = 0;         ///< [unit of the trace], not negative
  bool is_closed_below = false;  ///< rather than above
  double merge = 0;              ///< [s]
};

struct LevelEdge {
  double time = 0;      ///< [s]
  bool closed = false;  ///< from then on
};

/// In order, by turns closed and open. A trace that begins closed has its first edge at its first row.
[[nodiscard]] std::vector<LevelEdge> level_edges(const Trace& trace, const ThresholdKeys& keys);

}  // namespace softland
