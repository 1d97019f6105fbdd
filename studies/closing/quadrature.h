// The number of quadrature points of a switch.
//
// Loads grow as 1/h^2 and faster, so that they are steepest where the beam comes next to an electrode: a dip of gap h and
// curvature h'' is sqrt(2 h / h'') wide. The dip is narrowest at touch on the way to the contact, and the points are checked
// there by doubling.
#pragma once

#include <optional>

#include "model/switch.h"

namespace softland {

/// Quadrature for a smooth load at a relative accuracy.
[[nodiscard]] SwitchOptions quadrature_for(double accuracy, int modes);
/// Returns twice the points.
[[nodiscard]] SwitchOptions finer_than(const SwitchOptions& quadrature);

/// Relative difference of the loads in a state q between two quadratures of one switch, in the norm of the static energy: the
/// largest of every drive and of the gas.
[[nodiscard]] double load_difference(const Switch& one, const Switch& other, const Eigen::VectorXd& q);

/// A switch whose quadrature delivers a relative accuracy at touch.
struct ResolvedSwitch {
  Switch model;
  SwitchOptions quadrature;
  double error = 0;  ///< relative, of the loads at touch
};
/// Finds few points that deliver the accuracy, from quadrature_for(accuracy, modes) on. `error` is above `accuracy` if more
/// points do not help, since the loads are not smooth. `modes` takes the place of the structure's.
[[nodiscard]] ResolvedSwitch resolved_switch(const Device& device, double accuracy, std::optional<int> modes = {});
/// Returns a varied device of a nominal one whose `quadrature` delivers `accuracy`: with that quadrature, or with a finer one
/// if it touches nearer to the electrode.
[[nodiscard]] Switch switch_like(const Device& device, const Switch& nominal, const SwitchOptions& quadrature, double accuracy);

}  // namespace softland
