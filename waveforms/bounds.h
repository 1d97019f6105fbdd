// Bounds on the derivatives of one piece of a voltage signal. From these bounds extrema are found that have no closed form.
#pragma once

#include <vector>

#include "waveforms/pieces.h"

namespace softland::internal {

/// Returns a bound on the absolute value of a derivative of a piece's voltage on [from, to], for `order` 2 to 4 [V/s^order].
/// For order 0 it is a bound on the voltage without its straight line (value and slope).
[[nodiscard]] double derivative_bound(const SignalPieceOf<double>& piece, int order, double from, double to);

/// Appends a time in [from, to] of the largest and one of the smallest voltage of a piece with terms (TermOf); with `of_rate`,
/// of dV/dt. The value at such a time is within 1e-9 of the extremum, relative to the size of the piece's parts. Intervals are
/// halved until the values at their ends and the bound on the second derivative exclude a larger value between.
void append_extrema_of_terms(std::vector<double>& times, const SignalPieceOf<double>& piece, bool of_rate, double from,
                             double to);

/// Returns how long after the beginning of a signal piece [s] its decaying terms vanish in double precision; infinity if a term
/// does not decay.
[[nodiscard]] double duration_of_terms(const SignalPieceOf<double>& piece);

}  // namespace softland::internal
