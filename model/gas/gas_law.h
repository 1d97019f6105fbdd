// The force of the gas film of a device, and the range in which its law is valid.
#pragma once

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "model/device.h"
#include "model/gas/air.h"
#include "model/trajectory.h"

namespace softland {

/// Returns the damping of a rectangular gas film over that of a strip of the same length with closed ends; `ratio` is width
/// over length.
///   1 - (192 / pi^5) ratio sum over odd n of tanh(n pi / (2 ratio)) / n^5
/// The result is 1 - 0.63 ratio for long films, 0.4217 for a square film. The formula follows from Poisson's equation of the
/// incompressible film on a rectangle (Griffin, Richardson & Yamanami, J. Basic Eng. 88 (1966) 451; the series is that of
/// torsion of a rectangular bar).
[[nodiscard]] double end_flow(double ratio);

/// Returns the gas law of a device for a moving part of constant width and thickness: those of a structure, or the arguments
/// [m]. `unit_quality` is Film::unit_quality. For a compressible film the result is its incompressible limit.
[[nodiscard]] GasLaw gas_law(const Gas& gas, const Structure& structure, double unit_quality);
[[nodiscard]] GasLaw gas_law(const Gas& gas, double width, double thickness, double unit_quality);

/// Returns the damping per length of a gas law at this gap [N s/m^2]; the force per length is minus damping times velocity.
[[nodiscard]] inline double damping_per_length(const GasLaw& law, double gap) {
  return std::visit([&](const auto& l) { return -l.load(gap, 1.0); }, law);
}

/// Returns the squeeze number 12 mu_eff a^2 rate / (p h^2) of a gas film: width a [m], ambient pressure p, gap h [m]. `rate` is
/// the relative rate of change of the gap [1/s]. mu_eff is the effective viscosity of the rarefied gas (veijola.h). A gas whose
/// mean free path is long against the gap flows out before it is compressed.
[[nodiscard]] double squeeze_number(const FilmState& gas, double width, double gap, double rate);

/// Returns the squeeze number of the gas film at the contact point, for the rate |v| / h: velocity v, gap h. Returns 0 when the
/// device's gas law has no limit of the squeeze number.
[[nodiscard]] double squeeze_number(const Device& device, double rest_gap, const TrajectoryPoint& point);

/// Returns a warning for each limit of the gas law that a closing exceeded, with law, limit and value. The Knudsen numbers of a
/// closing are those from the rest gap to the smallest gap along the beam [m].
[[nodiscard]] std::vector<std::string> gas_warnings(const Device& device, double smallest_gap, double largest_squeeze);

}  // namespace softland
