// How the signals of all drives change with the parameters that they are made from: central differences of the closed forms of
// their pieces. A parameter moves the beginnings of pieces, and the voltage within them.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "waveforms/signal.h"

namespace softland {

class SignalSlopes {
 public:
  /// Of one parameter on one piece.
  struct Slope {
    std::size_t parameter = 0;
    double begin = 0;  ///< d(begin of the piece) / dp [s]
    /// [V] by the formula of the piece, at a time from 0
    [[nodiscard]] double voltage(double time) const {
      return straight ? at_zero + rate * time : (above.voltage(time) - below.voltage(time)) * per_step;
    }

    bool straight = true;
    double at_zero = 0, rate = 0;  // where it is straight
    SignalPiece above, below;      // where it is not
    double per_step = 0;
  };

  /// `signals` gives one signal per drive for x, whose neighbours from `lower` to `upper` are tried too. Parameters without room
  /// between these have no slopes.
  using SignalsOf = std::function<std::vector<Signal>(std::span<const double>)>;
  SignalSlopes(const SignalsOf& signals, std::span<const double> x, std::span<const double> lower, std::span<const double> upper);

  [[nodiscard]] std::size_t parameters() const { return parameters_; }
  /// Of the parameters that move a piece of a drive.
  [[nodiscard]] const std::vector<Slope>& at(std::size_t drive, std::size_t piece) const { return slopes_[drive][piece]; }
  /// Parameters without derivative: on either side of their value the signals have other pieces.
  [[nodiscard]] const std::vector<std::size_t>& kinks() const { return kinks_; }

 private:
  void add(std::size_t parameter, const std::vector<Signal>& above, const std::vector<Signal>& below, double step);

  std::size_t parameters_;
  std::vector<std::vector<std::vector<Slope>>> slopes_;  // of drives, pieces
  std::vector<std::size_t> kinks_;
};

}  // namespace softland
