// The cost of a right-hand side on this machine.
#pragma once

#include <vector>

#include "model/switch.h"
#include "waveforms/signal.h"

namespace softland {

/// Adds a state of a closing (q, v and the states after them), while there are fewer than 20,000 states.
void keep_state(const Switch& model, const double* q, std::vector<double>& states);

/// Seconds per Switch::accelerations over these states, one after the other, under these volts: the median of `repeats` passes;
/// NaN without states.
[[nodiscard]] double right_hand_side_seconds(const Switch& model, const std::vector<double>& volts,
                                             const std::vector<double>& states, int repeats = 9);

/// The same over the first states of a closing, in flight and in contact in their true proportion.
[[nodiscard]] double right_hand_side_seconds(const Switch& model, const std::vector<Signal>& signals, double duration,
                                             int repeats = 9);

/// Processor time of this thread [s].
[[nodiscard]] double processor_seconds();

}  // namespace softland
