// One channel of a recording as values over times that do not decrease.
#pragma once

#include <string>
#include <vector>

#include "exchange/recording.h"

namespace softland {

struct Trace {
  std::vector<double> times;   ///< times of the rows [s], not decreasing; two rows of equal time are a jump
  std::vector<double> values;  ///< values of the channel [V; if its unit is not one of voltage, in this unit]
  std::string note;            ///< one line for the user: which channel and times are used, and what was left out
};

/// Returns the values of the channel that channel_of() selects, over the times according to the file and to `keys`. Throws
/// InvalidInput for a missing channel, and for times that are missing, repeat, decrease or deviate from the interval of the
/// file; the message names file, line and the key by which the user decides. Throws InvalidInput also for a value that is not
/// finite between finite values, and, unless `any_unit`, for a unit other than a voltage.
[[nodiscard]] Trace trace_of(const Recording& recording, const ReadKeys& keys, const std::string& usual, bool any_unit = false);

}  // namespace softland
