// A rigid plate on springs: one degree of freedom, the usual switch of the literature on soft landing.
//
//   m x'' = -k x - 2 zeta sqrt(k m) x' + forces      phi = 1 / sqrt(m),   omega = sqrt(k / m)
//
// m is the moving mass [kg], k the stiffness of all springs together [N/m], x the deflection [m], zeta the damping ratio; phi
// is the mass-normalised mode [kg^(-1/2)], the same everywhere: the plate stays flat and parallel. The plate has the interface
// of BeamModes, so that force laws per length act on it as on a beam: a strip as wide as the plate whose length is area /
// width. Valid while springs are linear and tilting and bending modes lie far above omega. Source: any textbook on
// electrostatic actuators, e.g. Senturia, Microsystem Design, 2001, ch. 6.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "model/structure/kind.h"

namespace softland {

class RigidPlate {
 public:
  /// The single normalised mode shape of a rigid plate: 1 everywhere.
  struct FlatMode {
    [[nodiscard]] Eigen::VectorXd value(double) const { return Eigen::VectorXd::Ones(1); }
    [[nodiscard]] Eigen::VectorXd slope(double) const { return Eigen::VectorXd::Zero(1); }
    /// Returns 1: a plate held at its contact counts as vibrating with the frequency of the free plate. In fact it cannot move;
    /// the frequency only bounds the duration of a rebound, which takes no longer than the plate's period.
    [[nodiscard]] double pinned_inverse_square(double, std::optional<double> = {}) const { return 1; }
  };

  /// Creates a plate of this length [m], moving mass [kg] and stiffness of all springs together [N/m].
  RigidPlate(double length, double mass, double stiffness)
      : length_(length), scale_(1 / std::sqrt(mass)), frequency_scale_(std::sqrt(stiffness / mass)) {}

  /// Returns the angular frequency of the plate, its only mode [rad/s].
  [[nodiscard]] Eigen::VectorXd angular_frequencies() const { return Eigen::VectorXd::Constant(1, frequency_scale_); }
  [[nodiscard]] double length() const { return length_; }  ///< length along which loads act: area over width [m]
  [[nodiscard]] double scale() const { return scale_; }    ///< mass-normalised mode shape, the same everywhere [kg^(-1/2)]
  [[nodiscard]] double frequency_scale() const { return frequency_scale_; }  ///< angular frequency of the plate [rad/s]
  [[nodiscard]] const FlatMode* normalised() const { return &mode_; }

 private:
  double length_, scale_, frequency_scale_;
  FlatMode mode_;
};

/// The kind of structure "plate" in a scene: its length is its area over its width.
struct Plate {
  static constexpr std::string_view name = "plate", whose = "on a plate",
                                    why_no_layer = "a rigid plate does not bend; a layer needs a beam",
                                    why_no_skins = "a rigid plate does not bend; a surface needs a beam",
                                    length_is = "structure.area / structure.width";
  static constexpr bool is_rigid = true;
  static constexpr std::array usual_spread{UsualSpread{"stiffness", "6.7 %"}};

  double mass = 0;       ///< mass of the moving plate [kg]
  double stiffness = 0;  ///< stiffness of all springs of the plate together [N/m]

  template <class S>
  static consteval auto fields() {
    // clang-format off
    return std::to_array<Field<S>>({
        S::damping(),
        {.key = "mass", .unit = "kg", .about = "moving mass", .in = within<S, Plate, &Plate::mass>, .required = true},
        {.key = "stiffness", .unit = "N/m", .about = "of all springs together", .in = within<S, Plate, &Plate::stiffness>, .required = true},
        {.key = "area", .unit = "m^2", .about = "of the plate", .required = true},
        {.key = "width", .unit = "m", .about = "needed by all gas models but a damper given by quality_factor, all fringing but none, and contacts of asperities; the length is area / width", .in = reach<S, &S::width>, .such_as = "100 um"},
        {.key = "thickness", .unit = "m", .about = "needed by the fringing laws meijs-fokkema and bao-2001, and by the gas model guo-alexeenko", .in = reach<S, &S::thickness>},
    });
    // clang-format on
  }
  template <class S>
  [[nodiscard]] static S example() {
    return {.length = 100e-6, .width = 100e-6, .thickness = 3e-6, .modes = 1, .kind = Plate{.mass = 2.4e-9, .stiffness = 42}};
  }
  template <class Device, class Known>
  [[nodiscard]] RigidPlate modes(const Device& device, const Known&) const {
    return {device.structure.length, mass, stiffness};
  }
  [[nodiscard]] static int most_modes() { return 1; }
};

}  // namespace softland
