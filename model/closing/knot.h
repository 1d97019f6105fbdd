// A knot is a point of the simulated motion: a state of the switch during a closing, with the rates of the equations of motion
// there.
#pragma once

#include <cstddef>
#include <vector>

namespace softland {

struct Knot {
  double time = 0;            ///< time of this point of the motion [s]
  std::vector<double> state;  ///< coordinates and velocities of the modes, then pressures of a compressible gas film
  std::vector<double> rates;  ///< time derivatives of modal velocities, then of film pressures
};

/// Figures of the gap field (gap between beam and electrode along the beam) at one point of the motion. They are read from the
/// workspace as soon as the point is computed, since the next use of the workspace overwrites the field.
struct FieldFigures {
  double smallest_gap = 0;   ///< smallest gap between beam and electrode [m]
  bool at_far_side = false;  ///< true when the beam has reached an electrode or wall on the far side
  double dissipation = 0;    ///< power that gas, film and modal damping dissipate [W]; 0 without damping
};

}  // namespace softland
