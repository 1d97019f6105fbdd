// Derivatives of the signals of all drives by the parameters of their waveforms, as central differences of the pieces of the
// signals. A parameter changes the beginnings of pieces, and the voltage within them.
//
// Parameters that change no common piece form a group and share one difference: the levels of a spline need four groups, however
// many there are (Curtis, Powell and Reid 1974). Groups are found at one point and may be wrong at another. Every use of groups
// is therefore checked against a difference in a direction in which all parameters change, each by a different share.
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
  /// Index of the parameter that changes a signal piece; by drive and piece.
  std::vector<std::vector<std::optional<std::size_t>>> movers;
};

class SignalSlopes {
 public:
  /// The derivative of one signal piece by one waveform parameter p.
  struct Slope {
    std::size_t parameter = 0;
    double begin = 0;  ///< derivative of the piece's beginning by the parameter [s per unit of the parameter]
    /// Returns the derivative of the voltage [V per unit of the parameter] by the formula of the piece, at a time counted from
    /// 0.
    [[nodiscard]] double voltage(double time) const {
      if (piece != nullptr) return piece->voltage(time);
      if (above != nullptr) return (above->voltage(time) - below->voltage(time)) * per_step;
      const double s = time - origin;
      return cubic[0] + s * (cubic[1] + s * (cubic[2] + s * cubic[3]));
    }

    double origin = 0;                 // time about which a polynomial signal piece is written: s = time - origin [s]
    std::array<double, 4> cubic = {};  // coefficients of the derivative of a polynomial signal piece
    // Derivative of a signal piece in which only sizes of sines or terms change.
    std::shared_ptr<const SignalPiece> piece = nullptr;
    // Signal pieces for a larger and a smaller parameter, if the times or angles of the piece change.
    const SignalPiece *above = nullptr, *below = nullptr;
    double per_step = 0;
  };

  /// Step of the finite difference to either side of a parameter, as a share of the parameter's range.
  static constexpr double share_of_range = 1e-6;
  /// Function that returns one signal per drive for the waveform parameters x; it is also called for points near x between
  /// `lower` and `upper`. A parameter whose bounds are equal has no slopes. `groups` were found at another x; if they are valid
  /// at this x, they give the same derivatives with fewer signals.
  using SignalsOf = std::function<std::vector<Signal>(std::span<const double>)>;
  SignalSlopes(const SignalsOf& signals, std::span<const double> x, std::span<const double> lower, std::span<const double> upper,
               const std::vector<ParameterGroup>& groups = {});
  SignalSlopes(SignalSlopes&&) = default;
  SignalSlopes& operator=(SignalSlopes&&) = default;

  [[nodiscard]] std::size_t parameters() const { return parameters_; }
  /// Returns the derivatives of a signal piece of a drive by the waveform parameters that change the piece.
  [[nodiscard]] const std::vector<Slope>& at(std::size_t drive, std::size_t piece) const { return slopes_[drive][piece]; }
  /// Returns the waveform parameters without a derivative: the signals have different pieces on either side of the parameter's
  /// value.
  [[nodiscard]] const std::vector<std::size_t>& kinks() const { return kinks_; }
  /// Returns groups of all waveform parameters; none if groups would not reduce the number of computed signals.
  [[nodiscard]] std::vector<ParameterGroup> groups() const;
  /// Returns true if the groups of parameters passed to the constructor are valid at this x.
  [[nodiscard]] bool are_grouped() const { return are_grouped_; }

 private:
  using Signals = std::vector<Signal>;
  struct Neighbourhood;

  [[nodiscard]] bool saves(std::size_t groups) const;
  void find_one_by_one(const Neighbourhood& near, const Signals& here);
  [[nodiscard]] bool find_in_groups(const Neighbourhood& near, const Signals& here, const std::vector<ParameterGroup>& groups);
  [[nodiscard]] bool holds_along_all(const Neighbourhood& near, const Signals& here) const;
  /// Adds the derivatives of all signal pieces from the difference of two sets of signals. `mover` returns the parameter that
  /// changes a piece, and the step of the parameter from below to above. Returns false if a piece has changed for which `mover`
  /// returns none.
  template <class Mover>
  bool add(Mover&& mover, Signals above, Signals below);

  std::size_t parameters_;
  std::vector<std::vector<std::vector<Slope>>> slopes_;  // derivatives of the signal pieces, by drive and piece
  std::vector<std::size_t> kinks_;
  std::vector<Signals> kept_;  // signals that own the pieces to which the derivatives point
  bool are_grouped_ = false;
};

}  // namespace softland
