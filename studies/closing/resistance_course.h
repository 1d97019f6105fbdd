// The resistance of a connection along a run.
#pragma once

#include <span>
#include <vector>

#include "model/device.h"
#include "model/trajectory.h"

namespace softland {

/// Resistance of the connection at these times [Ohm], which increase; NaN where it is open. Between the knots of a contact, which
/// may be thinned, its place is that of the quintic and its force goes on a line. Empty where the device does not conduct, or no
/// knots are kept.
[[nodiscard]] std::vector<double> resistance_course(const Device& device, const Trajectory& run, std::span<const double> times);

}  // namespace softland
