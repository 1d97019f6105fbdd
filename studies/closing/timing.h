// The time that one evaluation of the right-hand side of the equations of motion takes on this machine.
#pragma once

#include <vector>

#include "model/switch.h"
#include "waveforms/signal.h"

namespace softland {

/// Adds a state of a closing (q, v and further states of the laws) to `states`, which holds at most 20,000 states.
void keep_state(const Switch& model, const double* q, std::vector<double>& states);

/// Returns the median time of a call of Switch::accelerations [s], over `repeats` passes through these states, under these
/// voltages; NaN without states.
[[nodiscard]] double right_hand_side_seconds(const Switch& model, const std::vector<double>& volts,
                                             const std::vector<double>& states, int repeats = 9);

/// Returns the median time of a call of Switch::accelerations [s] over the first states of a closing, in flight and in contact.
[[nodiscard]] double right_hand_side_seconds(const Switch& model, const std::vector<Signal>& signals, double duration,
                                             int repeats = 9);

/// Returns the processor time of this thread [s].
[[nodiscard]] double processor_seconds();

}  // namespace softland
