// The quadrature points along the structure where the distributed force laws of a switch act, with their weights, the gap and
// its velocity at these points, and loads at these points projected on the modes. It is a Galerkin projection, on Gauss panels
// that begin and end where a part of the switch, such as an electrode, begins or ends.
//
// The matrices are small: processing a block of points, or a SIMD vector of modes, at a time, with its data in registers, is
// faster than a general product. Code on the hot path of every closing is inlined: a call would interrupt vector instructions
// around it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "base/lanes.h"
#include "model/distributed_law.h"

namespace softland {

class PointQuadrature {
 public:
  PointQuadrature() = default;
  /// Takes positions and weights of the points [m], mode shapes at the positions (points x modes) [kg^(-1/2)], and the gaps
  /// there at rest [m].
  PointQuadrature(Eigen::ArrayXd positions, Eigen::ArrayXd weights, const Eigen::MatrixXd& shapes,
                  const Eigen::ArrayXd& rest_gaps);

  [[nodiscard]] Eigen::Index points() const { return weights_.size(); }
  [[nodiscard]] const Eigen::ArrayXd& positions() const { return positions_; }  ///< positions of the quadrature points [m]
  [[nodiscard]] const Eigen::ArrayXd& weights() const { return weights_; }      ///< weights of the quadrature points [m]
  /// Returns the gaps at rest at the quadrature points [m]; the idle points after them, which fill the last block, have the
  /// largest gap.
  [[nodiscard]] const Eigen::ArrayXd& rest_gaps() const { return rest_gaps_; }
  /// Returns the mode shapes at the quadrature points, one row per point, then rows of zero motion that fill the last block
  /// [kg^(-1/2)].
  [[nodiscard]] const Eigen::MatrixXd& shapes() const { return shapes_; }
  /// Returns the mode shapes times the weights of the quadrature points.
  [[nodiscard]] const Eigen::MatrixXd& weighted_shapes() const { return weighted_shapes_; }

  void set_gap(const double* q, GapField& field) const {
    // Here noalias() avoids a temporary matrix, so that the function, called in every step, does not allocate memory.
    field.gap.matrix().noalias() = shapes_ * Eigen::Map<const Eigen::VectorXd>(q, shapes_.cols());
    field.gap = rest_gaps_ - field.gap;
  }
  /// Computes gap, velocity and smallest gap of the beam at the quadrature points from modal coordinates and velocities.
  [[gnu::always_inline]] void set_field(const double* q, const double* v, GapField& field) const {
    Eigen::Index first = 0, left = shapes_.cols();
    double& smallest = field.smallest_gap;
    for (; left >= 4; first += 4, left -= 4) smallest = add_modes<4>(first, q, v, field);
    if (left == 3) smallest = add_modes<3>(first, q, v, field);
    if (left == 2) smallest = add_modes<2>(first, q, v, field);
    if (left == 1) smallest = add_modes<1>(first, q, v, field);
  }
  /// Returns the modal forces of a load f along the beam for a SIMD vector of modes that begins with mode `first`: the sums
  /// over quadrature points p of w_p phi_i(x_p) f(x_p), w weights, phi mode shapes.
  [[gnu::always_inline]] [[nodiscard]] Lane projected(const Eigen::ArrayXd& loads, std::size_t first) const {
    const auto points = static_cast<std::size_t>(shapes_.rows());
    const double* shapes = weighted_lanes_.data() + first * points;
    const double* load = loads.data();
    constexpr std::size_t chains = 4;  // number of independent partial sums, which the processor adds in parallel
    Lane sum[chains] = {Lane::Zero(), Lane::Zero(), Lane::Zero(), Lane::Zero()};
    for (std::size_t p = 0; p < points; p += chains) {
      for (std::size_t k = 0; k < chains; ++k) sum[k] += load[p + k] * Eigen::Map<const Lane>(shapes + (p + k) * lanes);
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
  /// Computes the derivatives of the modal forces by the modal coordinates from `slopes`, the derivatives of the load by the
  /// deflection at each point. `load` is scratch memory.
  void project_slopes(const Eigen::ArrayXd& slopes, Eigen::ArrayXd& load, Eigen::Ref<Eigen::MatrixXd> by) const;

  static constexpr Eigen::Index block = lanes;  ///< number of quadrature points that are handled at once
  using Block = Lane;

 private:
  /// Adds the contribution of `Modes` modes, from mode `first` on, to the gaps and velocities of the beam at all points.
  /// Returns the smallest gap after this addition.
  template <int Modes>
  [[gnu::always_inline]] double add_modes(Eigen::Index first, const double* q, const double* v, GapField& field) const {
    const Eigen::Index points = shapes_.rows();
    const double* shapes = shapes_.data() + first * points;
    Lane at[Modes], rate[Modes];
    for (int i = 0; i < Modes; ++i) at[i].setConstant(q[first + i]), rate[i].setConstant(v[first + i]);
    const double* rest = rest_gaps_.data();
    Block smallest = Block::Constant(largest_rest_gap_);
    for (Eigen::Index p = 0; p < points; p += block) {
      Eigen::Map<Block> all_gap(field.gap.data() + p), all_velocity(field.velocity.data() + p);
      Block gap = Eigen::Map<const Block>(rest + p), velocity = Block::Zero();
      if (first > 0) gap = all_gap, velocity = all_velocity;
      for (int i = 0; i < Modes; ++i) {
        const Eigen::Map<const Block> shape(shapes + i * points + p);
        gap -= shape * at[i];
        velocity += shape * rate[i];
      }
      all_gap = gap;
      all_velocity = velocity;
      smallest = smallest.min(gap);
    }
    return smallest.minCoeff();
  }

  Eigen::ArrayXd positions_, weights_;
  Eigen::MatrixXd shapes_, weighted_shapes_;
  std::vector<double> weighted_lanes_;  // weighted mode shapes for each SIMD vector of modes, point by point
  Eigen::ArrayXd rest_gaps_;
  double largest_rest_gap_ = 0;
};

}  // namespace softland
