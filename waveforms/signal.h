// A drive voltage against time, compiled from a waveform family into pieces that are smooth inside.
//
//   V(t) = value + slope (t - begin) + [amplitude + amplitude_slope (t - begin)] sin(angular_frequency t + phase)
//
// on [begin, begin of the next piece); the last piece lasts for ever. V(t) = 0 for t < 0: a run starts at rest under 0 V.
// Time integration stops at every breakpoint, so that no step crosses a corner or a jump.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace softland {

struct SignalPiece {
  double begin = 0;              ///< [s]
  double value = 0;              ///< [V] at begin
  double slope = 0;              ///< [V/s]
  double amplitude = 0;          ///< [V] at begin
  double amplitude_slope = 0;    ///< [V/s]
  double angular_frequency = 0;  ///< [rad/s]
  double phase = 0;              ///< [rad]; the sine's argument is angular_frequency t + phase with t from 0, not from begin

  [[nodiscard]] double voltage(double time) const;  ///< [V]
  [[nodiscard]] double rate(double time) const;     ///< dV/dt [V/s]
};

class Signal {
 public:
  /// 0 V for ever.
  Signal() : pieces_{SignalPiece{}} {}
  /// Throws InvalidInput unless the pieces start at 0, begins strictly increase and every number is finite.
  explicit Signal(std::vector<SignalPiece> pieces);
  /// A constant voltage [V] from t = 0 on.
  static Signal constant(double voltage);

  [[nodiscard]] const std::vector<SignalPiece>& pieces() const { return pieces_; }
  /// The piece that holds on [time, time + something): at a breakpoint the later one.
  [[nodiscard]] std::size_t piece_at(double time) const;
  /// [V]; at a jump the value after it; 0 for time < 0.
  [[nodiscard]] double voltage(double time) const;
  /// [V] at the end of the piece that ends at `time` (the limit from the left); 0 at time <= 0.
  [[nodiscard]] double voltage_before(double time) const;
  /// [s] beginnings of all pieces, 0 included.
  [[nodiscard]] std::vector<double> breakpoints() const;
  /// The value the signal ends on [V]; for a sine that never ends, the value it swings about.
  [[nodiscard]] double hold_level() const;
  [[nodiscard]] bool is_zero() const;

  /// Largest and smallest voltage on [0, end] [V], the starting 0 V included, sines to 1e-9 of their amplitude.
  [[nodiscard]] double maximum(double end = std::numeric_limits<double>::infinity()) const;
  [[nodiscard]] double minimum(double end = std::numeric_limits<double>::infinity()) const;
  /// Largest |V| on [0, end] [V].
  [[nodiscard]] double peak(double end = std::numeric_limits<double>::infinity()) const;
  /// Largest |dV/dt| on [0, end] [V/s]; infinity if there is a jump (one at t = 0 counts).
  [[nodiscard]] double peak_slew(double end = std::numeric_limits<double>::infinity()) const;
  /// A step length that resolves the signal after `time`: a fraction of the sine's period, infinity where there is none [s].
  [[nodiscard]] double resolving_step(double time) const;

 private:
  std::vector<SignalPiece> pieces_;
};

}  // namespace softland
