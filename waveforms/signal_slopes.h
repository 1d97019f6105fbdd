// How the signals of all drives change with the parameters that they are made from: central differences of the closed forms of
// their pieces. A parameter moves the beginnings of pieces, and the voltage within them.
//
// Parameters that move no piece in common share one difference: the levels of a spline take four, however many they are (Curtis,
// Powell and Reid 1974). Which they are is found at one point and may be different at another. So every use of them is checked
// against a difference along a direction in which all parameters change at once, each by a share of its own.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "waveforms/signal.h"

namespace softland {

/// Parameters that move no piece in common.
struct ParameterGroup {
  std::vector<std::size_t> parameters;
  std::vector<std::vector<std::optional<std::size_t>>> movers;  ///< of drives, pieces: the parameter that moves the piece
};

class SignalSlopes {
 public:
  /// Of one parameter on one piece.
  struct Slope {
    std::size_t parameter = 0;
    double begin = 0;  ///< d(begin of the piece) / dp [s]
    /// [V] by the formula of the piece, at a time from 0
    [[nodiscard]] double voltage(double time) const {
      if (piece != nullptr) return piece->voltage(time);
      if (above != nullptr) return (above->voltage(time) - below->voltage(time)) * per_step;
      const double s = time - origin;
      return cubic[0] + s * (cubic[1] + s * (cubic[2] + s * cubic[3]));
    }

    double origin = 0;                                     // where the piece is a polynomial of s = time - origin
    std::array<double, 4> cubic = {};                      // of the derivative
    std::shared_ptr<const SignalPiece> piece = nullptr;    // where only sizes of a sine or of terms change: the derivative
    const SignalPiece *above = nullptr, *below = nullptr;  // where more does
    double per_step = 0;
  };

  /// Of a parameter's range: the step to either side of it.
  static constexpr double share_of_range = 1e-6;
  /// `signals` gives one signal per drive for x, whose neighbours from `lower` to `upper` are tried too. Parameters without room
  /// between these have no slopes. `groups` were found at another x: the same numbers, for fewer signals where they hold here.
  using SignalsOf = std::function<std::vector<Signal>(std::span<const double>)>;
  SignalSlopes(const SignalsOf& signals, std::span<const double> x, std::span<const double> lower, std::span<const double> upper,
               const std::vector<ParameterGroup>& groups = {});
  SignalSlopes(SignalSlopes&&) = default;
  SignalSlopes& operator=(SignalSlopes&&) = default;

  [[nodiscard]] std::size_t parameters() const { return parameters_; }
  /// Of the parameters that move a piece of a drive.
  [[nodiscard]] const std::vector<Slope>& at(std::size_t drive, std::size_t piece) const { return slopes_[drive][piece]; }
  /// Parameters without derivative: on either side of their value the signals have other pieces.
  [[nodiscard]] const std::vector<std::size_t>& kinks() const { return kinks_; }
  /// All parameters, in few groups; none where they would save nothing.
  [[nodiscard]] std::vector<ParameterGroup> groups() const;
  /// Whether the groups that were given held.
  [[nodiscard]] bool are_grouped() const { return are_grouped_; }

 private:
  using Signals = std::vector<Signal>;
  struct Neighbourhood;

  [[nodiscard]] bool saves(std::size_t groups) const;
  void find_one_by_one(const Neighbourhood& near, const Signals& here);
  [[nodiscard]] bool find_in_groups(const Neighbourhood& near, const Signals& here, const std::vector<ParameterGroup>& groups);
  [[nodiscard]] bool holds_along_all(const Neighbourhood& near, const Signals& here) const;
  /// `mover` gives the parameter that moves a piece, and its step from below to above. False where it gives none for a piece
  /// that has changed.
  template <class Mover>
  bool add(Mover&& mover, Signals above, Signals below);

  std::size_t parameters_;
  std::vector<std::vector<std::vector<Slope>>> slopes_;  // of drives, pieces
  std::vector<std::size_t> kinks_;
  std::vector<Signals> kept_;  // with pieces that slopes point to
  bool are_grouped_ = false;
};

}  // namespace softland
