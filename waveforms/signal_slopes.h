// Derivatives of the signals of all drives by the parameters of their waveforms, as central differences of the signals' pieces.
// A parameter changes the beginnings of pieces, and the voltage within them.
//
// Parameters that change no common piece form a group and share one finite difference: the levels of a spline need four groups,
// however many levels there are (Curtis, Powell and Reid 1974). Groups found for some parameter values may be wrong for others.
// Every use of groups is therefore checked by a difference in which all parameters change, each by a different share of its
// step.
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

/// A group of waveform parameters of which no two change the same piece of a signal.
struct ParameterGroup {
  std::vector<std::size_t> parameters;
  /// Index of the parameter of this group that changes a signal piece, for each drive and piece; empty if none does.
  std::vector<std::vector<std::optional<std::size_t>>> movers;
};

class SignalSlopes {
 public:
  /// The derivative of one signal piece by one waveform parameter p.
  struct Slope {
    std::size_t parameter = 0;
    double begin = 0;  ///< derivative of the piece's beginning by the parameter [s per unit of the parameter]
    /// Returns the derivative of the voltage within the piece by the parameter [V per unit of the parameter] at a time of the
    /// signal [s].
    [[nodiscard]] double voltage(double time) const {
      if (piece != nullptr) return piece->voltage(time);
      if (above != nullptr) return (above->voltage(time) - below->voltage(time)) * per_step;
      const double s = time - origin;
      return cubic[0] + s * (cubic[1] + s * (cubic[2] + s * cubic[3]));
    }

    double origin = 0;                 // time from which s counts in the polynomial below [s]
    std::array<double, 4> cubic = {};  // derivative of a polynomial piece: coefficients of s^0 to s^3
    // Derivative as a signal piece, if the parameter changes only amplitudes of sines or terms.
    std::shared_ptr<const SignalPiece> piece = nullptr;
    // Signal pieces for a larger and a smaller value of the parameter, if it also changes times or angles.
    const SignalPiece *above = nullptr, *below = nullptr;
    double per_step = 0;
  };

  /// Step of the finite difference to either side of a parameter's value, as a share of the distance between its bounds.
  static constexpr double share_of_range = 1e-6;
  /// Function that returns one signal per drive for waveform parameters. The constructor calls it for x and for parameters near
  /// x within the bounds `lower` and `upper`. A parameter whose bounds are equal has no derivative. `groups` may have been
  /// found for other parameter values; if they are valid for x, fewer signals are computed for the same derivatives.
  using SignalsOf = std::function<std::vector<Signal>(std::span<const double>)>;
  SignalSlopes(const SignalsOf& signals, std::span<const double> x, std::span<const double> lower, std::span<const double> upper,
               const std::vector<ParameterGroup>& groups = {});
  SignalSlopes(SignalSlopes&&) = default;
  SignalSlopes& operator=(SignalSlopes&&) = default;

  [[nodiscard]] std::size_t parameters() const { return parameters_; }
  /// Returns the derivatives of a piece of a drive's signal, one for each waveform parameter that changes the piece.
  [[nodiscard]] const std::vector<Slope>& at(std::size_t drive, std::size_t piece) const { return slopes_[drive][piece]; }
  /// Returns the waveform parameters without a derivative: the signals have other pieces for larger and for smaller values.
  [[nodiscard]] const std::vector<std::size_t>& kinks() const { return kinks_; }
  /// Returns groups of all waveform parameters, for the constructor; empty if groups would not reduce the number of computed
  /// signals.
  [[nodiscard]] std::vector<ParameterGroup> groups() const;
  /// Returns true if the groups passed to the constructor were valid for x and have been used.
  [[nodiscard]] bool are_grouped() const { return are_grouped_; }

 private:
  using Signals = std::vector<Signal>;
  struct Neighbourhood;

  [[nodiscard]] bool saves(std::size_t groups) const;
  void find_one_by_one(const Neighbourhood& near, const Signals& here);
  [[nodiscard]] bool find_in_groups(const Neighbourhood& near, const Signals& here, const std::vector<ParameterGroup>& groups);
  [[nodiscard]] bool holds_along_all(const Neighbourhood& near, const Signals& here) const;
  /// Adds the derivatives of all signal pieces that differ between the signals `above` and `below`. `mover(drive, piece)`
  /// returns the parameter that changes a piece, and the change of the parameter from below to above. Returns false if `mover`
  /// returns none for a changed piece.
  template <class Mover>
  bool add(Mover&& mover, Signals above, Signals below);

  std::size_t parameters_;
  std::vector<std::vector<std::vector<Slope>>> slopes_;  // derivatives of the signal pieces, by drive and piece
  std::vector<std::size_t> kinks_;
  std::vector<Signals> kept_;  // signals that own the pieces to which Slope::above and Slope::below point
  bool are_grouped_ = false;
};

}  // namespace softland
