// Judges whether the states before and after a closing depend on the number of modes.
#pragma once

#include <vector>

#include "studies/closing/simulate.h"

namespace softland {

/// Repeats the static equilibria of a run that began closed, with more modes. The run fails if the closed state in which it
/// began, or the open state in which it ends, is not stable with more modes.
void judge_opening_with_more_modes(Closing& closing, const PreparedScene& prepared, const std::vector<Signal>& signals);
/// Repeats the static equilibria of a closing with more modes. A switch that stays closed with the scene's modes has not
/// settled if it opens with twice or four times as many modes.
void judge_with_more_modes(Closing& closing, const PreparedScene& prepared, const std::vector<Signal>& signals);

}  // namespace softland
