// The number of quadrature points along the beam of a switch.
//
// Loads grow as 1/h^2 and faster with decreasing gap h, so they are steepest where the beam is closest to an electrode. If the
// gap has the curvature h'' at this position, the region of large load is sqrt(2 h / h'') wide. This region is narrowest at
// contact, where the number of points is checked by doubling it.
#pragma once

#include <optional>

#include "model/switch.h"

namespace softland {

/// Returns the quadrature with which smooth loads have the relative `accuracy`.
[[nodiscard]] SwitchOptions quadrature_for(double accuracy, int modes);
/// Returns a quadrature along the beam with twice as many points as `quadrature`.
[[nodiscard]] SwitchOptions finer_than(const SwitchOptions& quadrature);

/// Returns the relative difference of the modal loads in a state q between two quadratures of one switch, in the norm of the
/// static energy. The result is the largest difference of all drives and of the gas.
[[nodiscard]] double load_difference(const Switch& one, const Switch& other, const Eigen::VectorXd& q);

/// A switch whose quadrature delivers a relative accuracy of the loads at contact.
struct ResolvedSwitch {
  Switch model;
  SwitchOptions quadrature;
  double error = 0;  ///< relative error of the electrostatic and gas loads at contact
};
/// Returns a switch with a small number of points that delivers the accuracy, beginning with quadrature_for(accuracy, modes).
/// If more points do not help, because the loads are not smooth, ResolvedSwitch::error is above `accuracy`. `modes` replaces
/// the structure's number of modes.
[[nodiscard]] ResolvedSwitch resolved_switch(const Device& device, double accuracy, std::optional<int> modes = {});
/// Returns the switch of a varied device. `quadrature` delivers `accuracy` for the nominal switch. A varied device whose
/// contact is nearer to the electrode gets a finer quadrature.
[[nodiscard]] Switch switch_like(const Device& device, const Switch& nominal, const SwitchOptions& quadrature, double accuracy);

}  // namespace softland
