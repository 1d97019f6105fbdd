// Sections of a beam with their rigidity and mass, the curl of a cantilever (its deflection at rest by a stress gradient), and
// the supports and axial force of the beam.
#pragma once

#include <optional>
#include <vector>

#include "model/device.h"

namespace softland {

/// One part of a beam, of constant section or of a section that changes linearly along the part.
struct BeamSection {
  double begin = 0;            ///< position along the beam at which the part begins [m]
  double end = 0;              ///< position along the beam at which the part ends [m]
  double rigidity = 0;         ///< bending rigidity EI in the middle of the part [N m^2]
  double mass_per_length = 0;  ///< mass per length in the middle of the part [kg/m]
  /// Relative change of rigidity and mass from the middle of the part to its end; linear in between.
  double taper = 0;
  double curvature = 0;  ///< curvature at rest of a beam with sections or layers, positive away from the near electrode [1/m]
  /// Bending moment per volt of a piezo layer on a beam with sections or layers, in the middle of the part [N m / V].
  double piezo_moment = 0;
};

/// Bending rigidity and mass of a two-layer beam section; the rigidity is about the section's own neutral axis.
struct CompositeSection {
  double neutral_axis = 0;     ///< distance of the neutral axis from the free face of the piezo layer [m]; 0 without a layer
  double rigidity = 0;         ///< bending rigidity EI of the section about its neutral axis [N m^2]
  double mass_per_length = 0;  ///< mass of the section per length [kg/m]
};

/// Returns the modulus for bending of the beam: Young's modulus E [Pa], or E / (1 - nu^2) with plate_strain.
[[nodiscard]] double bending_modulus(const Structure& structure);
/// Returns rigidity and mass of the beam without its piezo layer, with its surface skins if the beam has any.
[[nodiscard]] CompositeSection plain_section(const Structure& structure, const std::optional<Surface>& surface = {});
/// Returns rigidity and mass of the section of a beam with a piezo layer of equal width (Zheng, Chen & Chen 2017, eqs. 5-6).
[[nodiscard]] CompositeSection layered_section(const Structure& structure, const Piezo& piezo);
/// Returns the bending moment of the piezo layer per volt, e31 a (z_c - bp / 2) with e31 = d31 Ep, Young's modulus Ep, neutral
/// axis z_c, width a and layer thickness bp [N m / V]: negative for d31 < 0.
[[nodiscard]] double piezo_moment_per_volt(const Structure& structure, const Piezo& piezo);
/// Returns the parts of the beam between changes of section, in order of the position x.
[[nodiscard]] std::vector<BeamSection> beam_sections(const Device& device);
/// Returns the axial stress that residual_stress leaves in the released beam between two clamps [Pa]. A stress along the beam
/// remains entirely. An equal biaxial stress sigma, as in a deposited film, leaves sigma (1 - nu), since the sides of the beam
/// are free and its length is fixed.
[[nodiscard]] double axial_stress(const Bridge& bridge);
/// Returns the compressive stress at which the beam buckles [Pa], with E I of plain_section(), area A and length L: 4 pi^2 E I
/// / (A L^2) between two clamps, a sixteenth of this with a free end.
[[nodiscard]] double buckling_stress(const Structure& structure, const std::optional<Surface>& surface = {});

/// Returns the elongation of the beam per axial force: the integral of 1 / (E A), E Young's modulus, A area [m/N]. The option
/// plate_strain does not change E here, since the sides of the beam are free to contract.
[[nodiscard]] double stretch_per_force(const Structure& structure);

struct BeamSupport {
  bool far_clamp = false;  ///< true when the end at x = L is clamped as well
  double axial_force = 0;  ///< axial force, positive in tension [N]
  Anchor near = {};        ///< anchor of the beam at x = 0
  Anchor far = free_end;   ///< anchor of the beam at x = L, unless this end is clamped
};
/// Returns the clamps of a beam and the axial force from residual stresses of its bulk and surfaces.
[[nodiscard]] BeamSupport beam_support(const Structure& structure, const std::optional<Surface>& surface = {});

/// Returns the curl of a cantilever at x from its clamp [m], positive away from the near electrode. The axial stress before
/// release grows by `gradient` [Pa/m] over the thickness, in the direction away from the near electrode. This stress bends
/// every section by M = gradient a b^3/12, so that the curvature is M/EI: gradient/E for a plain beam and less where a layer
/// stiffens it. Source: W. Fang & J. A. Wickert 1996, J. Micromech. Microeng. 6, 301. Valid for slopes well below 1.
[[nodiscard]] double curl(const Device& device, double gradient, double x);
/// Returns the smallest curl (deflection at rest by a stress gradient) along the beam [m], at most 0.
[[nodiscard]] double lowest_curl(const Device& device, double gradient);

}  // namespace softland
