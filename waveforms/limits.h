// Limits of a voltage source, and the check of a signal against them.
#pragma once

#include <limits>
#include <string>

#include "waveforms/signal.h"

namespace softland {

/// Limits of a voltage source, which no waveform of a search exceeds.
struct DriverLimits {
  double min_voltage = 0;                                     ///< lowest voltage of the source [V]
  double max_voltage = 0;                                     ///< highest voltage of the source [V]
  double max_slew = std::numeric_limits<double>::infinity();  ///< largest |dV/dt| of the source [V/s]
};

/// Returns an empty text if the signal never exceeds the limits of the source (to 1e-12 relative), otherwise one sentence with
/// the value and the limit. The voltage before t = 0 is checked, too: a signal that starts at 0 V violates a min_voltage above
/// 0 V. A limit of NaN counts as exceeded.
[[nodiscard]] std::string violation(const Signal& signal, const DriverLimits& limits);

}  // namespace softland
