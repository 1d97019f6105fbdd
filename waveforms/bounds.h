// Bounds on the derivatives of a piece, and the extrema that follow from them without a closed form.
#pragma once

#include <vector>

#include "waveforms/pieces.h"

namespace softland::internal {

/// A bound on the absolute value of a derivative of the voltage on [from, to], of `order` 2 to 4 [V/s^order]; of order 0, of the
/// terms and the sine alone.
[[nodiscard]] double derivative_bound(const SignalPieceOf<double>& piece, int order, double from, double to);

/// Appends times in [from, to] at which the voltage (`of_rate`: its rate) of a piece with terms comes within 1e-9 of the largest
/// and of the smallest it takes there, relative to the size of what it is made of: intervals are halved until their ends and the
/// bound on the curvature between them leave nothing to gain.
void append_extrema_of_terms(std::vector<double>& times, const SignalPieceOf<double>& piece, bool of_rate, double from,
                             double to);

/// After so long [s] nothing is left of terms that decay, in double precision; infinity where one does not.
[[nodiscard]] double duration_of_terms(const SignalPieceOf<double>& piece);

}  // namespace softland::internal
