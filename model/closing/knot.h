// A state of the switch during a closing, with the results of the right-hand side there.
#pragma once

#include <cstddef>
#include <vector>

namespace softland {

struct Knot {
  double time = 0;            ///< [s]
  std::vector<double> state;  ///< q, v, then the film if it is compressible
  std::vector<double> rates;  ///< rates of all states but q: accelerations, then the rates of the film
};

/// The figures of the gap field at a knot that the closing needs. The figures are read from the workspace as soon as the knot
/// is computed, since the next use of the workspace overwrites the field.
struct FieldFigures {
  double smallest_gap = 0;   ///< [m]
  bool at_far_side = false;  ///< see Switch::at_far_side()
  double dissipation = 0;    ///< dissipation by gas, film and modal damping [W]; 0 without damping
};

}  // namespace softland
