// The resistance of a connection along a run.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/device.h"
#include "model/trajectory.h"

namespace softland {

/// Resistance of the connection, or of one of several contacts, at these times [Ohm], which increase; NaN where it is open.
/// Between the knots of a contact, which may be thinned, its place is that of the quintic and its force goes on a line. Empty
/// where it does not conduct, or no knots are kept.
[[nodiscard]] std::vector<double> resistance_course(const Device& device, const Trajectory& run, std::span<const double> times,
                                                    std::optional<std::size_t> contact = {});
/// Returns whether that resistance is known.
[[nodiscard]] bool conducts(const Device& device, std::optional<std::size_t> contact);

}  // namespace softland
