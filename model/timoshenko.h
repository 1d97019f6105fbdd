// The effects that Euler-Bernoulli's beam neglects: shear and rotary inertia, as in Timoshenko's uniform beam.
//
//   (kappa A G (w' - psi))' + rho A omega^2 w = 0,   (E I psi')' + kappa A G (w' - psi) + rho I omega^2 psi = 0
//   clamped: w = psi = 0      free: psi' = 0, w' = psi
//
// w is the deflection [m], psi the rotation of the section [rad], A, I area [m^2] and second moment [m^4] of the rectangular
// section, E the modulus in bending [Pa], G = E / (2 (1 + nu)) [Pa], kappa = 5/6, omega [rad/s]. Only length / thickness,
// Poisson's ratio nu and the clamps matter. Layers, skins and axial forces are ignored: this is an estimate of the neglected
// effects, not a part of the model. It uses Ritz's method, both fields in Legendre polynomials times a factor that vanishes at
// the clamps. It is exact for slender beams; the frequencies fall below Euler-Bernoulli's by about (1 + E / (kappa G)) / 24
// (beta thickness / length)^2 for the mode of wave number beta / L. Source: Timoshenko, Phil. Mag. 41 (1921) 744; Huang, J.
// Appl. Mech. 28 (1961) 579.
#pragma once

#include <string>
#include <vector>

#include "model/device.h"

namespace softland {

/// Returns by how much Euler-Bernoulli's frequencies are too high, relative to Timoshenko's, for each mode: 0.05 is 5 %. A
/// missing Poisson's ratio counts as 0.3. The result is empty unless the beam is uniform and its ends are clamped or free.
[[nodiscard]] std::vector<double> frequency_excess(const Structure& structure);

/// Returns a warning with the frequency_excess() of every mode, the error of the slender beam's frequencies; empty when no
/// excess reaches 2 %.
[[nodiscard]] std::string slenderness_warning(const Structure& structure);

}  // namespace softland
