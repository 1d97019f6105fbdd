// When a voltage says that a contact is closed: the times at which a trace crosses a threshold.
//
//   closed from where the trace is hysteresis / 2 beyond the threshold, until it is as far on its other side
//
// The time of an edge is that of the last crossing of the threshold itself before, by a straight line between the rows. States
// that last for less than `merge` are none: openings first, then touches.
#pragma once

#include <string>
#include <vector>

#include "exchange/trace.h"

namespace softland {

struct ThresholdKeys {
  /// [unit of the trace]; NaN where it is not given: contact_edges() takes a half for a channel of states.
  double threshold = 0;
  double hysteresis = 0;         ///< [unit of the trace], not negative
  bool is_closed_below = false;  ///< true if closed below rather than above
  double merge = 0;              ///< [s]
};

struct LevelEdge {
  double time = 0;      ///< [s]
  bool closed = false;  ///< true if the contact is closed from then on
};

/// The edges in order, by turns closed and open. A trace that begins closed has its first edge at its first row.
[[nodiscard]] std::vector<LevelEdge> level_edges(const Trace& trace, const ThresholdKeys& keys);

/// The shift that is added to the times of a file.
struct TimeShift {
  bool first_is_zero = false;  ///< the first row is at t = 0
  double shift = 0;            ///< else [s]
};
void shift_times(Trace& trace, const TimeShift& shift);

struct ContactTraceKeys {
  ReadKeys file;
  TimeShift shift = {};
  ThresholdKeys contact;
};
/// The edges from t = 0 on, when the drives begin, of a voltage that the file of an instrument holds. Throws what
/// read_recording() and trace_of() throw, and InvalidInput for a contact that is closed at t = 0 already, or without a threshold
/// for a channel that is no state.
[[nodiscard]] std::vector<LevelEdge> contact_edges(const std::string& file, const ContactTraceKeys& keys);
/// The same of a trace; `name` stands for it in messages.
[[nodiscard]] std::vector<LevelEdge> contact_edges(const Trace& trace, const ThresholdKeys& keys, const std::string& name);

}  // namespace softland
