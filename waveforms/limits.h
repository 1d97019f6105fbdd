// Limits of a voltage source, and the check of a signal against them.
#pragma once

#include <limits>
#include <string>

#include "waveforms/signal.h"

namespace softland {

/// Limits of a source: hard bounds of every search.
struct DriverLimits {
  double min_voltage = 0;                                     ///< [V]
  double max_voltage = 0;                                     ///< [V]
  double max_slew = std::numeric_limits<double>::infinity();  ///< [V/s]
};

/// Returns an empty text when the signal stays inside the limits for ever (to 1e-12 relative), else one sentence with the value
/// and the limit. The 0 V every signal starts from count, so that a min_voltage above 0 V is always violated. A limit that is
/// NaN is violated.
[[nodiscard]] std::string violation(const Signal& signal, const DriverLimits& limits);

}  // namespace softland
