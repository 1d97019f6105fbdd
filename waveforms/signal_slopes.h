// Derivatives of the signals of all drives by the parameters that they are made from: central differences of the closed forms
// of their pieces. A parameter moves the beginnings of pieces, and the voltage within them.
//
// Parameters that move no piece in common share one difference: the levels of a spline take four, however many they are
// (Curtis, Powell and Reid 1974). The groups are found at one point and may be different at another. So every use of them is
// checked against a difference along a direction in which all parameters change at once, each by a share of its own.
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

/// A group of parameters that move no piece in common.
struct ParameterGroup {
  std::vector<std::size_t> parameters;
  std::vector<std::vector<std::optional<std::size_t>>> movers;  ///< parameter that moves the piece, by drive and piece
};

class SignalSlopes {
 public:
  /// The derivative of one piece by one parameter.
  struct Slope {
    std::size_t parameter = 0;
    double begin = 0;  ///< d(begin of the piece) / dp [s]
    /// Returns the slope of the voltage by the formula of the piece, at a time from 0 [V].
    [[nodiscard]] double voltage(double time) const {
      if (piece != nullptr) return piece->voltage(time);
      if (above != nullptr) return (above->voltage(time) - below->voltage(time)) * per_step;
      const double s = time - origin;
      return cubic[0] + s * (cubic[1] + s * (cubic[2] + s * cubic[3]));
    }

    double origin = 0;                                     // time about which a polynomial piece is written: s = time - origin
    std::array<double, 4> cubic = {};                      // coefficients of the derivative of a polynomial piece
    std::shared_ptr<const SignalPiece> piece = nullptr;    // derivative of a piece in which only sizes of sines or terms change
    const SignalPiece *above = nullptr, *below = nullptr;  // pieces of a difference where more changes
    double per_step = 0;
  };

  /// Step to either side of a parameter, as a share of its range.
  static constexpr double share_of_range = 1e-6;
  /// `signals` gives one signal per drive for x, and is also called for neighbours of x from `lower` to `upper`. Parameters
  /// without room between these have no slopes. `groups` were found at another x: where they hold here they give the same
  /// numbers for fewer signals.
  using SignalsOf = std::function<std::vector<Signal>(std::span<const double>)>;
  SignalSlopes(const SignalsOf& signals, std::span<const double> x, std::span<const double> lower, std::span<const double> upper,
               const std::vector<ParameterGroup>& groups = {});
  SignalSlopes(SignalSlopes&&) = default;
  SignalSlopes& operator=(SignalSlopes&&) = default;

  [[nodiscard]] std::size_t parameters() const { return parameters_; }
  /// Returns the slopes by the parameters that move a piece of a drive.
  [[nodiscard]] const std::vector<Slope>& at(std::size_t drive, std::size_t piece) const { return slopes_[drive][piece]; }
  /// Returns the parameters without derivative: on either side of their value the signals have different pieces.
  [[nodiscard]] const std::vector<std::size_t>& kinks() const { return kinks_; }
  /// Returns all parameters in few groups; none where groups would save nothing.
  [[nodiscard]] std::vector<ParameterGroup> groups() const;
  /// True when the groups that were given hold here.
  [[nodiscard]] bool are_grouped() const { return are_grouped_; }

 private:
  using Signals = std::vector<Signal>;
  struct Neighbourhood;

  [[nodiscard]] bool saves(std::size_t groups) const;
  void find_one_by_one(const Neighbourhood& near, const Signals& here);
  [[nodiscard]] bool find_in_groups(const Neighbourhood& near, const Signals& here, const std::vector<ParameterGroup>& groups);
  [[nodiscard]] bool holds_along_all(const Neighbourhood& near, const Signals& here) const;
  /// `mover` gives the parameter that moves a piece, and its step from below to above. Returns false where it gives none for a
  /// piece that has changed.
  template <class Mover>
  bool add(Mover&& mover, Signals above, Signals below);

  std::size_t parameters_;
  std::vector<std::vector<std::vector<Slope>>> slopes_;  // slopes by drive and piece
  std::vector<std::size_t> kinks_;
  std::vector<Signals> kept_;  // signals with the pieces that slopes point to
  bool are_grouped_ = false;
};

}  // namespace softland
