// Surfaces of a thin beam as skins with their own elasticity and residual stress (Gurtin & Murdoch).
//
//   EI = E a b^3 / 12 + E_s (a b^2 / 2 + b^3 / 6)      [N m^2]; the last term is that of the two side faces
//   N_s = 2 tau_0 a                                      [N]
//
// E_s is the surface modulus [N/m], of either sign (atoms at a surface have fewer neighbours); tau_0 the residual stress of the
// surfaces [N/m], positive in tension; a the width, b the thickness [m]. With `wide` faces the side faces are neglected, as in
// most papers: they contribute b / (3 a) of the contribution of the wide faces. N_s is the pull of upper and lower face.
// Between two clamps it is a tension of the beam.
//
// In a cantilever the end is free: the faces' pull N_s is balanced by an equal compression of the bulk between them, and the
// bending moments of the two cancel. So a residual stress changes nothing in small deflections (Gurtin, Markenscoff & Thurston
// 1976; Lachut & Sader 2007). A part of the literature nevertheless counts one of these moments as a load 2 tau_0 a y'' on the
// deflection and finds the cantilever softer for tau_0 > 0, up to buckling without any voltage (He & Lilley 2008; Mikhasev &
// Radi 2025). `ResidualLoad::compression` is that model in the form that has an energy: the beam under the axial force -N_s,
// with EI y''' = -N_s y' at the free end. It buckles at L = (pi / 2) sqrt(EI / N_s) and is refused from there on. The same load
// with EI y''' = 0 at the end, also found in papers, is a follower force: it has no energy, and is not offered.
//
// Valid while the rigidity stays positive. Sources: M. E. Gurtin & A. I. Murdoch 1975, Arch. Ration. Mech. Anal. 57, 291;
// rigidity: G.-F. Wang & X.-Q. Feng 2007, Appl. Phys. Lett. 90, 231904; J. He & C. M. Lilley 2008, Nano Lett. 8, 1798; no
// effect in a cantilever: M. E. Gurtin, X. Markenscoff & R. N. Thurston 1976, Appl. Phys. Lett. 29, 529; M. J. Lachut & J. E.
// Sader 2007, Phys. Rev. Lett. 99, 206102; buckling: G. I. Mikhasev & E. Radi 2025, Int. J. Eng. Sci., 104356.
#pragma once

#include <string>

#include "model/device.h"

namespace softland {

/// Returns the contribution of the surface skins to the bending rigidity [N m^2].
[[nodiscard]] inline double surface_rigidity(const Surface& surface, const Structure& s) {
  const double flanks = surface.faces == SurfaceFaces::all ? s.thickness / 3 : 0;
  return surface.elastic_modulus * s.thickness * s.thickness / 2 * (s.width + flanks);
}

/// Returns the reason why the device cannot have its surface skins; empty when the device can.
[[nodiscard]] std::string why_no_surface(const Device& device);

/// Returns the pull of the residual stress of upper and lower face on the beam [N].
[[nodiscard]] inline double surface_pull(const Surface& surface, const Structure& s) {
  return 2 * surface.residual_stress * s.width;
}

}  // namespace softland
