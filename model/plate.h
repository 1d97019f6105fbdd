// A rigid plate on springs: one degree of freedom, the soft-landing literature's switch.
//
//   m x'' = -k x - 2 zeta sqrt(k m) x' + forces      phi = 1 / sqrt(m),   omega = sqrt(k / m)
//
// m moving mass [kg], k stiffness of all springs together [N/m], x deflection [m], zeta damping ratio; phi is the mass-normalised
// mode [kg^(-1/2)], the same everywhere: the plate stays flat and parallel. It answers what a beam's modes answer, so that laws
// per length act on it as on a beam: a strip as wide as the plate whose length is area / width. Valid while springs are linear
// and tilting and bending modes lie far above omega. Source: any textbook on electrostatic actuators, e.g. Senturia, Microsystem
// Design, 2001, ch. 6.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "model/device.h"

namespace softland {

class RigidPlate {
 public:
  explicit RigidPlate(const Structure& s)
      : frequencies_(Eigen::VectorXd::Constant(1, std::sqrt(s.stiffness / s.mass))),
        shape_(Eigen::VectorXd::Constant(1, 1 / std::sqrt(s.mass))) {}

  [[nodiscard]] const Eigen::VectorXd& angular_frequencies() const { return frequencies_; }  ///< [rad/s]
  [[nodiscard]] const Eigen::VectorXd& value(double) const { return shape_; }                ///< phi [kg^(-1/2)]
  [[nodiscard]] Eigen::VectorXd slope(double) const { return Eigen::VectorXd::Zero(1); }
  /// Held at its contact a rigid plate cannot move at all. Its own frequency stands in: a rebound takes no longer than that
  /// [rad/s].
  [[nodiscard]] double pinned_frequency(double) const { return frequencies_[0]; }

 private:
  Eigen::VectorXd frequencies_, shape_;
};

}  // namespace softland
