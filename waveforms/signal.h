// A drive voltage against time, compiled from a waveform family into pieces that are smooth inside (pieces.h). Before t = 0 the
// voltage is constant, 0 V by default; a simulation starts at rest under this voltage. Time integration stops at every
// breakpoint, so that no step crosses a corner or a jump.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "waveforms/pieces.h"

namespace softland {

using SignalPiece = SignalPieceOf<double>;
using SignalTerm = TermOf<double>;

class Signal {
 public:
  /// Creates a signal of 0 V at all times.
  Signal() : pieces_{SignalPiece{}} {}
  /// Makes a signal of voltage pieces. Throws InvalidInput unless the first piece begins at 0, the beginnings strictly
  /// increase, every number is finite, the angular frequency is positive where there is an amplitude, and no term grows. The
  /// last piece has no end, so it must have no slope, no amplitude_slope, and only terms that decay without a sweep. `before`
  /// is the voltage before t = 0 [V].
  explicit Signal(std::vector<SignalPiece> pieces, double before = 0);
  /// Returns a signal of constant voltage [V] from t = 0 on.
  static Signal constant(double voltage, double before = 0);
  /// Returns a signal of one voltage [V] at all times, before t = 0 too.
  static Signal standing(double voltage);
  /// Returns the signal of straight lines between points (time [s], voltage [V]); the last voltage is held. Two points of equal
  /// time are a jump. The breakpoints are the times of the points, without points at the end that only repeat the held voltage.
  /// Throws InvalidInput unless there is a point, times start at 0 and do not decrease, and every number is finite.
  static Signal piecewise_linear(const std::vector<std::pair<double, double>>& points, double before = 0);

  /// Returns the constant voltage of the signal before t = 0 [V].
  [[nodiscard]] double before() const { return before_; }
  [[nodiscard]] const std::vector<SignalPiece>& pieces() const { return pieces_; }
  /// Returns the number of the signal piece that contains a time; at a breakpoint, the number of the later piece.
  [[nodiscard]] std::size_t piece_at(double time) const;
  /// Returns the voltage of the signal at a time [V]; at a jump the voltage after the jump.
  [[nodiscard]] double voltage(double time) const;
  /// Returns the limit of the signal's voltage from the left at a time [V]. The result equals voltage(time), bit for bit, where
  /// the signal does not jump. A difference by rounding at the joint of two pieces, or of before() and a sine that starts at t
  /// = 0, does not count as a jump.
  [[nodiscard]] double voltage_before(double time) const;
  /// Returns the beginnings of all signal pieces, 0 included [s].
  [[nodiscard]] std::vector<double> breakpoints() const;
  /// Returns the voltage at which the signal ends or to which it decays [V]; for a sine without an end, its mean value.
  [[nodiscard]] double hold_level() const;
  /// Returns true if the signal is 0 V at all times.
  [[nodiscard]] bool is_zero() const;

  struct Range {
    double minimum = 0, maximum = 0;  ///< smallest and largest voltage of a signal [V]
  };
  /// Returns the smallest and largest voltage of the signal on [0, end] and before t = 0 [V], sines to 1e-9 of their amplitude
  /// and terms to 1e-9 of their size. The functions with an argument `end` throw InvalidInput unless end >= 0.
  [[nodiscard]] Range range(double end = std::numeric_limits<double>::infinity()) const;
  [[nodiscard]] double maximum(double end = std::numeric_limits<double>::infinity()) const { return range(end).maximum; }
  [[nodiscard]] double minimum(double end = std::numeric_limits<double>::infinity()) const { return range(end).minimum; }
  /// Returns the largest |V| of the signal on [0, end] [V].
  [[nodiscard]] double peak(double end = std::numeric_limits<double>::infinity()) const;
  /// Returns the largest |dV/dt| of the signal on [0, end] [V/s]; infinity if there is a jump, at t = 0 too.
  [[nodiscard]] double peak_slew(double end = std::numeric_limits<double>::infinity()) const;
  /// Returns an integrator step length that resolves the signal's piece at `time` [s]: a fraction of its shortest period, and
  /// at most its shortest time constant; infinity without periods and time constants.
  [[nodiscard]] double resolving_step(double time) const;

 private:
  /// Returns the limit of the voltage from the left at the beginning of piece number `next` [V]; see voltage_before().
  [[nodiscard]] double left_limit(std::size_t next) const;

  std::vector<SignalPiece> pieces_;
  double before_ = 0;
};

/// Returns the final (hold) voltage of each signal [V].
[[nodiscard]] std::vector<double> hold_levels(std::span<const Signal> signals);
/// Returns the voltage of each signal before t = 0 [V].
[[nodiscard]] std::vector<double> values_before(std::span<const Signal> signals);
/// Returns the time at which the last piece of any signal begins [s].
[[nodiscard]] double last_breakpoint(std::span<const Signal> signals);

/// Returns the signal until `time` [s], followed by the constant voltage that the signal has just before `time` (for 0 s, the
/// voltage before t = 0).
[[nodiscard]] Signal held_from(const Signal& signal, double time);
/// Returns the part of a signal from the breakpoint `time` [s] on, with time counted from this breakpoint. The signal must be
/// constant before `time`. `before` is the voltage of the result before its t = 0 [V].
[[nodiscard]] Signal part_from(const Signal& signal, double time, double before = 0);

/// Returns the signal with its voltage multiplied by a finite number.
[[nodiscard]] Signal scaled(const Signal& signal, double factor);

}  // namespace softland
