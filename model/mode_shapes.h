// The mode shapes of a switch along its length, for plots.
#pragma once

#include <Eigen/Core>

#include "model/switch.h"

namespace softland {

struct ModeShapes {
  Eigen::VectorXd places;  ///< positions along the beam from its clamped end [m]
  Eigen::MatrixXd shapes;  ///< mode shapes at the positions, a row for each position [kg^(-1/2)]
};

/// Returns the mode shapes at `places` positions from end to end, for a beam or a structure from a table of modes. For a plate
/// returns the mode shapes at the quadrature points of the switch. Throws InvalidInput when `places` is below two.
[[nodiscard]] ModeShapes mode_shapes(const Switch& model, int places);
/// Returns the mode shapes phi_i of any structure at these positions from 0 to its length [m], a row for each position
/// [kg^(-1/2)].
[[nodiscard]] Eigen::MatrixXd mode_shapes_at(const Switch& model, const Eigen::VectorXd& places);

}  // namespace softland
