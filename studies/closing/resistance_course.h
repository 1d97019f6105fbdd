// The resistance of the connection (the electrical path through one or several contacts) as a function of time in a run.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/device.h"
#include "model/trajectory.h"

namespace softland {

/// Returns the resistance of the connection of all contacts, or of contact number `contact`, at these increasing times [Ohm];
/// NaN while open. Between the recorded knots (points between integrator steps), the position is interpolated by a quintic and
/// the contact force linearly. Empty if the contact does not conduct, or if no knots are recorded.
[[nodiscard]] std::vector<double> resistance_course(const Device& device, const Trajectory& run, std::span<const double> times,
                                                    std::optional<std::size_t> contact = {});
/// True if the scene describes the electrical resistance of the connection, or of contact number `contact`.
[[nodiscard]] bool conducts(const Device& device, std::optional<std::size_t> contact);

}  // namespace softland
