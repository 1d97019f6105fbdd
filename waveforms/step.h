// Step: 0 V before t = 0, a linear rise to `level` on [0, rise_time], then constant.
#pragma once

#include "waveforms/signal.h"

namespace softland {

struct Step {
  double level = 0;      ///< [V]
  double rise_time = 0;  ///< [s], >= 0
};

[[nodiscard]] Signal signal(const Step& step);

}  // namespace softland
