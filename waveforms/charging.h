// The energy that a source supplies when a drive voltage charges a capacitor repeatedly.
#pragma once

#include "waveforms/signal.h"

namespace softland {

/// Returns half the sum of all rises of V^2 of a drive voltage on [0, end], including a jump at t = 0 [V^2]: 1/2 V^2 for a rise
/// from 0 V to V. Times the capacitance, this is the energy from a source that recovers no energy when the voltage falls. The
/// relative error is 1e-9. Throws InvalidInput unless end >= 0 is finite.
[[nodiscard]] double charging(const Signal& signal, double end);

}  // namespace softland
