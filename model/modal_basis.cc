#include "model/modal_basis.h"

#include <cmath>
#include <utility>

#include "model/constants.h"
#include "model/sampled_modes.h"

namespace softland {

ModalBasis::ModalBasis(Eigen::VectorXd angular_frequencies, const Scales& scales, const SampledModes& sampled,
                       const Device& device, const std::optional<Eigen::VectorXd>& piezo)
    : frequencies_(std::move(angular_frequencies)),
      squares_(frequencies_.cwiseAbs2()),
      contact_shape_(scales.shape * sampled.contact_shape),
      pad_slope_(Eigen::VectorXd::Zero(modes())),
      piezo_shape_(Eigen::VectorXd::Zero(modes())),
      in_contact_period_(2 * pi / (scales.frequency / std::sqrt(sampled.pinned_inverse_square))) {
  for (const Eigen::VectorXd& shape : sampled.further_contact_shapes) further_contact_shapes_.emplace_back(scales.shape * shape);
  const Structure& s = device.structure;
  const double slope_scale = scales.shape / scales.length;
  if (device.touches_along_pad()) pad_slope_ = slope_scale * sampled.contact_slope;
  if (piezo) {
    piezo_shape_ = *piezo;
  } else if (device.piezo) {
    piezo_shape_ = piezo_moment_per_volt(s, *device.piezo) *
                   (slope_scale * sampled.piezo_end_slope - slope_scale * sampled.piezo_begin_slope);
  }
  const auto in_lanes = [](const Eigen::VectorXd& v) { return padded_to_lanes({v.begin(), v.end()}, 0); };
  stiffness_lanes_ = in_lanes(squares_);
  friction_lanes_ = in_lanes(2 * s.damping_ratio * frequencies_);
  contact_lanes_ = in_lanes(contact_shape_);
  piezo_lanes_ = in_lanes(piezo_shape_);
}

}  // namespace softland
