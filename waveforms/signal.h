// A drive voltage against time, compiled from a waveform family into pieces that are smooth inside (pieces.h). Before t = 0 it
// stands at one voltage, 0 V unless another is given: a run starts at rest under it.
// Time integration stops at every breakpoint, so that no step crosses a corner or a jump.
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
  /// 0 V for ever.
  Signal() : pieces_{SignalPiece{}} {}
  /// Throws InvalidInput unless the pieces start at 0, begins strictly increase, every number is finite, the angular frequency is
  /// positive where there is an amplitude, no term grows, and the last piece, which lasts for ever, has no slope, no
  /// amplitude_slope, and only terms that decay without a sweep.
  /// `before` is the voltage before t = 0 [V].
  explicit Signal(std::vector<SignalPiece> pieces, double before = 0);
  /// A constant voltage [V] from t = 0 on.
  static Signal constant(double voltage, double before = 0);
  /// The same voltage [V] at all times, before t = 0 too.
  static Signal standing(double voltage);
  /// Straight connections of points [s, V]; the last value holds for ever. Two points of the same time are a jump. The
  /// breakpoints are the times of the points, less those at the end that only repeat the held value. Throws InvalidInput unless
  /// there is a point, times start at 0 and do not decrease, and every number is finite.
  static Signal piecewise_linear(const std::vector<std::pair<double, double>>& points, double before = 0);

  /// [V] for time < 0
  [[nodiscard]] double before() const { return before_; }
  [[nodiscard]] const std::vector<SignalPiece>& pieces() const { return pieces_; }
  /// The piece that holds on [time, time + something): at a breakpoint the later one.
  [[nodiscard]] std::size_t piece_at(double time) const;
  /// [V]; at a jump the value after it.
  [[nodiscard]] double voltage(double time) const;
  /// [V] the limit from the left. Equal to voltage(time), bit for bit, where the signal does not jump: what
  /// rounding leaves between the end of one piece and the beginning of the next, or between before() and a sine that starts
  /// there, is not a jump.
  [[nodiscard]] double voltage_before(double time) const;
  /// [s] beginnings of all pieces, 0 included.
  [[nodiscard]] std::vector<double> breakpoints() const;
  /// The value the signal ends on or tends to [V]; for a sine that never ends, the value it swings about.
  [[nodiscard]] double hold_level() const;
  /// At all times.
  [[nodiscard]] bool is_zero() const;

  struct Range {
    double minimum = 0, maximum = 0;  ///< [V]
  };
  /// Smallest and largest voltage on [0, end] [V], that before t = 0 included, sines to 1e-9 of their amplitude and terms to 1e-9
  /// of their size.
  /// These five throw InvalidInput unless end >= 0.
  [[nodiscard]] Range range(double end = std::numeric_limits<double>::infinity()) const;
  [[nodiscard]] double maximum(double end = std::numeric_limits<double>::infinity()) const { return range(end).maximum; }
  [[nodiscard]] double minimum(double end = std::numeric_limits<double>::infinity()) const { return range(end).minimum; }
  /// Largest |V| on [0, end] [V].
  [[nodiscard]] double peak(double end = std::numeric_limits<double>::infinity()) const;
  /// Largest |dV/dt| on [0, end] [V/s]; infinity if there is a jump (one at t = 0 counts).
  [[nodiscard]] double peak_slew(double end = std::numeric_limits<double>::infinity()) const;
  /// A step length that resolves the signal after `time`: a fraction of the shortest period, at most the shortest time constant
  /// of its piece; infinity where there is neither [s].
  [[nodiscard]] double resolving_step(double time) const;

 private:
  /// voltage_before at the beginning of piece `next`.
  [[nodiscard]] double left_limit(std::size_t next) const;

  std::vector<SignalPiece> pieces_;
  double before_ = 0;
};

/// What each signal ends on [V].
[[nodiscard]] std::vector<double> hold_levels(std::span<const Signal> signals);
/// What each stands at before t = 0 [V].
[[nodiscard]] std::vector<double> values_before(std::span<const Signal> signals);
/// When the last piece of any of them begins [s].
[[nodiscard]] double last_breakpoint(std::span<const Signal> signals);

/// The signal until `time`, and from then on what it stands at just before: at 0 s what it is before t = 0 [s].
[[nodiscard]] Signal held_from(const Signal& signal, double time);
/// What follows a breakpoint [s] of a signal that stands still before it, counted from there; `before` it stands at this [V].
[[nodiscard]] Signal part_from(const Signal& signal, double time, double before = 0);

/// The signal times a factor, a finite number.
[[nodiscard]] Signal scaled(const Signal& signal, double factor);

}  // namespace softland
