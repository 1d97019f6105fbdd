// A rigid plate on springs: one degree of freedom, the soft-landing literature's switch.
//
//   m x'' = -k x - 2 zeta sqrt(k m) x' + forces      phi = 1 / sqrt(m),   omega = sqrt(k / m)
//
// m moving mass [kg], k stiffness of all springs together [N/m], x deflection [m], zeta damping ratio; phi is the mass-normalised
// mode [kg^(-1/2)], the same everywhere: the plate stays flat and parallel. It answers what BeamModes answers, so that laws
// per length act on it as on a beam: a strip as wide as the plate whose length is area / width. Valid while springs are linear
// and tilting and bending modes lie far above omega. Source: any textbook on electrostatic actuators, e.g. Senturia, Microsystem
// Design, 2001, ch. 6.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "model/device.h"

namespace softland {

class RigidPlate {
 public:
  /// The one mode, normalised: 1 everywhere.
  struct FlatMode {
    [[nodiscard]] Eigen::VectorXd value(double) const { return Eigen::VectorXd::Ones(1); }
    [[nodiscard]] Eigen::VectorXd slope(double) const { return Eigen::VectorXd::Zero(1); }
    /// Held at its contact a rigid plate cannot move at all. Its own frequency stands in: a rebound takes no longer than that.
    [[nodiscard]] double pinned_inverse_square(double, std::optional<double> = {}) const { return 1; }
  };

  explicit RigidPlate(const Structure& s)
      : length_(s.length), scale_(1 / std::sqrt(s.mass)), frequency_scale_(std::sqrt(s.stiffness / s.mass)) {}

  [[nodiscard]] Eigen::VectorXd angular_frequencies() const {
    return Eigen::VectorXd::Constant(1, frequency_scale_);
  }                                                                          ///< [rad/s]
  [[nodiscard]] double length() const { return length_; }                    ///< [m]
  [[nodiscard]] double scale() const { return scale_; }                      ///< phi [kg^(-1/2)]
  [[nodiscard]] double frequency_scale() const { return frequency_scale_; }  ///< [rad/s]
  [[nodiscard]] const FlatMode* normalised() const { return &mode_; }

 private:
  double length_, scale_, frequency_scale_;
  FlatMode mode_;
};

}  // namespace softland
