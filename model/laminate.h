// Bending of layers that are bonded on each other, per width.
//
//   z_c = sum E h z / sum E h,   EI/a = sum E (h^3/12 + h (z - z_c)^2),   mu/a = sum rho h
//   M/a = sum [s h (z - z_c) + g h^3/12],   curvature at rest = M / EI
//
// Sums run over the layers; a is the width. E is the modulus in bending [Pa], h the thickness [m] and rho the density [kg/m^3]
// of a layer. z is the height of the middle of a layer, and z_c that of the neutral axis, above the near face of the stack [m].
// The stress s before release [Pa] is positive in tension; g is its growth over the thickness of the layer, away from the near
// face [Pa/m]. After release the stack shrinks and bends until neither a force nor a moment is left. A curvature is positive
// away from the near face; tension far from that face causes it. Derived: sections stay plane, and the resultant force of a
// uniform strain acts at the height z_c. Valid for stacks thin against the radius of curvature.
#pragma once

#include <cmath>
#include <span>

namespace softland {

/// A layer of a stack of bonded layers; the layers are in order from the near face of the stack.
struct Lamina {
  double modulus = 0;    ///< modulus of the layer in bending: Young's modulus E, or E / (1 - nu^2) of its material [Pa]
  double density = 0;    ///< density of the layer [kg/m^3]
  double thickness = 0;  ///< thickness of the layer [m]
  double stress = 0;     ///< stress in the layer before release, positive in tension [Pa]
  double gradient = 0;   ///< gradient of the layer's stress over its thickness, away from the near face [Pa/m]
};

/// The bending properties of a stack of bonded layers, per width.
struct Laminate {
  double neutral_axis = 0;  ///< height of the neutral axis above the near face of the stack [m]
  double rigidity = 0;      ///< bending rigidity per width [N m]
  double mass = 0;          ///< mass per area [kg/m^2]
  double curvature = 0;     ///< curvature of the stack at rest, positive away from the near face [1/m]

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
