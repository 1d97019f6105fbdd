// The energy needed to charge a capacitor with a drive voltage again and again.
#pragma once

#include "waveforms/signal.h"

namespace softland {

/// Returns half the sum of all rises of V^2 on [0, end], a jump at t = 0 included [V^2]. It is the energy per capacitance from
/// a source that takes none back when the voltage falls: 1/2 V^2 for a rise from 0 V to V. It is good to 1e-9 of its value for
/// straight pieces, sines and terms alike. Throws InvalidInput unless end >= 0 is finite.
[[nodiscard]] double charging(const Signal& signal, double end);

}  // namespace softland
