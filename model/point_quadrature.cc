#include "model/point_quadrature.h"

#include <utility>

namespace softland {

PointQuadrature::PointQuadrature(Eigen::ArrayXd positions, Eigen::ArrayXd weights, const Eigen::MatrixXd& shapes,
                                 const Eigen::ArrayXd& rest_gaps)
    : positions_(std::move(positions)), weights_(std::move(weights)), largest_rest_gap_(rest_gaps.maxCoeff()) {
  const Eigen::Index n = points();
  shapes_ = weighted_shapes_ = Eigen::MatrixXd::Zero((n + block - 1) / block * block, shapes.cols());
  rest_gaps_ = Eigen::ArrayXd::Constant(shapes_.rows(), largest_rest_gap_);
  rest_gaps_.head(n) = rest_gaps;
  shapes_.topRows(n) = shapes;
  weighted_shapes_.topRows(n) = weights_.matrix().asDiagonal() * shapes_.topRows(n);
  const auto rows = static_cast<std::size_t>(shapes_.rows()), modes = static_cast<std::size_t>(shapes_.cols());
  weighted_lanes_.assign((modes + lanes - 1) / lanes * lanes * rows, 0);
  for (std::size_t i = 0; i < modes; ++i) {
    double* group = weighted_lanes_.data() + i / lanes * lanes * rows + i % lanes;
    for (std::size_t p = 0; p < rows; ++p) {
      group[p * lanes] = weighted_shapes_(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(i));
    }
  }
}

void PointQuadrature::project_slopes(const Eigen::ArrayXd& slopes, Eigen::ArrayXd& load, Eigen::Ref<Eigen::MatrixXd> by) const {
  const auto n = static_cast<std::size_t>(shapes_.cols());
  for (Eigen::Index k = 0; k < shapes_.cols(); ++k) {
    load = slopes * shapes_.col(k).array();
    for (std::size_t i = 0; i < n; i += lanes) store_lane(projected(load, i), by.col(k).data(), i, n);
  }
}

}  // namespace softland
