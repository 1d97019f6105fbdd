// One channel of a recording as voltages over times that do not decrease.
#pragma once

#include <string>
#include <vector>

#include "exchange/recording.h"

namespace softland {

struct Trace {
  std::vector<double> times;   ///< times [s], not decreasing; two rows of the same time are a jump
  std::vector<double> values;  ///< values [V], or in the unit `keys.unit` if that is no unit of voltage
  std::string told;            ///< one line for the user: which channel and times are used, and what was left out
};

/// Returns the channel that channel_of() selects, over the times according to the file and to `keys`. Throws InvalidInput with
/// file, line and the deciding key for a missing channel, and for times that are missing, repeat, decrease or deviate from the
/// interval of the file. Throws also for a value that is not finite between finite values, and, unless `any_unit`, for a unit
/// other than a voltage.
[[nodiscard]] Trace trace_of(const Recording& recording, const ReadKeys& keys, const std::string& usual, bool any_unit = false);

}  // namespace softland
