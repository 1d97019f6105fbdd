// One channel of a recording as voltages over times that do not go back.
#pragma once

#include <string>
#include <vector>

#include "exchange/recording.h"

namespace softland {

struct Trace {
  std::vector<double> times;   ///< [s], not decreasing; two of one time are a jump
  std::vector<double> values;  ///< [V], or of the unit where `keys.unit` is none of voltage
  std::string told;            ///< one line: what was taken, and what was left out
};

/// The channel of channel_of() over the times that `keys`, with which it was read, and the file say. Throws InvalidInput with
/// file, line and the key that decides. It does so if there is no such channel, or if times repeat, go back or drift from the
/// interval of the file, or where there are none. It also does where a value is not finite between finite ones, and where the
/// unit is not a voltage unless `any_unit`.
[[nodiscard]] Trace trace_of(const Recording& recording, const ReadKeys& keys, const std::string& usual, bool any_unit = false);

}  // namespace softland
