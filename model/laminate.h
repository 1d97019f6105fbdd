// Bending of layers that are bonded on each other, per width.
//
//   z_c = sum E h z / sum E h,   EI/a = sum E (h^3/12 + h (z - z_c)^2),   mu/a = sum rho h
//   M/a = sum [s h (z - z_c) + g h^3/12],   curvature at rest = M / EI
//
// Sums run over the layers. E modulus in bending [Pa], h thickness [m], z height of the middle of a layer above the near face of
// the stack [m], z_c neutral axis [m], rho density [kg/m^3]; s stress before release, positive in tension, and g its growth over
// the thickness of the layer, away from the near face [Pa/m]. Released, the stack shrinks and turns until neither a force nor a
// moment is left; a curvature is positive away from the near face, which is where tension far from that face turns it. Derived:
// sections stay plane, and the force of the uniform strain has its point of attack at z_c. Valid for stacks thin against the
// radius of curvature.
#pragma once

#include <cmath>
#include <span>

namespace softland {

/// One of the layers, in order from the near face.
struct Lamina {
  double modulus = 0;    ///< in bending: E, or E / (1 - nu^2) of its own material [Pa]
  double density = 0;    ///< [kg/m^3]
  double thickness = 0;  ///< [m]
  double stress = 0;     ///< before release, positive in tension [Pa]
  double gradient = 0;   ///< of this stress over the thickness, away from the near face [Pa/m]
};

/// What a stack of layers is, per width.
struct Laminate {
  double neutral_axis = 0;  ///< above the near face [m]
  double rigidity = 0;      ///< EI [N m]
  double mass = 0;          ///< [kg/m^2]
  double curvature = 0;     ///< at rest, positive away from the near face [1/m]

  explicit Laminate(std::span<const Lamina> layers) {
    double stiffness = 0, weighted = 0, bottom = 0;
    for (const Lamina& l : layers) {
      stiffness += l.modulus * l.thickness;
      weighted += l.modulus * l.thickness * (bottom + l.thickness / 2);
      mass += l.density * l.thickness;
      bottom += l.thickness;
    }
    neutral_axis = weighted / stiffness;
    double moment = 0;
    bottom = 0;
    for (const Lamina& l : layers) {
      const double arm = bottom + l.thickness / 2 - neutral_axis, own = std::pow(l.thickness, 3) / 12;
      rigidity += l.modulus * (own + l.thickness * arm * arm);
      moment += l.stress * l.thickness * arm + l.gradient * own;
      bottom += l.thickness;
    }
    curvature = moment / rigidity;
  }
};

}  // namespace softland
