// Finds the times at which a contact closes and opens, from a recorded voltage that crosses a threshold.
//
//   closed while the recorded voltage is above the threshold (below it, if is_closed_below); the state changes when the voltage
//   has passed the threshold by hysteresis / 2
//
// The time of the change is that of the last crossing of the threshold before it, by linear interpolation between rows. States
// that last for less than `merge` are ignored: first short openings, then short contacts.
#pragma once

#include <string>
#include <vector>

#include "exchange/trace.h"

namespace softland {

struct ThresholdKeys {
  /// Threshold of the recorded voltage [unit of the trace]; NaN if not given: contact_edges() then uses 1/2 for a channel of
  /// states 0 and 1.
  double threshold = 0;
  double hysteresis = 0;  ///< width of the band about the threshold that a change of state must cross [unit of the trace], >= 0
  bool is_closed_below = false;  ///< true if the contact is closed while the voltage is below the threshold
  double merge = 0;              ///< duration below which a contact state is ignored [s]
};

struct LevelEdge {
  double time = 0;      ///< time at which the contact closes or opens [s]
  bool closed = false;  ///< true if the contact closes at this time, false if it opens
};

/// Returns the closing and opening times of the contact in order, alternately closing and opening. A trace that begins closed
/// has its first closing at its first row.
[[nodiscard]] std::vector<LevelEdge> level_edges(const Trace& trace, const ThresholdKeys& keys);

/// The shift of the times of a recorded file.
struct TimeShift {
  bool first_is_zero = false;  ///< true: times are shifted so that the first row is at t = 0
  double shift = 0;            ///< time added to all times if first_is_zero is false [s]
};
void shift_times(Trace& trace, const TimeShift& shift);

struct ContactTraceKeys {
  ReadKeys file;
  TimeShift shift = {};
  ThresholdKeys contact;
};
/// Returns the closing and opening times of the contact from t = 0 on, when the drives begin, from the voltage in a file of an
/// instrument. Throws InvalidInput as read_recording() and trace_of() do, for a contact that is closed at t = 0, and for a
/// missing threshold unless the channel holds states 0 and 1.
[[nodiscard]] std::vector<LevelEdge> contact_edges(const std::string& file, const ContactTraceKeys& keys);
/// Returns the closing and opening times of the contact from a recorded trace; `name` is the name of the trace in messages.
[[nodiscard]] std::vector<LevelEdge> contact_edges(const Trace& trace, const ThresholdKeys& keys, const std::string& name);

}  // namespace softland
