// One channel of a recording as values over times that do not decrease.
#pragma once

#include <string>
#include <vector>

#include "exchange/recording.h"

namespace softland {

struct Trace {
  std::vector<double> times;   ///< times of the rows [s], not decreasing; two rows of equal time are a jump
  std::vector<double> values;  ///< values of the channel [V], or in the unit `keys.unit` if that is not a unit of voltage
  std::string told;            ///< one line for the user: which channel and times are used, and what was left out
};

/// Returns the values of the channel that channel_of() selects, over the times according to the file and to `keys`. Throws
/// InvalidInput with file, line and the deciding key for a missing channel, and for times that are missing, repeat, decrease or
/// deviate from the interval of the file. Throws InvalidInput also for a value that is not finite between finite values, and,
/// unless `any_unit`, for a unit other than a voltage.
[[nodiscard]] Trace trace_of(const Recording& recording, const ReadKeys& keys, const std::string& usual, bool any_unit = false);

}  // namespace softland
