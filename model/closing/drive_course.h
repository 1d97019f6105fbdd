// The drive voltages of a closing, interval by interval. A breakpoint is a time at which any drive voltage jumps or is not
// smooth. In the interval (stretch) between two breakpoints, every voltage is one smooth piece of its signal, and the
// integrator needs no restart.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "waveforms/signal.h"

namespace softland {

class DriveCourse {
 public:
  explicit DriveCourse(std::span<const Signal> signals)
      : signals_(signals), pieces_(signals.size(), 0), values_(signals.size(), 0.0) {}

  [[nodiscard]] std::size_t size() const { return signals_.size(); }
  /// Returns the voltages of all drives before t = 0.
  [[nodiscard]] std::vector<double> before() const { return values_before(signals_); }
  /// Returns the times in [0, duration] that bound the intervals between breakpoints of the drives, in order. The time `also`
  /// [s], such as that of the command to open, bounds an interval as well if it is within [0, duration].
  [[nodiscard]] std::vector<double> stretches(double duration, double also = std::numeric_limits<double>::infinity()) const {
    std::vector<double> stops{0, duration};
    if (also > 0 && also < duration) stops.push_back(also);
    for (const Signal& signal : signals_) {
      for (const double t : signal.breakpoints()) {
        if (t > 0 && t < duration) stops.push_back(t);
      }
    }
    std::sort(stops.begin(), stops.end());
    stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
    return stops;
  }

  /// Selects the signal piece of drive k that is valid just after time t.
  void enter(std::size_t k, double t) { pieces_[k] = signals_[k].piece_at(t); }
  [[nodiscard]] const SignalPiece& piece(std::size_t k) const { return signals_[k].pieces()[pieces_[k]]; }
  /// Returns the voltage of drive k by the formula of its current signal piece, which is extrapolated before and after the
  /// piece.
  [[nodiscard]] double value(std::size_t k, double t) const { return piece(k).voltage(t); }
  /// Returns the voltages of all drives at time t [V]; valid until the next call.
  std::span<const double> values(double t) {
    for (std::size_t k = 0; k < size(); ++k) values_[k] = value(k, t);
    return values_;
  }
  /// Returns true when every drive is on the last piece of its signal, that of the hold level.
  [[nodiscard]] bool at_hold() const {
    for (std::size_t k = 0; k < size(); ++k) {
      if (pieces_[k] + 1 < signals_[k].pieces().size()) return false;
    }
    return true;
  }
  /// Returns a step length that resolves the oscillation of every drive voltage after t [s]; infinity when no voltage
  /// oscillates.
  [[nodiscard]] double resolving_step(double t) const {
    double step = std::numeric_limits<double>::infinity();
    for (const Signal& signal : signals_) step = std::min(step, signal.resolving_step(t));
    return step;
  }

 private:
  std::span<const Signal> signals_;
  std::vector<std::size_t> pieces_;
  std::vector<double> values_;
};

}  // namespace softland
