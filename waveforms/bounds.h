// Bounds on the derivatives of a piece of a voltage signal, and extrema found from these bounds where there is no closed form.
#pragma once

#include <vector>

#include "waveforms/pieces.h"

namespace softland::internal {

/// Returns a bound on the absolute value of a derivative of a piece's voltage on [from, to], for `order` 2 to 4 [V/s^order];
/// for order 0 a bound on the sine and the terms, without the straight line.
[[nodiscard]] double derivative_bound(const SignalPieceOf<double>& piece, int order, double from, double to);

/// Appends times in [from, to] at which the voltage of a piece with terms (`of_rate`: its dV/dt) is within 1e-9 of its largest
/// and of its smallest value, relative to the size of its parts. Intervals are halved until the values at their ends and the
/// bound on the curvature exclude a larger value between the ends.
void append_extrema_of_terms(std::vector<double>& times, const SignalPieceOf<double>& piece, bool of_rate, double from,
                             double to);

/// Returns the time [s] after which the decaying terms of a signal piece vanish in double precision; infinity if a term does
/// not decay.
[[nodiscard]] double duration_of_terms(const SignalPieceOf<double>& piece);

}  // namespace softland::internal
