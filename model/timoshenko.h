// What Euler-Bernoulli's beam leaves out: shear and rotary inertia, as Timoshenko's uniform beam has them.
//
//   (kappa A G (w' - psi))' + rho A omega^2 w = 0,   (E I psi')' + kappa A G (w' - psi) + rho I omega^2 psi = 0
//   clamped: w = psi = 0      free: psi' = 0, w' = psi
//
// w deflection [m], psi rotation of the section [rad], A, I area [m^2] and second moment [m^4] of the rectangular section, E
// modulus in bending [Pa], G = E / (2 (1 + nu)) [Pa], kappa = 5/6, omega [rad/s]. Only length / thickness, nu and the clamps
// matter; layers, skins and axial forces are left aside: this is an estimate of what the model leaves out, not a part of it.
// Ritz's method, both fields in Legendre polynomials times what vanishes at the clamps. Exact for slender beams; the frequencies
// fall below Euler-Bernoulli's by about (1 + E / (kappa G)) / 24 (beta thickness / length)^2 for the mode of wave number beta /
// L. Source: Timoshenko, Phil. Mag. 41 (1921) 744; Huang, J. Appl. Mech. 28 (1961) 579.
#pragma once

#include <string>
#include <vector>

#include "model/device.h"

namespace softland {

/// How much too high Euler-Bernoulli's frequencies are, relative to Timoshenko's, mode by mode: 0.05 is 5 %. A Poisson's ratio
/// that is not given counts as 0.3. For a beam that is the same all along, between
/// clamps and free ends; empty for all else.
[[nodiscard]] std::vector<double> frequency_excess(const Structure& structure);

/// One sentence with the excess of every mode; empty where none reaches 2 %.
[[nodiscard]] std::string slenderness_warning(const Structure& structure);

}  // namespace softland
