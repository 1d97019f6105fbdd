// The motion of a switch before its first touch, with its exact first and second derivatives, for optimal control.
#include "model/switch.h"

namespace softland {

void Switch::set_free_field(const double* q, const double* v, Workspace& work) const {
  quadrature_.set_gap(q, work.field);
  work.field.velocity.matrix().noalias() = quadrature_.shapes() * Eigen::Map<const Eigen::VectorXd>(v, modes());
  work.field.smallest_gap = work.field.gap.minCoeff();
}

Switch::FreeMotion Switch::free_motion(const double* q, const double* v, std::span<const double> strengths,
                                       Workspace& work) const {
  const Eigen::Index n = modes();
  const Eigen::Map<const Eigen::VectorXd> at(q, n), rate(v, n);
  FreeMotion motion;
  set_free_field(q, v, work);
  work.load.setZero();
  work.by_deflection.setZero();
  work.by_velocity.setZero();
  for (const auto& law : passive_laws_) {
    law->add_load(work.field, 0, work.load.data());
    law->add_derivatives(work.field, 0, work.by_deflection.data(), work.by_velocity.data());
  }
  motion.by_strength = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(drives()));
  Eigen::ArrayXd unit = Eigen::ArrayXd::Zero(work.load.size());
  for (std::size_t k = 0; k < driven_laws_.size(); ++k) {
    unit.setZero();
    driven_laws_[k]->add_load(work.field, 1, unit.data());
    motion.by_strength.col(static_cast<Eigen::Index>(k)) = quadrature_.weighted_shapes().transpose() * unit.matrix();
    work.load += strengths[k] * unit;
    driven_laws_[k]->add_derivatives(work.field, strengths[k], work.by_deflection.data(), work.by_velocity.data());
  }
  motion.accelerations = quadrature_.weighted_shapes().transpose() * work.load.matrix() - basis_.squares().cwiseProduct(at) -
                         2 * device_.structure.damping_ratio * basis_.angular_frequencies().cwiseProduct(rate);
  if (device_.piezo) {
    motion.by_strength.rightCols<1>() = basis_.piezo_shape();
    motion.accelerations += strengths.back() * basis_.piezo_shape();
  }
  motion.by_q = quadrature_.weighted_shapes().transpose() * work.by_deflection.matrix().asDiagonal() * quadrature_.shapes();
  motion.by_v = quadrature_.weighted_shapes().transpose() * work.by_velocity.matrix().asDiagonal() * quadrature_.shapes();
  motion.by_q.diagonal() -= basis_.squares();
  motion.by_v.diagonal() -= 2 * device_.structure.damping_ratio * basis_.angular_frequencies();
  if (stretching_) {
    stretching_->add_force(q, motion.accelerations.data());
    stretching_->add_derivative(q, motion.by_q);
  }
  return motion;
}

Eigen::MatrixXd Switch::free_motion_curvature(const double* q, const double* v, std::span<const double> strengths,
                                              const double* multipliers, Workspace& work) const {
  const Eigen::Index n = modes(), points = quadrature_.shapes().rows();
  const auto driven = static_cast<Eigen::Index>(driven_laws_.size());
  Eigen::MatrixXd curvature =
      Eigen::MatrixXd::Zero(2 * n + static_cast<Eigen::Index>(drives()), 2 * n + static_cast<Eigen::Index>(drives()));
  set_free_field(q, v, work);
  // The derivative, by the load at each quadrature point, of the sum over modes of multiplier_i q_i''. It weights the second
  // derivatives of the load.
  const Eigen::ArrayXd share = (quadrature_.weighted_shapes() * Eigen::Map<const Eigen::VectorXd>(multipliers, n)).array();
  Eigen::ArrayXd by_deflections = Eigen::ArrayXd::Zero(points), by_both = by_deflections, by_velocities = by_deflections;
  for (const auto& law : passive_laws_)
    law->add_curvatures(work.field, 0, by_deflections.data(), by_both.data(), by_velocities.data());
  Eigen::ArrayXd slope(points), unused(points);
  for (Eigen::Index k = 0; k < driven; ++k) {
    const auto& law = driven_laws_[static_cast<std::size_t>(k)];
    law->add_curvatures(work.field, strengths[static_cast<std::size_t>(k)], by_deflections.data(), by_both.data(),
                        by_velocities.data());
    slope.setZero();
    unused.setZero();
    law->add_derivatives(work.field, 1, slope.data(), unused.data());
    const Eigen::VectorXd mixed = quadrature_.shapes().transpose() * (share * slope).matrix();
    curvature.block(0, 2 * n + k, n, 1) = mixed;
    curvature.block(2 * n + k, 0, 1, n) = mixed.transpose();
  }
  const auto between = [&](const Eigen::ArrayXd& second) {
    return Eigen::MatrixXd(quadrature_.shapes().transpose() * (share * second).matrix().asDiagonal() * quadrature_.shapes());
  };
  curvature.topLeftCorner(n, n) = between(by_deflections);
  curvature.block(0, n, n, n) = between(by_both);
  curvature.block(n, 0, n, n) = curvature.block(0, n, n, n).transpose();
  curvature.block(n, n, n, n) = between(by_velocities);
  if (stretching_) stretching_->add_curvature(q, multipliers, curvature.topLeftCorner(n, n));
  return curvature;
}

}  // namespace softland
