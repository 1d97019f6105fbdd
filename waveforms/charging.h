// The energy that charging a capacitor with a drive voltage again and again takes.
#pragma once

#include "waveforms/signal.h"

namespace softland {

/// Half the sum of all rises of V^2 on [0, end], a jump at t = 0 included [V^2]: the energy per capacitance that a source gives
/// which takes none back when the voltage falls. 1/2 V^2 for a rise from 0 V to V. It is good to 1e-9 of its
/// value for straight pieces, sines and terms alike. Throws InvalidInput unless end >= 0 is finite.
[[nodiscard]] double charging(const Signal& signal, double end);

}  // namespace softland
