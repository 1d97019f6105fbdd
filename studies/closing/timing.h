// What a right-hand side costs on this machine.
#pragma once

#include <vector>

#include "model/switch.h"
#include "waveforms/signal.h"

namespace softland {

/// Seconds per Switch::accelerations over the very states that a closing goes through, in flight and in contact in their true
/// proportion: the median of `repeats` passes.
[[nodiscard]] double right_hand_side_seconds(const Switch& model, const std::vector<Signal>& signals, double duration,
                                             int repeats = 9);

}  // namespace softland
